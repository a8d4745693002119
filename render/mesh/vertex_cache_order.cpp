#include "mesh/vertex_cache_order.hpp"

#include <meshoptimizer.h>

namespace vrut::mesh {

namespace {

constexpr std::size_t kMinTriangles = 1000;  ///< triangles; the vertices of fewer stay in any cache
constexpr unsigned kCached = 32;             ///< vertices, on the graphics cards that there are

unsigned transformed_vertices(const std::vector<glm::uvec3>& triangles, std::size_t vertices) {
    return meshopt_analyzeVertexCache(&triangles[0].x, triangles.size() * 3, vertices, kCached, 0, 0)
        .vertices_transformed;
}

}  // namespace

std::optional<DetailLevel> optimize_vertex_cache(const scene::Geometry& geometry) {
    if (geometry.triangles.size() < kMinTriangles || geometry.normals.empty()) return std::nullopt;
    const std::size_t vertices = geometry.positions.size();
    DetailLevel level{0, 0, std::vector<glm::uvec3>(geometry.triangles.size())};
    meshopt_optimizeVertexCache(&level.triangles[0].x, &geometry.triangles[0].x,
                                geometry.triangles.size() * 3, vertices);
    if (transformed_vertices(geometry.triangles, vertices) <
        2 * transformed_vertices(level.triangles, vertices))
        return std::nullopt;
    return level;
}

}  // namespace vrut::mesh
