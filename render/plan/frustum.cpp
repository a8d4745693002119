#include "plan/frustum.hpp"

#include <cmath>

namespace vrut::plan {

namespace {
// The GPU has positions in float; a few roundings of one add up to less than this part of it.
constexpr double kFloatError = 1e-6;
}  // namespace

NdcRect ndc_with_margin(int width, int height, double pixels) {
    const glm::dvec2 edge = 1.0 + 2 * pixels / glm::dvec2(width, height);
    return {-edge, edge};
}

Frustum frustum_of(const scene::Camera& camera, double aspect, const NdcRect& area) {
    const double half = std::tan(camera.fov * scene::kRadiansPerDegree / 2);
    const glm::dvec2 low = area.low * half * glm::dvec2(aspect, 1);
    const glm::dvec2 high = area.high * half * glm::dvec2(aspect, 1);
    // Through the eye and an edge of the area at z = -1.
    return {{glm::normalize(glm::dvec3(1, 0, low.x)), glm::normalize(glm::dvec3(-1, 0, -high.x)),
             glm::normalize(glm::dvec3(0, 1, low.y)), glm::normalize(glm::dvec3(0, -1, -high.y)),
             glm::dvec3(0, 0, -1)}};
}

bool is_outside(const Frustum& frustum, const glm::dmat4& view_from_node, const math::Bounds& box) {
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

}  // namespace vrut::plan
