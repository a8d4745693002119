#pragma once

#include <chrono>

#include "base/clock.hpp"

namespace vrut::server::engine {

/// A refined frame whose delivery takes longer is held back until the view has been idle for as long: a
/// client that moves the view again would wait for it.
inline constexpr std::chrono::seconds kLongDelivery{2};

/// The way from the server to a client's glass, as it was measured.
struct Link {
    double bytes_per_second = 0;         ///< above 0; of frames, from sending one to its being shown
    base::Clock::duration round_trip{};  ///< of a ping on an idle link
    bool operator==(const Link&) const = default;
};

}  // namespace vrut::server::engine
