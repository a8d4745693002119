#pragma once

#include <array>
#include <csignal>

namespace vrut::server::commands {

/// From its creation, SIGINT, SIGTERM and SIGHUP end nothing at once: they are asked for. A second one ends
/// the program. Those that are ignored, as nohup has it, stay ignored. There is one at a time.
class StopSignals {
public:
    StopSignals();
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
    bool came() const;

private:
    std::array<struct sigaction, 3> before_{};
};

}  // namespace vrut::server::commands
