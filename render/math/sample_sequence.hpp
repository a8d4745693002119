#pragma once

#include <glm/glm.hpp>

namespace vrut::math {

/// Returns the offset of sample `index` of `samples` from the pixel's centre, in pixels, y down: the
/// Hammersley set, shifted to be centred.
glm::dvec2 sample_offset(int index, int samples);

}  // namespace vrut::math
