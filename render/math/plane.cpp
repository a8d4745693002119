#include "math/plane.hpp"

#include <cmath>

namespace vrut::math {

std::optional<Plane> transformed(const glm::dmat4& matrix, const Plane& plane) {
    // Two directions in the plane keep their plane under any matrix that does not collapse it.
    const glm::dvec3& n = plane.normal;
    const glm::dvec3 across =
        glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dmat3 linear(matrix);
    const glm::dvec3 u = linear * across, v = linear * glm::cross(n, across);
    const glm::dvec3 normal = glm::cross(u, v);
    const double length = glm::length(normal);
    if (!(length > 1e-12 * glm::length(u) * glm::length(v)) || !std::isfinite(length)) return std::nullopt;
    return Plane{normal / length, glm::dvec3(matrix * glm::dvec4(plane.point, 1))};
}

glm::dmat4 reflection_about(const Plane& plane) {
    const glm::dvec3& n = plane.normal;
    glm::dmat4 matrix(glm::dmat3(1) - 2.0 * glm::outerProduct(n, n));
    matrix[3] = glm::dvec4(2 * glm::dot(n, plane.point) * n, 1);
    return matrix;
}

}  // namespace vrut::math
