#pragma once

#include <chrono>
#include <cstddef>

namespace vrut::test_support {

using Clock = std::chrono::steady_clock;

/// What a link is like, each way.
struct LinkQuality {
    double bytes_per_second = 1e9;
    std::chrono::milliseconds delay{0};
};

/// One direction of a link: when bytes leave, one piece after another, and when they arrive. It reads no
/// clock.
class LinkSchedule {
public:
    explicit LinkSchedule(const LinkQuality& quality) : quality_(quality) {}

    /// Holds for the pieces that are sent from now on.
    void change(const LinkQuality& quality) { quality_ = quality; }
    /// Until then nothing leaves and nothing arrives.
    void stall_until(Clock::time_point end) { stalled_until_ = end; }

    /// The largest piece: a segment, or what leaves in 50 ms, so that a slow link does not pass bytes on in
    /// lumps.
    std::size_t max_piece_bytes() const;
    /// The most bytes between both ends: what is on its way during the delay, and a queue of 16 KiB.
    std::size_t capacity_bytes() const;

    struct Passage {
        Clock::time_point leaves, arrives;
    };
    /// Of a piece that is sent at `now`, after all that were sent before.
    Passage send(std::size_t bytes, Clock::time_point now);
    /// When something happens that is due at `due`: not before a stall ends.
    Clock::time_point time_of(Clock::time_point due) const;

private:
    LinkQuality quality_;
    Clock::time_point stalled_until_{};
    Clock::time_point free_at_{};  ///< when all that was sent has left
    Clock::time_point last_arrival_{};
};

}  // namespace vrut::test_support
