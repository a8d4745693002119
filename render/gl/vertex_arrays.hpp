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
    std::vector<unsigned> corners;      ///< for each vertex its index in the geometry
    std::vector<glm::uvec3> triangles;  ///< empty: the geometry's
};

/// Returns positions relative to `origin`. A corner whose normal is missing or zero becomes a vertex of its
/// own with the face normal: the shader needs no special case. A geometry without such corners keeps its
/// indices.
VertexArrays make_arrays(const scene::Geometry& geometry, const glm::dvec3& origin);

const std::vector<glm::uvec3>& triangles_of(const VertexArrays& arrays, const scene::Geometry& geometry);

/// Returns the texture coordinates of each vertex.
std::vector<glm::vec2> texcoords_of(const std::vector<unsigned>& corners, const scene::Geometry& geometry);

/// Returns the colour of each vertex.
std::vector<glm::vec3> colors_of(const std::vector<unsigned>& corners, const scene::Geometry& geometry);

/// Returns for each vertex its position relative to `origin` minus that position as float.
std::vector<glm::vec3> low_positions_of(const std::vector<unsigned>& corners, const scene::Geometry& geometry,
                                        const glm::dvec3& origin);

/// Returns pairs of vertices. An edge has the normals of its first triangle.
std::vector<glm::uvec2> unique_edges(const scene::Geometry& geometry,
                                     const std::vector<glm::uvec3>& vertices);

}  // namespace vrut::gl
