#pragma once

#include <optional>

#include "base/clock.hpp"
#include "engine/frame_quality.hpp"

namespace vrut::server::engine {

/// After this long without a change the view is idle: its frames are refined.
inline constexpr std::chrono::milliseconds kQuiet{150};

/// What the next step of the render loop depends on.
struct ScheduleInput {
    base::Clock::time_point now;
    base::Clock::time_point last_change;  ///< of what is to be seen
    bool frame_wanted = false;            ///< a client may be sent a frame newer than the newest drawn
    bool slow_link = false;               ///< a sharp frame is long on its way to the holder
    /// Before this time no sharp frame is drawn: on a slow link it would delay the next move.
    base::Clock::time_point sharp_from{};
    bool changed = false;                  ///< the newest frame does not show what is to be seen now
    Refinement newest = Refinement::none;  ///< of the newest frame
    bool encoder_free = true;              ///< a frame drawn now would not wait behind another
    bool frame_under_way = false;
    bool snapshot_waits = false;  ///< and its encoder is free
};

struct ScheduledStep {
    enum class Action { wait, begin_frame, draw_frame, draw_snapshot };
    Action action = Action::wait;
    Refinement refinement = Refinement::none;  ///< of the frame to begin; none: an interactive one
    /// When waiting: ask again then even if nothing happens; none: only when something does.
    std::optional<base::Clock::time_point> until = {};
};

/// Decides what the render loop does next. While the view moves, snapshots get a fifth of the time; while it
/// is idle, frames go first.
class Scheduler {
public:
    ScheduledStep next(const ScheduleInput& input) const;
    /// A step of a snapshot was drawn from `begin` to `end`.
    void drew_snapshot(base::Clock::time_point begin, base::Clock::time_point end);

private:
    ScheduledStep frame_step(const ScheduleInput& input) const;

    base::Clock::time_point snapshot_turn_{};  ///< while the view moves: not before
};

}  // namespace vrut::server::engine
