#pragma once

#include <optional>

#include "mesh/simplification.hpp"

namespace vrut::mesh {

/// Returns the geometry's triangles as level 0, reordered for the vertex cache (meshoptimizer, after Forsyth
/// 2006). None if triangles without normals share no vertices, or the file's order transforms less than twice
/// as many vertices.
std::optional<DetailLevel> optimize_vertex_cache(const scene::Geometry& geometry);

}  // namespace vrut::mesh
