#pragma once

#include <optional>
#include <vector>

#include "measurement/snapping.hpp"
#include "mesh/picking.hpp"
#include "solids.hpp"

namespace vrut {

/// A ray of the scene as it is, where the scene is placed by a variant.
inline mesh::Ray ray_in(const Variant& variant, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 origin(variant.matrix * glm::dvec4(from, 1));
    return {origin, glm::normalize(glm::dmat3(variant.matrix) * (to - from))};
}

/// What a ray snaps to, or else a ray a little beside it, in either direction.
inline std::optional<measurement::Snapped> snapped(const scene::PlacedScene& placed, const mesh::Ray& ray,
                                                   double radius,
                                                   const std::vector<measurement::Snap>& to = {}) {
    measurement::MeshEdgesMemo memo;
    const glm::dvec3 side = glm::normalize(glm::cross(ray.direction, glm::dvec3(0.3, 0.5, 0.7)));
    for (int i = 0; i < 9; ++i) {
        const double angle = 0.78539816339744831 * i;
        const glm::dvec3 aside = side * std::cos(angle) + glm::cross(ray.direction, side) * std::sin(angle);
        const mesh::Ray near{ray.origin, glm::normalize(ray.direction + aside * (i == 0 ? 0 : 0.9 * radius))};
        if (const auto hit = mesh::pick(placed, near))
            return measurement::snap(placed, *hit, ray, {.radius = radius, .to = to}, memo);
    }
    return {};
}

}  // namespace vrut
