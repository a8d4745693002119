#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace vrut::measurement {

inline bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The largest of the coordinates' magnitudes.
inline double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Length 1, of vectors whose square is beyond the range of double, too; 0 of what has no direction.
inline glm::dvec3 unit(const glm::dvec3& v) {
    const double size = largest(v);
    if (!(size > 0) || !is_finite(v)) return glm::dvec3(0);
    return glm::normalize(v / size);
}

/// The sine of the angle between two vectors; 0 if one has no direction.
inline double sine(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(glm::cross(unit(a), unit(b)));
}

/// Of vectors whose angle's sine is no larger, all points are on one line, but for rounding.
inline constexpr double kLeastSine = 1e-12;

/// The length, of vectors whose square is beyond the range of double, too.
inline double safe_length(const glm::dvec3& v) { return std::hypot(v.x, v.y, v.z); }

}  // namespace vrut::measurement
