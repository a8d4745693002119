#pragma once

#include <algorithm>
#include <chrono>

#include "base/clock.hpp"

namespace vrut::server::base {

/// Limits messages a second, with bursts of one second's messages (generic cell rate algorithm).
class RateLimit {
public:
    explicit RateLimit(int per_second)
        : interval_(std::chrono::nanoseconds(std::chrono::seconds(1)) / per_second) {}

    void spend(Clock::time_point now) { next_ = std::max(next_, now - std::chrono::seconds(1)) + interval_; }
    /// Until the next may come; not above zero: now.
    Clock::duration wait(Clock::time_point now) const { return next_ - now; }

private:
    Clock::duration interval_;
    Clock::time_point next_{};
};

}  // namespace vrut::server::base
