#include "link_schedule.hpp"

#include <doctest/doctest.h>

using namespace vrut::test_support;
using namespace std::chrono_literals;

namespace {

const Clock::time_point kNow{1h};

/// When the last byte has left, of `bytes` that are sent as fast as the link takes them.
Clock::time_point end_of(LinkSchedule& schedule, std::size_t bytes) {
    Clock::time_point now = kNow;
    while (bytes > 0) {
        const std::size_t piece = std::min(bytes, schedule.max_piece_bytes());
        now = schedule.send(piece, now).leaves;
        bytes -= piece;
    }
    return now;
}

}  // namespace

TEST_CASE("bytes leave at the link's rate") {
    LinkSchedule schedule({100'000, 0ms});
    CHECK(end_of(schedule, 50'000) - kNow == 498ms);
}

TEST_CASE("a timer that is late by up to 2 ms costs no rate") {
    LinkSchedule schedule({100'000, 0ms});
    schedule.send(1000, kNow);  // 10 ms, of which the first two are made up for
    CHECK(schedule.send(1000, kNow + 9ms).leaves == kNow + 18ms);
    CHECK(schedule.send(1000, kNow + 100ms).leaves == kNow + 108ms);
}

TEST_CASE("a piece arrives its delay after it has left, and not before those sent earlier") {
    LinkSchedule schedule({100'000, 30ms});
    CHECK(schedule.send(1000, kNow).arrives == kNow + 38ms);
    schedule.change({100'000, 0ms});
    CHECK(schedule.send(1000, kNow + 9ms).arrives == kNow + 38ms);
    CHECK(schedule.send(1000, kNow + 50ms).arrives == kNow + 58ms);
}

TEST_CASE("the rate changes for what is sent from then on") {
    LinkSchedule schedule({100'000, 0ms});
    const auto left = schedule.send(1000, kNow).leaves;
    schedule.change({1000, 0ms});
    CHECK(schedule.send(50, left).leaves == left + 50ms);
}

TEST_CASE("in a stall nothing leaves and nothing arrives") {
    LinkSchedule schedule({100'000, 30ms});
    const auto arrival = schedule.send(1000, kNow).arrives;
    schedule.stall_until(kNow + 1s);
    CHECK(schedule.time_of(arrival) == kNow + 1s);
    CHECK(schedule.send(1000, kNow + 10ms).leaves == kNow + 1010ms);
    CHECK(schedule.time_of(kNow + 2s) == kNow + 2s);
}

TEST_CASE("pieces are segments, or what leaves in 50 ms; what lies between the ends is bounded") {
    CHECK(LinkSchedule({1e6, 0ms}).max_piece_bytes() == 1448);
    CHECK(LinkSchedule({10'000, 0ms}).max_piece_bytes() == 500);
    CHECK(LinkSchedule({1, 0ms}).max_piece_bytes() == 64);
    CHECK(LinkSchedule({1e6, 100ms}).capacity_bytes() == 16'384 + 100'000);
}
