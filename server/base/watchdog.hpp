#pragma once

#include <atomic>

#include "base/clock.hpp"

namespace vrut::server::base {

/// Tells other threads whether one that has something to do still comes round.
class Watchdog {
public:
    /// It has something to do, and comes round now.
    void busy() { since_ = Clock::now().time_since_epoch().count(); }
    /// It waits for something to do.
    void idle() { since_ = kIdle; }
    /// How long it has not come round; 0 while it rests.
    Clock::duration busy_for() const {
        const Clock::rep since = since_;
        return since == kIdle ? Clock::duration{} : Clock::now().time_since_epoch() - Clock::duration(since);
    }

private:
    static constexpr Clock::rep kIdle = 0;
    std::atomic<Clock::rep> since_{kIdle};
};

}  // namespace vrut::server::base
