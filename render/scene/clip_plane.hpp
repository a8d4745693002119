#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "scene/scene.hpp"

namespace vrut::scene {

/// A plane that cuts the scene open, in world space: points p with dot(normal, p) > distance are not shown,
/// but for those of presentation (Node::presentation), which is no part of the product.
struct ClipPlane {
    glm::dvec3 normal{0, 0, 1};  ///< unit
    double distance = 0;         ///< of the plane from the world's origin, along the normal
    /// Watertight parts are closed where it cuts them, by a cap: a face of cap_material(). Others that it
    /// cuts, and all without caps, are open: they are seen from both sides.
    bool caps = true;
    bool hatched = false;  ///< its caps

    bool operator==(const ClipPlane&) const = default;
};

/// Six of a list, and the six of a box.
inline constexpr std::size_t kMostClipPlanes = 12;

/// The plane in the space of a node: points are shown where the dot product with (point, 1) is not negative.
/// Its length depends on the matrix.
glm::dvec4 clip_equation(const ClipPlane& plane, const glm::dmat4& world_from_node);

enum class Side { shown, hidden, crossed };
/// Where a box lies of a plane in its space, as clip_equation() returns it.
Side side_of(const math::Bounds& box, const glm::dvec4& equation);
/// True if some of a geometry's corners are shown and some are not.
bool crosses(const glm::dvec4& equation, const Geometry& geometry);

/// What planes leave of a ray.
struct KeptInterval {
    double first = 0, last = 0;      ///< distances along the ray, from 0 to infinity
    std::optional<std::size_t> cap;  ///< the plane at `first`; none where the ray's origin is shown
};
/// `direction` is unit. None where nothing is left of the ray.
std::optional<KeptInterval> kept_interval(std::span<const ClipPlane> planes, const glm::dvec3& origin,
                                          const glm::dvec3& direction);

/// Of a part's cap: its colours by Phong's equation, without what lies on its surface: textures, highlights,
/// reflections, transparency.
Material cap_material(const Material& material);

}  // namespace vrut::scene
