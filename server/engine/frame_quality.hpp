#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

#include "base/clock.hpp"
#include "frame_header.hpp"

namespace vrut::server::engine {

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

/// Of an idle view. While it moves, its frames are of levels: see level_choice.hpp.
inline constexpr protocol::Quality kRefined{protocol::Quality::Level::still,        1, 16, 0, 90,
                                            protocol::Quality::Subsampling::yuv444, {}};
/// Samples of the frames that refine an idle view, in their order.
inline constexpr std::array kRefinedSamples{4, kRefined.samples};

/// What a picture of `level` is drawn and encoded with: as large as the view and the limits allow.
/// `thin_lines`: never subsampled, since thin red lines would vanish. Of those, and of pictures that the
/// limits make smaller than the level, no error is known.
protocol::Quality quality_of(const protocol::Quality& level, const protocol::Resize& view,
                             const PictureLimits& limits, bool thin_lines);
/// round(CSS size · pixelRatio · scale).
PictureSize picture_size(const protocol::Resize& view, double scale);

}  // namespace vrut::server::engine
