#pragma once

#include <vector>

#include "scene/image.hpp"

namespace vrut {

/// The levels of an image below its own, down to a single texel. Each is half as wide and high as the one
/// before, rounded down, but at least 1; a texel is the mean of what it covers there, by area. They are
/// computed one from the other in float and rounded to bytes once.
std::vector<Image> mip_levels(const Image& image);

}  // namespace vrut
