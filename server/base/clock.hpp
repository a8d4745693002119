#pragma once

#include <chrono>

namespace vrut::server::base {

/// The server's monotonic clock. What decides by time is given a point of it, so that tests can count time.
using Clock = std::chrono::steady_clock;

}  // namespace vrut::server::base
