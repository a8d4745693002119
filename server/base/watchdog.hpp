#pragma once

#include <atomic>

#include "base/clock.hpp"

namespace vrut::server::base {

/// Tells other threads whether one that has something to do still comes round.
class Heartbeat {
public:
    /// It has something to do, and comes round now.
    void beat() { since_ = Clock::now().time_since_epoch().count(); }
    /// It waits for something to do.
    void rest() { since_ = kRests; }
    /// How long it has not come round; 0 while it rests.
    Clock::duration silence() const {
        const Clock::rep since = since_;
        return since == kRests ? Clock::duration{} : Clock::now().time_since_epoch() - Clock::duration(since);
    }

private:
    static constexpr Clock::rep kRests = 0;
    std::atomic<Clock::rep> since_{kRests};
};

}  // namespace vrut::server::base
