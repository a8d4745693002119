#include "engine/scheduler.hpp"

#include <doctest/doctest.h>

using namespace vrut::server::base;
using namespace vrut::server::engine;
using namespace std::chrono_literals;
using Action = ScheduledStep::Action;

namespace {

const Clock::time_point kStart = Clock::time_point(1h);

ScheduleInput at(std::chrono::milliseconds since_change) {
    ScheduleInput input;
    input.frame_wanted = true;
    input.last_change = kStart;
    input.now = kStart + since_change;
    return input;
}

ScheduledStep next(const ScheduleInput& input) { return Scheduler().next(input); }

}  // namespace

TEST_CASE("nothing is drawn that nobody wants, or that has been drawn") {
    ScheduleInput input = at(1000ms);
    input.changed = true;
    input.frame_wanted = false;
    CHECK(next(input).action == Action::wait);
    CHECK_FALSE(next(input).until.has_value());

    input = at(1000ms);
    input.newest = Refinement::sharp;
    CHECK(next(input).action == Action::wait);
    CHECK_FALSE(next(input).until.has_value());
}

TEST_CASE("a change is drawn at once, at rest again in full, in steps") {
    ScheduleInput input = at(0ms);
    input.changed = true;
    CHECK(next(input).action == Action::begin_frame);
    CHECK(next(input).refinement == Refinement::none);

    input.changed = false;  // the moving frame is drawn
    CHECK(next(input).action == Action::wait);
    CHECK(next(input).until == kStart + 150ms);
    input.now = kStart + 149ms;
    CHECK(next(input).action == Action::wait);
    input.now = kStart + 150ms;
    CHECK(next(input).action == Action::begin_frame);
    CHECK(next(input).refinement == Refinement::first);
    input.newest = Refinement::first;
    CHECK(next(input).refinement == Refinement::better);
    input.newest = Refinement::better;
    CHECK(next(input).refinement == Refinement::sharp);
    input.newest = Refinement::sharp;
    CHECK(next(input).action == Action::wait);

    // What was still is no more.
    input.changed = true;
    input.last_change = input.now;
    CHECK(next(input).refinement == Refinement::none);
}

TEST_CASE("a change that nobody wanted to see is drawn in full when somebody comes later") {
    ScheduleInput input = at(151ms);
    input.changed = true;
    input.newest = Refinement::sharp;
    CHECK(next(input).refinement == Refinement::first);
}

TEST_CASE("while a frame waits for the encoder none is drawn behind it") {
    ScheduleInput input = at(0ms);
    input.changed = true;
    input.encoder_free = false;
    CHECK(next(input).action == Action::wait);
    CHECK_FALSE(next(input).until.has_value());
}

TEST_CASE("a frame that was begun is drawn on, whatever else there is") {
    ScheduleInput input = at(0ms);
    input.frame_under_way = true;
    input.frame_wanted = input.encoder_free = false;
    CHECK(next(input).action == Action::draw_frame);
    input.now += 1h;
    input.snapshot_waits = true;
    CHECK(next(input).action == Action::draw_frame);
}

TEST_CASE(
    "over a slow link a small frame comes first, then one of full size and one sample, and the sharp one "
    "waits") {
    ScheduleInput input = at(1000ms);
    input.slow_link = true;
    input.sharp_from = kStart + 5s;
    input.changed = true;
    CHECK(next(input).refinement == Refinement::small);
    input.changed = false;
    input.newest = Refinement::small;
    CHECK(next(input).refinement == Refinement::first);
    input.newest = Refinement::first;
    CHECK(next(input).action == Action::wait);
    CHECK(next(input).until == kStart + 5s);
    input.now = kStart + 5s;
    CHECK(next(input).refinement == Refinement::sharp);
}

TEST_CASE("samples never become fewer from one frame of full size to the next") {
    for (const bool slow : {false, true})
        for (Refinement drawn = Refinement::first; drawn != Refinement::sharp;) {
            const Refinement next = next_refinement(drawn, slow);
            CHECK(samples_of(next) > samples_of(drawn));
            drawn = next;
        }
}

TEST_CASE("at rest snapshots are drawn while no frame is") {
    ScheduleInput input = at(1000ms);
    input.snapshot_waits = true;
    input.newest = Refinement::better;
    CHECK(next(input).action == Action::begin_frame);
    input.newest = Refinement::sharp;
    CHECK(next(input).action == Action::draw_snapshot);
    input.frame_wanted = false;
    input.changed = true;
    CHECK(next(input).action == Action::draw_snapshot);
}

TEST_CASE("while things move snapshots get a fifth of the time") {
    Scheduler scheduler;
    Clock::time_point now = kStart;
    std::chrono::milliseconds snapshots{0}, frames{0};
    while (now < kStart + 60s) {
        ScheduleInput input = at(0ms);
        input.now = input.last_change = now;
        input.changed = input.snapshot_waits = true;
        const ScheduledStep step = scheduler.next(input);
        if (step.action == Action::draw_snapshot) {
            scheduler.drew_snapshot(now, now + 70ms);
            snapshots += 70ms;
            now += 70ms;
        } else {
            CHECK(step.action == Action::begin_frame);
            frames += 30ms;
            now += 30ms;
        }
    }
    CHECK(snapshots > 11s);
    CHECK(snapshots < 13s);
}

TEST_CASE("a snapshot that may not be drawn yet is not forgotten where there is nothing else to do") {
    Scheduler scheduler;
    scheduler.drew_snapshot(kStart, kStart + 10ms);
    ScheduleInput input = at(20ms);
    input.snapshot_waits = true;
    CHECK(scheduler.next(input).action == Action::wait);
    CHECK(scheduler.next(input).until == kStart + 50ms);
    input.frame_wanted = false;
    CHECK(scheduler.next(input).until == kStart + 50ms);
}
