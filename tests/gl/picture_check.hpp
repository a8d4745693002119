#pragma once

#include <string>

#include "plan/view.hpp"
#include "scene/image.hpp"

namespace vrut {

/// How a drawn picture differs from the reference's, which is not rounded.
struct PictureMismatch {
    double worst = 0;   ///< the largest difference of a channel, of 255
    double rms = 0;     ///< the root of the mean square over channels and pixels, of 255
    std::string where;  ///< the worst pixel and both its colours
    int compared = 0;   ///< pixels
    int surfaces = 0;   ///< those of them that show a surface
};

/// Compares `drawn` with the reference's picture of `view` at all pixels that no outline or edge passes
/// through. There the reference has a colour, but not that a hair's breadth decides which side is drawn: that
/// is all that is added to it here.
PictureMismatch mismatch(const plan::View& view, const scene::Image& drawn);

/// The bytes at a pixel, y from the top.
glm::ivec3 pixel_of(const scene::Image& image, int x, int y);
glm::ivec3 bytes_of(const glm::dvec3& color);

}  // namespace vrut
