#pragma once

#include <glm/glm.hpp>

namespace vrut::math {

/// Place of sample `index` of `samples` in its pixel, from the pixel's centre, in pixels, y down: the
/// Hammersley set, moved to be centred.
glm::dvec2 sample_offset(int index, int samples);

}  // namespace vrut::math
