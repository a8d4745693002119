#include "gpu_scene.hpp"

#include <cstddef>

namespace vrut {

namespace {

struct Vertex {
    glm::vec3 position, normal;
};

struct Arrays {
    std::vector<Vertex> vertices;
    std::vector<glm::uvec3> triangles;
};

/// Corners without a normal of their own (none given, or zero) become vertices of one triangle each and take
/// its face's, so that the shader need not know the difference.
Arrays make_arrays(const Geometry& geometry, const glm::dvec3& origin) {
    const auto position = [&](unsigned i) { return glm::vec3(geometry.positions[i] - origin); };
    // Unit, so that float can square them.
    const auto normal = [&](unsigned i) {
        const glm::dvec3 given = geometry.normals.empty() ? glm::dvec3(0) : glm::dvec3(geometry.normals[i]);
        const double length = glm::length(given);
        return length > 0 ? glm::vec3(given / length) : glm::vec3(0);
    };

    Arrays arrays;
    arrays.triangles = geometry.triangles;
    if (!geometry.normals.empty()) {
        arrays.vertices.reserve(geometry.positions.size());
        for (unsigned i = 0; i < geometry.positions.size(); ++i)
            arrays.vertices.push_back({position(i), normal(i)});
    }
    for (glm::uvec3& triangle : arrays.triangles) {
        const glm::uvec3 corners = triangle;
        for (int k = 0; k < 3; ++k) {
            if (normal(corners[k]) != glm::vec3(0)) continue;
            const glm::dvec3& a = geometry.positions[corners[0]];
            const glm::dvec3 cross =
                glm::cross(geometry.positions[corners[1]] - a, geometry.positions[corners[2]] - a);
            const double length = glm::length(cross);
            triangle[k] = static_cast<unsigned>(arrays.vertices.size());
            arrays.vertices.push_back(
                {position(corners[k]), length > 0 ? glm::vec3(cross / length) : glm::vec3(0)});
        }
    }
    return arrays;
}

GpuGeometry upload(const Geometry& geometry) {
    GpuGeometry result;
    result.origin = geometry.bounds.center();
    const Arrays arrays = make_arrays(geometry, result.origin);
    result.vertices = make_buffer(arrays.vertices.data(), arrays.vertices.size() * sizeof(Vertex));
    result.indices = make_buffer(arrays.triangles.data(), arrays.triangles.size() * sizeof(glm::uvec3));
    result.index_count = static_cast<GLsizei>(arrays.triangles.size() * 3);

    result.vertex_array = make_vertex_array();
    const GLuint array = result.vertex_array.get();
    glVertexArrayVertexBuffer(array, 0, result.vertices.get(), 0, sizeof(Vertex));
    glVertexArrayElementBuffer(array, result.indices.get());
    const auto attribute = [&](GLuint location, std::size_t offset) {
        glEnableVertexArrayAttrib(array, location);
        glVertexArrayAttribFormat(array, location, 3, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
        glVertexArrayAttribBinding(array, location, 0);
    };
    attribute(0, offsetof(Vertex, position));
    attribute(1, offsetof(Vertex, normal));
    return result;
}

}  // namespace

GpuScene::GpuScene(std::shared_ptr<const Scene> scene)
    : scene_(std::move(scene)), geometries_(scene_->geometries().size()) {}

const GpuGeometry& GpuScene::geometry(Index index) {
    GpuGeometry& geometry = geometries_[static_cast<std::size_t>(index)];
    if (!geometry.vertex_array) {
        geometry = upload(scene_->geometries()[static_cast<std::size_t>(index)]);
        ++uploads_;
    }
    return geometry;
}

}  // namespace vrut
