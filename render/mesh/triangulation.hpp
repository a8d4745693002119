#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace vrut::mesh {

/// Returns corners.size() - 2 triangles, as indices into `corners`, that cover a simple polygon, which is
/// nearly flat and has at least three corners; they are wound as it is. A polygon that crosses itself is
/// covered somehow. Ear clipping, with the reflex corners in a grid (G. Meisters, "Polygons have ears", 1975;
/// D. Eberly, "Triangulation by Ear Clipping", 2002). Takes O(n) time where few corners are reflex.
std::vector<glm::uvec3> triangulate(const std::vector<glm::dvec3>& corners);

/// The same for a polygon with holes in a plane. `corners` has the outer loop, counter-clockwise, and then
/// the holes, clockwise; `hole_starts` has the first corner of each hole. The holes are within the outer
/// loop, and loops may touch, but do not cross. Returns corners.size() + 2 · holes − 2 triangles,
/// counter-clockwise, some of no area; a hole that is not found to be inside is left out, and an outer loop
/// of fewer than three corners has no triangles. Bridges lead from each hole to the loop on its left (Eberly
/// 2002, section 3).
std::vector<glm::uvec3> triangulate(std::span<const glm::dvec2> corners,
                                    std::span<const unsigned> hole_starts);

}  // namespace vrut::mesh
