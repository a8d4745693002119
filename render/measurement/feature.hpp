#pragma once

#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace vrut::measurement {

/// What of a part is picked. The first of its points is the picked one.
enum class Snap {
    point,     ///< of a surface
    vertex,    ///< of a mesh
    midpoint,  ///< of a straight edge
    center,    ///< of a circle; then two points of the circle, a quarter turn apart in the world
    edge,      ///< a straight one: a point of it, then its ends
    loop,      ///< a point of it, then the ends of a mesh edge of it, counter-clockwise from the front
    plane,     ///< three points that span it, counter-clockwise from the front
};

/// The word of the state document.
std::string_view name_of(Snap snap);

/// How many points a feature of this kind has: 1 or 3.
std::size_t point_count(Snap snap);

/// A picked place that moves with its part.
struct Feature {
    scene::Id node = 0;
    Snap snap = Snap::point;
    std::vector<glm::dvec3> points;  ///< in the node's space

    bool operator==(const Feature&) const = default;
};

}  // namespace vrut::measurement
