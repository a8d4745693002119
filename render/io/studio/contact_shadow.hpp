#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "scene/scene.hpp"

namespace vrut::io {

/// A geometry where a scene shows it.
struct PlacedGeometry {
    const scene::Geometry* geometry = nullptr;
    glm::dmat4 world{1};       ///< world from node
    bool casts_shadow = true;  ///< else it counts for the ground and the size alone
};

/// The shadow of a scene on the ground under a sky that is equally bright everywhere (ambient occlusion), on
/// a rectangle in world space, y up.
struct ContactShadow {
    glm::dvec3 low{0}, high{0};  ///< corners, of one y
    /// Black; alpha is the darkness, 0 at the border. Its u runs along +x, its v along +z.
    scene::Image image;
};

/// The ground is the lowest point. Each of a grid's squares is a column from the lowest to the highest point
/// over it. What blocks the sky at a height is the columns' section there, blurred in proportion to the
/// height; the section that blocks most counts, the less the higher it is. Looks at no more than 2 million
/// triangles, evenly picked, and 5 · 10^7 points on them. None without height, or where coordinates are
/// beyond 4e14.
std::optional<ContactShadow> contact_shadow(std::span<const PlacedGeometry> geometries);

}  // namespace vrut::io
