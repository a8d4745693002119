#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace vrut::math {

/// The points p with normal · (p - point) = 0.
struct Plane {
    glm::dvec3 normal{0, 0, 1};  ///< unit
    glm::dvec3 point{0};

    /// Above 0 on the side that the normal points to.
    double distance(const glm::dvec3& p) const { return glm::dot(normal, p - point); }
};

/// Returns the plane transformed by an affine `matrix`; none if the matrix collapses it.
std::optional<Plane> transformed(const glm::dmat4& matrix, const Plane& plane);

/// The reflection about a plane, for column vectors (Macků 2016, eq. 6.12).
glm::dmat4 reflection_about(const Plane& plane);

}  // namespace vrut::math
