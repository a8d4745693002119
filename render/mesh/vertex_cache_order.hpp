#pragma once

#include <optional>

#include "mesh/simplification.hpp"

namespace vrut::mesh {

/// The geometry's own triangles as level 0, in an order in which neighbours follow each other, so that few
/// vertices are transformed twice (meshoptimizer's, after Forsyth 2006). None where that cannot be, since
/// triangles without normals share no vertices; nor where the file's own order needs less than twice as many,
/// which costs nothing that can be measured.
std::optional<DetailLevel> optimize_vertex_cache(const scene::Geometry& geometry);

}  // namespace vrut::mesh
