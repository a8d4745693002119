#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace vrut::mesh {

/// Returns corners.size() - 2 triangles, as indices into `corners`, that cover a simple polygon, which is
/// nearly flat and has at least three corners; they are wound as it is. A polygon that crosses itself is
/// covered somehow. Ear clipping, with the reflex corners in a grid (G. Meisters, "Polygons have ears", 1975;
/// D. Eberly, "Triangulation by Ear Clipping", 2002). Takes O(n) time where few corners are reflex.
std::vector<glm::uvec3> triangulate(const std::vector<glm::dvec3>& corners);

}  // namespace vrut::mesh
