#pragma once

#include <chrono>

namespace vrut::server::base {

/// Monotonic. Whatever needs the time is given a point of this clock.
using Clock = std::chrono::steady_clock;

}  // namespace vrut::server::base
