#pragma once

#include <array>
#include <glm/glm.hpp>
#include <limits>

namespace vrut::math {

/// Axis-aligned box in the scene's unit. Starts empty: `min` above `max`.
struct Bounds {
    glm::dvec3 min{std::numeric_limits<double>::infinity()};
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};

    bool empty() const { return min.x > max.x; }
    glm::dvec3 center() const;
    glm::dvec3 half_extent() const;
    /// Radius of the sphere around the box; 0 when empty.
    double radius() const;

    void add(const glm::dvec3& point) {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    void add(const Bounds& other);
};

/// Returns the bounds of `box` transformed by an affine `matrix`: centre and |M| · half extent.
Bounds transformed(const glm::dmat4& matrix, const Bounds& box);

/// The eight corners of a box that is not empty.
std::array<glm::dvec3, 8> corners(const Bounds& box);

}  // namespace vrut::math
