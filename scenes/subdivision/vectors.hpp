#pragma once

#include <glm/glm.hpp>

namespace vrut {

/// The vector with length 1, or zero for zero.
inline glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : glm::dvec3(0);
}

}  // namespace vrut
