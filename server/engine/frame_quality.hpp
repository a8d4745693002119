#pragma once

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

/// Returns true if a picture of this size can be drawn.
inline bool fits(std::int64_t width, std::int64_t height, const PictureLimits& limits) {
    return width <= limits.max_side && height <= limits.max_side && width * height <= limits.max_pixels;
}

/// Of an idle view. While it moves, its frames are of levels: see level_choice.hpp.
inline constexpr protocol::Quality kRefined{protocol::Quality::Level::still,        1, 16, 0, 90,
                                            protocol::Quality::Subsampling::yuv444, {}};
/// How far an idle view is refined: by frames in this order, none while it moves.
enum class Refinement {
    none,
    small,   ///< over a slow link only: of the size of the smallest interactive frames
    first,   ///< full size, one sample
    better,  ///< full size, some samples; not over a slow link, where it takes as long as the last one
    sharp,   ///< kRefined
};
/// Samples of each pixel. Those of full size go on from each other: none is drawn twice.
constexpr int samples_of(Refinement refinement) {
    switch (refinement) {
        case Refinement::none:
        case Refinement::first:
            return 1;
        case Refinement::small:
        case Refinement::better:
            return 4;
        case Refinement::sharp:
            return kRefined.samples;
    }
    return 1;
}
/// The one behind `drawn`, which is not the last.
constexpr Refinement next_refinement(Refinement drawn, bool slow_link) {
    switch (drawn) {
        case Refinement::none:
            return slow_link ? Refinement::small : Refinement::first;
        case Refinement::small:
            return Refinement::first;
        case Refinement::first:
            return slow_link ? Refinement::sharp : Refinement::better;
        default:
            return Refinement::sharp;
    }
}

/// What a picture of `level` is drawn and encoded with: as large as the view and the limits allow.
/// `thin_lines`: never subsampled, since thin red lines would vanish. Of those, and of pictures that the
/// limits make smaller than the level, no error is known.
protocol::Quality quality_of(const protocol::Quality& level, const protocol::Resize& view,
                             const PictureLimits& limits, bool thin_lines);
/// round(CSS size · pixelRatio · scale).
PictureSize picture_size(const protocol::Resize& view, double scale);

}  // namespace vrut::server::engine
