#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

#include "base/clock.hpp"
#include "frame_header.hpp"

namespace vrut::server::engine {

/// After this long without a change the picture is drawn at full accuracy.
inline constexpr std::chrono::milliseconds kQuiet{150};

struct PictureLimits {
    std::int64_t max_pixels = 1 << 23;  ///< of any picture
    int max_side = 16384;
};

struct PictureSize {
    int width = 0, height = 0;
    bool operator==(const PictureSize&) const = default;
};

/// Whether a picture of this size can be drawn.
inline bool fits(std::int64_t width, std::int64_t height, const PictureLimits& limits) {
    return width <= limits.max_side && height <= limits.max_side && width * height <= limits.max_pixels;
}

/// At rest. While things move, pictures are of levels: see level_choice.hpp.
inline constexpr protocol::Quality kStill{protocol::Quality::Level::still,        1, 16, 0, 90,
                                          protocol::Quality::Subsampling::yuv444, {}};
/// At rest the picture is refined in steps of so many samples.
inline constexpr std::array kStillSamples{4, kStill.samples};

/// What a picture of `level` is drawn and encoded with: as large as the view and the limits allow.
/// `thin_lines`: never subsampled, since thin red lines would vanish. Of those, and of pictures that the
/// limits make smaller than the level, no error is known.
protocol::Quality quality_of(const protocol::Quality& level, const protocol::Resize& view,
                             const PictureLimits& limits, bool thin_lines);
/// round(CSS size · pixelRatio · scale).
PictureSize picture_size(const protocol::Resize& view, double scale);

/// What the decision whether to draw now, and how, depends on.
struct PacingInput {
    bool somebody_waits = false;          ///< for a picture newer than the newest drawn
    bool changed = false;                 ///< the newest picture drawn does not show what is to be seen now
    int newest_samples = 0;               ///< of the newest picture, where it is a still one; else 0
    bool encoder_free = true;             ///< what is drawn now would not have to wait behind another picture
    base::Clock::time_point last_change;  ///< of what is to be seen
    base::Clock::time_point now;
};

struct PacingDecision {
    enum class Action { wait, draw };
    Action action = Action::wait;
    int still_samples = 0;  ///< of a picture at rest; 0: a moving one is drawn
    /// When waiting: decide again then even if nothing happens. None: only when something does.
    std::optional<base::Clock::time_point> until = {};
};

/// The one place that decides whether a picture is drawn now.
PacingDecision decide(const PacingInput& input);

}  // namespace vrut::server::engine
