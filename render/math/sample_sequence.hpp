#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace vrut::math {

/// Position of sample `index` in its pixel, from the pixel's centre, in pixels, y down: a Sobol'
/// (0,2)-sequence in base 2 with nested uniform scrambling (Owen, "Randomly Permuted (t,m,s)-Nets and
/// (t,s)-Sequences", 1995). Its first point is the centre. Any of its beginnings is a set of samples: of the
/// first 2^k each row, each column and each other elementary interval of area 2^-k has one.
glm::dvec2 sample_offset(std::uint32_t index);

}  // namespace vrut::math
