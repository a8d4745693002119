#include "math/frustum.hpp"

namespace vrut::math {

namespace {
// The GPU has positions in float; a few roundings of one add up to less than this part of it.
constexpr double kFloatError = 1e-6;
}  // namespace

Frustum frustum_of(const Projection& projection) {
    // Planes through the eye and a side of the image at z = -1.
    return {{glm::normalize(glm::dvec3(1, 0, projection.left)),
             glm::normalize(glm::dvec3(-1, 0, -projection.right)),
             glm::normalize(glm::dvec3(0, 1, projection.bottom)),
             glm::normalize(glm::dvec3(0, -1, -projection.top)), glm::dvec3(0, 0, -1)}};
}

bool is_outside(const Frustum& frustum, const glm::dmat4& view_from_node, const Bounds& box) {
    const glm::dvec3 center(view_from_node * glm::dvec4(box.center(), 1));
    const glm::dvec3 half = box.half_extent();
    const glm::dmat3 linear(view_from_node);
    const glm::dmat3 axes(linear[0] * half.x, linear[1] * half.y, linear[2] * half.z);
    const glm::dvec3 reach = glm::abs(center) + glm::abs(axes[0]) + glm::abs(axes[1]) + glm::abs(axes[2]);
    const double slack = kFloatError * (reach.x + reach.y + reach.z);
    for (const glm::dvec3& normal : frustum.normals) {
        const glm::dvec3 along = glm::abs(normal * axes);
        if (glm::dot(normal, center) + along.x + along.y + along.z < -slack) return true;
    }
    return false;
}

}  // namespace vrut::math
