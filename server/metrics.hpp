#pragma once

#include <atomic>
#include <cstdint>
#include <string>

namespace vrut {

/// Counters of what the server did since it started. Written by the thread that does it, read by any.
struct Metrics {
    using Counter = std::atomic<std::uint64_t>;
    Counter clients_joined{0}, clients_left{0};
    Counter messages_received{0}, messages_refused{0};
    Counter frames_granted{0};
    Counter frames_rendered_moving{0}, frames_rendered_still{0}, frames_interrupted{0};
    Counter samples_drawn{0}, readbacks{0};  ///< of all pictures, and of the one that makes drivers ready
    Counter frames_encoded{0}, bytes_encoded{0}, frames_sent{0};
    Counter frames_replaced{0};  ///< a newer picture took the place of one that waited for its client
    Counter pictures_held{0}, pictures_held_most{0};  ///< encoded pictures in memory, now and at most so far
    Counter snapshots_rendered{0}, snapshots_sent{0};
    Counter bytes_sent{0};

    std::uint64_t frames_rendered() const { return frames_rendered_moving + frames_rendered_still; }
    /// Prometheus' text format, version 0.0.4.
    std::string text() const;
};

}  // namespace vrut
