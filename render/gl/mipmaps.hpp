#pragma once

#include <vector>

#include "scene/image.hpp"

namespace vrut::gl {

/// The levels of an image below its own, down to a single texel. Each is half as wide and high as the one
/// before, rounded down, but at least 1; a texel is the mean of what it covers there, by area. They are
/// computed one from the other in float and rounded to bytes once.
std::vector<scene::Image> mip_levels(const scene::Image& image);

}  // namespace vrut::gl
