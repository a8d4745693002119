#pragma once

#include <chrono>

#include "base/clock.hpp"

namespace vrut::server::engine {

/// A frame that is on its way for longer waits until the view has rested for as long.
inline constexpr std::chrono::seconds kLongDelivery{2};

/// The way from the server to a client's glass, as it was measured.
struct Link {
    double bytes_per_second = 0;         ///< above 0; of frames, from sending one to its being shown
    base::Clock::duration round_trip{};  ///< of a ping on an idle link
    bool operator==(const Link&) const = default;
};

}  // namespace vrut::server::engine
