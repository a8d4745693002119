#pragma once

namespace vrut::server::commands {

/// From its creation, SIGINT, SIGTERM and SIGHUP end nothing at once: they are asked for. A second one ends
/// the program. There is one at a time.
class StopSignals {
public:
    StopSignals();
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
    bool came() const;
};

}  // namespace vrut::server::commands
