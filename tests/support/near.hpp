#pragma once

#include <glm/glm.hpp>

inline bool near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
    return glm::distance(a, b) <= tolerance;
}
