#include "engine/scheduler.hpp"

#include <algorithm>

#include "engine/frame_quality.hpp"

namespace vrut::server::engine {

using Action = ScheduledStep::Action;

namespace {

constexpr int kSnapshotPause = 4;  // times as long as a step of one

}  // namespace

ScheduledStep Scheduler::frame_step(const ScheduleInput& input) const {
    if (input.frame_under_way) return {Action::draw_frame};
    const bool final_one = input.newest_samples == kRefinedSamples.back();
    if (!input.frame_wanted || (!input.changed && final_one)) return {};
    if (!input.encoder_free) return {};  // taking its next picture, the encoder wakes us
    const base::Clock::time_point quiet_at = input.last_change + kQuiet;
    if (input.now < quiet_at) {
        if (input.changed) return {Action::begin_frame};
        return {Action::wait, 0, quiet_at};
    }
    const int drawn = input.changed ? 0 : input.newest_samples;
    const int samples =
        *std::find_if(kRefinedSamples.begin(), kRefinedSamples.end(), [&](int step) { return step > drawn; });
    if (samples == kRefinedSamples.back() && input.now < input.last_refinement_from)
        return {Action::wait, 0, input.last_refinement_from};
    return {Action::begin_frame, samples};
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
