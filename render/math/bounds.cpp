#include "math/bounds.hpp"

namespace vrut::math {

// Halves are summed, not sums halved, so that a box near the end of the double range keeps a finite centre.
glm::dvec3 Bounds::center() const { return empty() ? glm::dvec3(0) : min * 0.5 + max * 0.5; }
glm::dvec3 Bounds::half_extent() const { return empty() ? glm::dvec3(0) : max * 0.5 - min * 0.5; }
double Bounds::radius() const { return glm::length(half_extent()); }

void Bounds::add(const Bounds& other) {
    if (other.empty()) return;
    add(other.min);
    add(other.max);
}

Bounds transformed(const glm::dmat4& matrix, const Bounds& box) {
    if (box.empty()) return box;
    const glm::dvec3 center = glm::dvec3(matrix * glm::dvec4(box.center(), 1));
    const glm::dvec3 half = box.half_extent();
    const glm::dvec3 extent = glm::abs(glm::dvec3(matrix[0])) * half.x +
                              glm::abs(glm::dvec3(matrix[1])) * half.y +
                              glm::abs(glm::dvec3(matrix[2])) * half.z;
    Bounds result;
    result.min = center - extent;
    result.max = center + extent;
    return result;
}

std::array<glm::dvec3, 8> corners(const Bounds& box) {
    std::array<glm::dvec3, 8> result{};
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = {(i & 1) ? box.max.x : box.min.x, (i & 2) ? box.max.y : box.min.y,
                     (i & 4) ? box.max.z : box.min.z};
    return result;
}

}  // namespace vrut::math
