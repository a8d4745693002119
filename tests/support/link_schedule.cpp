#include "link_schedule.hpp"

#include <algorithm>

namespace vrut::test_support {

namespace {

constexpr double kSegment = 1448;  // bytes, as on most links
constexpr double kSmallestPiece = 64;
constexpr double kQueue = 16'384;  // bytes
constexpr std::chrono::duration<double> kMoment{0.05};
constexpr std::chrono::milliseconds kTimerLateness{2};  // of the next piece, which a busy link makes up for

}  // namespace

std::size_t LinkSchedule::max_piece_bytes() const {
    return static_cast<std::size_t>(
        std::clamp(kMoment.count() * quality_.bytes_per_second, kSmallestPiece, kSegment));
}

std::size_t LinkSchedule::capacity_bytes() const {
    const std::chrono::duration<double> delay = quality_.delay;
    return static_cast<std::size_t>(kQueue + delay.count() * quality_.bytes_per_second);
}

LinkSchedule::Passage LinkSchedule::send(std::size_t bytes, Clock::time_point now) {
    const std::chrono::duration<double> takes(static_cast<double>(bytes) / quality_.bytes_per_second);
    free_at_ = std::max({now - kTimerLateness, free_at_, stalled_until_}) +
               std::chrono::duration_cast<Clock::duration>(takes);
    const Clock::time_point leaves = std::max(now, free_at_);
    last_arrival_ = std::max(last_arrival_, leaves + quality_.delay);
    return {leaves, last_arrival_};
}

Clock::time_point LinkSchedule::time_of(Clock::time_point due) const { return std::max(due, stalled_until_); }

}  // namespace vrut::test_support
