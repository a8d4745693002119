#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.hpp"

// A geometry as the GPU takes it: plain data, made on any thread.
namespace vrut::gl {

struct GpuVertex {
    glm::vec3 position, normal;
};

struct VertexArrays {
    std::vector<GpuVertex> vertices;
    std::vector<unsigned> corners;      ///< for each vertex the geometry's of which it is made
    std::vector<glm::uvec3> triangles;  ///< empty: the geometry's
};

/// Corners whose normal is missing or zero get the face normal and a vertex of their own, so that the shader
/// needs no special case. Most geometries have none of them and keep their index buffer.
VertexArrays make_arrays(const scene::Geometry& geometry, const glm::dvec3& origin);

const std::vector<glm::uvec3>& triangles_of(const VertexArrays& arrays, const scene::Geometry& geometry);

/// Subtracts an integer offset, which repeating textures do not show, so that float keeps more digits of the
/// interpolated coordinates.
std::vector<glm::vec2> texcoords_of(const std::vector<unsigned>& corners, const scene::Geometry& geometry);

/// What rounding leaves of each vertex's position relative to `origin`.
std::vector<glm::vec3> low_positions_of(const std::vector<unsigned>& corners, const scene::Geometry& geometry,
                                        const glm::dvec3& origin);

/// Pairs of vertices. An edge takes the normals of the first triangle that it belongs to.
std::vector<glm::uvec2> unique_edges(const scene::Geometry& geometry,
                                     const std::vector<glm::uvec3>& vertices);

}  // namespace vrut::gl
