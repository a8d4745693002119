#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "measurement/mesh_edges.hpp"

namespace vrut::measurement {

/// Returns the vertices of the closed walk around a smooth region, from the start of a feature half-edge on:
/// each time around the end vertex, through the triangles of the region, to the next feature edge. Empty if
/// the edge is no feature edge, or there is no way back.
std::vector<unsigned> edge_loop(const MeshEdges& edges, unsigned half_edge);

/// The points of a closed loop, its first one again at the end: all, or 64 that are spread evenly.
std::vector<glm::dvec3> thinned_loop(const std::vector<glm::dvec3>& points);

}  // namespace vrut::measurement
