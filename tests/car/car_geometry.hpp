#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace vrut {

/// Names from below the root, as "Body/Doors/Front left".
std::string path_of(const scene::Scene& scene, scene::Index node);
/// kNone where there is none.
scene::Index node_at(const scene::Scene& scene, const std::string& path);

/// A surface whose corners are one where their positions are the same to the last bit.
struct Surface {
    std::vector<glm::dvec3> points;
    std::vector<glm::uvec3> triangles;
};
Surface welded(const std::vector<const scene::Geometry*>& geometries);

/// What a closed, oriented surface does not have.
struct OpenEdges {
    int open = 0;     ///< directed edges without one back
    int crowded = 0;  ///< directed edges that more than one triangle has
    glm::dvec3 at{0};
};
OpenEdges open_edges(const Surface& surface);

/// Enclosed by each of the parts that hang together.
struct Body {
    double volume = 0;
    glm::dvec3 at{0};
    std::size_t triangles = 0;
};
std::vector<Body> bodies_of(const Surface& surface);

/// How far a geometry's corners are from one plane at most.
double unevenness(const Surface& surface);

}  // namespace vrut
