#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "frame_header.hpp"

namespace vrut {

using Clock = std::chrono::steady_clock;

/// After this long without a change the picture is drawn at full accuracy.
inline constexpr std::chrono::milliseconds kQuiet{150};

struct PictureLimits {
    std::int64_t max_pixels = 1 << 23;         ///< of any picture
    std::int64_t max_moving_pixels = 1 << 20;  ///< of one drawn while things move
    int max_side = 16384;
};

struct PictureSize {
    int width = 0, height = 0;
    bool operator==(const PictureSize&) const = default;
};

/// The level for pictures while things move, and at rest.
protocol::Quality moving_quality(const protocol::Resize& view, const PictureLimits& limits);
protocol::Quality still_quality(const protocol::Resize& view, const PictureLimits& limits);
/// round(CSS size · pixelRatio · scale).
PictureSize picture_size(const protocol::Resize& view, double scale);

/// What the decision whether to draw now depends on.
struct PacingInput {
    bool somebody_waits = false;    ///< for a picture newer than the newest drawn
    bool changed = false;           ///< the newest picture drawn does not show what is to be seen now
    bool newest_is_still = false;   ///< it is at full accuracy
    bool encoder_free = true;       ///< what is drawn now would not have to wait behind another picture
    Clock::time_point last_change;  ///< of what is to be seen
    Clock::time_point now;
};

struct PacingDecision {
    enum class Action { wait, draw_moving, draw_still };
    Action action = Action::wait;
    /// When waiting: decide again then even if nothing happens. None: only when something does.
    std::optional<Clock::time_point> until;
};

/// The one place that decides whether a picture is drawn now, and at which level.
PacingDecision decide(const PacingInput& input);

}  // namespace vrut
