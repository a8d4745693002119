#include "engine/scheduler.hpp"

#include <algorithm>

namespace vrut::server::engine {

using Action = ScheduledStep::Action;

namespace {

constexpr int kSnapshotPause = 4;  // times as long as a step of one

}  // namespace

ScheduledStep Scheduler::frame_step(const ScheduleInput& input) const {
    if (input.frame_under_way) return {Action::draw_frame};
    const Refinement drawn = input.changed ? Refinement::none : input.newest;
    if (!input.frame_wanted || drawn == Refinement::sharp) return {};
    if (!input.encoder_free) return {};  // taking its next picture, the encoder wakes us
    const base::Clock::time_point quiet_at = input.last_change + kQuiet;
    if (input.now < quiet_at) {
        if (input.changed) return {Action::begin_frame};
        return {Action::wait, Refinement::none, quiet_at};
    }
    const Refinement next = next_refinement(drawn, input.slow_link);
    if (next == Refinement::sharp && input.now < input.sharp_from)
        return {Action::wait, Refinement::none, input.sharp_from};
    return {Action::begin_frame, next};
}

ScheduledStep Scheduler::next(const ScheduleInput& input) const {
    ScheduledStep frame = frame_step(input);
    if (!input.snapshot_waits) return frame;
    const bool moves = input.now < input.last_change + kQuiet;
    if (moves ? input.now >= snapshot_turn_ : frame.action == Action::wait) return {Action::draw_snapshot};
    if (frame.action == Action::wait)
        frame.until = std::min(frame.until.value_or(snapshot_turn_), snapshot_turn_);
    return frame;
}

void Scheduler::drew_snapshot(base::Clock::time_point begin, base::Clock::time_point end) {
    snapshot_turn_ = end + kSnapshotPause * (end - begin);
}

}  // namespace vrut::server::engine
