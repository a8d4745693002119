#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

#include "frame_header.hpp"

namespace vrut {

using Clock = std::chrono::steady_clock;

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

/// What a picture costs and is worth: the more pixels, samples and JPEG quality, the more of both.
struct Level {
    std::int64_t max_pixels;
    int samples;
    int jpeg_quality;
    protocol::Quality::Subsampling subsampling;
};

/// The levels, by rising accuracy. The last is the one at rest, the others are for pictures while things
/// move.
inline constexpr std::array kLevels{
    Level{1 << 18, 1, 60, protocol::Quality::Subsampling::yuv420},
    Level{1 << 20, 1, 75, protocol::Quality::Subsampling::yuv420},
    Level{1 << 22, 1, 85, protocol::Quality::Subsampling::yuv444},
    Level{1 << 23, 16, 90, protocol::Quality::Subsampling::yuv444},
};
inline constexpr int kStillLevel = kLevels.size() - 1;
inline constexpr int kFirstLevel = 1;  ///< as long as nothing is measured
/// At rest the picture is refined in steps of so many samples; the last is the still level's.
inline constexpr std::array kStillSamples{4, kLevels[kStillLevel].samples};

/// What a picture of a level is drawn and encoded with. `thin_lines`: never subsampled, since thin red lines
/// would vanish.
protocol::Quality quality_of(int level, const protocol::Resize& view, const PictureLimits& limits,
                             bool thin_lines);
/// round(CSS size · pixelRatio · scale).
PictureSize picture_size(const protocol::Resize& view, double scale);

/// Running means of what pictures of each moving level took, from the drawing's begin until their client
/// asked for the next.
class MeasuredTimes {
public:
    void add(int level, double ms, double pixels, Clock::time_point now);
    /// What a picture of `pixels` at `level` will take: as measured lately, else in proportion to its pixels
    /// from what `current` took. None while nothing is measured.
    std::optional<double> expected(int level, double pixels, int current, Clock::time_point now) const;

private:
    struct Mean {
        double ms = 0, pixels = 0;
        std::optional<Clock::time_point> last;
    };
    std::array<Mean, kStillLevel> means_{};
};

/// What the decision whether to draw now, and at which level, depends on.
struct PacingInput {
    bool somebody_waits = false;    ///< for a picture newer than the newest drawn
    bool changed = false;           ///< the newest picture drawn does not show what is to be seen now
    int newest_samples = 0;         ///< of the newest picture, where it is a still one; else 0
    bool encoder_free = true;       ///< what is drawn now would not have to wait behind another picture
    Clock::time_point last_change;  ///< of what is to be seen
    Clock::time_point now;
    int level = kFirstLevel;  ///< of the moving picture before
    /// What a picture of each moving level is expected to take; none: not known.
    std::array<std::optional<double>, kStillLevel> expected_ms{};
    double target_ms = 50;    ///< that one shall take
    double preference = 0.5;  ///< 0 speed: a quarter of that; 1 accuracy: four times as much
};

struct PacingDecision {
    enum class Action { wait, draw };
    Action action = Action::wait;
    int level = kFirstLevel;
    int samples = 1;
    /// When waiting: decide again then even if nothing happens. None: only when something does.
    std::optional<Clock::time_point> until = {};
};

/// The one place that decides whether a picture is drawn now, and at which level. A moving level is left for
/// the next lower one when it is too slow, and for the next higher one when that is expected to be well
/// within the target: between lies the hysteresis.
PacingDecision decide(const PacingInput& input);

}  // namespace vrut
