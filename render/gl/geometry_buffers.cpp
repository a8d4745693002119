#include "gl/geometry_buffers.hpp"

#include <algorithm>
#include <cstddef>

#include "gl/vertex_arrays.hpp"

namespace vrut::gl {

namespace {

void add_attribute(const GlVertexArray& vertex_array, GLuint location, GLuint binding, GLint components,
                   std::size_t offset) {
    const GLuint array = vertex_array.get();
    glEnableVertexArrayAttrib(array, location);
    glVertexArrayAttribFormat(array, location, components, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(array, location, binding);
}

/// Until a draw binds its instances, a buffer that no program reads stands in their place, since each
/// attribute must have one.
void add_instances(const GlVertexArray& vertex_array, const GlBuffer& placeholder) {
    const GLuint array = vertex_array.get();
    glVertexArrayVertexBuffer(array, kInstanceBinding, placeholder.get(), 0, 0);
    glVertexArrayBindingDivisor(array, kInstanceBinding, 1);
    const auto add = [&](GLuint location, GLint components, std::size_t offset) {
        add_attribute(vertex_array, location, kInstanceBinding, components, offset);
    };
    for (GLuint column = 0; column < 4; ++column)
        add(3 + column, 4, offsetof(GpuInstance, view_from_local) + column * sizeof(glm::vec4));
    for (GLuint column = 0; column < 3; ++column)
        add(7 + column, 3, offsetof(GpuInstance, normal_matrix) + column * sizeof(glm::vec4));
    add(10, 4, offsetof(GpuInstance, base_sides));
    add(11, 4, offsetof(GpuInstance, diffuse_reflectivity));
    add(12, 4, offsetof(GpuInstance, specular_shininess));
    add(13, 4, offsetof(GpuInstance, clip_plane));
}

/// Of vertices from `first_vertex` on.
GlVertexArray vertex_array_of(const GeometryBuffers& buffers, GLint first_vertex, const GlBuffer& indices) {
    GlVertexArray result = make_vertex_array();
    const GLuint array = result.get();
    const auto bind = [&](GLuint binding, const GlBuffer& buffer, GLsizei stride) {
        glVertexArrayVertexBuffer(array, binding, buffer.get(), GLintptr{first_vertex} * stride, stride);
    };
    glVertexArrayElementBuffer(array, indices.get());
    bind(0, buffers.vertices, sizeof(GpuVertex));
    add_attribute(result, 0, 0, 3, offsetof(GpuVertex, position));
    add_attribute(result, 1, 0, 3, offsetof(GpuVertex, normal));
    if (buffers.texcoords) {
        bind(1, buffers.texcoords, sizeof(glm::vec2));
        add_attribute(result, 2, 1, 2, 0);
    }
    if (buffers.colors) {
        bind(4, buffers.colors, sizeof(glm::vec3));
        add_attribute(result, 4, 4, 3, 0);
    }
    if (buffers.low_positions) {
        bind(2, buffers.low_positions, sizeof(glm::vec3));
        add_attribute(result, 3, 2, 3, 0);
    }
    return result;
}

std::shared_ptr<const GeometryBuffers> make_geometry_buffers(const GeometrySizes& sizes, bool shared) {
    const auto buffers = std::make_shared<GeometryBuffers>();
    buffers->shared = shared;
    buffers->vertices = make_dynamic_buffer("vertices", sizes.vertices * sizeof(GpuVertex));
    buffers->indices = make_dynamic_buffer("triangles", sizes.triangles * sizeof(glm::uvec3));
    if (sizes.texcoords)
        buffers->texcoords = make_dynamic_buffer("texture coordinates", sizes.vertices * sizeof(glm::vec2));
    if (sizes.colors) buffers->colors = make_dynamic_buffer("colours", sizes.vertices * sizeof(glm::vec3));
    if (sizes.low_positions)
        buffers->low_positions =
            make_dynamic_buffer("low parts of positions", sizes.vertices * sizeof(glm::vec3));
    buffers->vertex_array = vertex_array_of(*buffers, 0, buffers->indices);
    if (shared) add_instances(buffers->vertex_array, buffers->vertices);
    return buffers;
}

}  // namespace

GlVertexArray vertex_array_of(const GpuGeometry& geometry, const GlBuffer& indices) {
    return vertex_array_of(*geometry.buffers, geometry.first_vertex, indices);
}

/// As large as all small geometries of the scene need, up to a few megabytes.
GeometryBufferPool::GeometryBufferPool(const scene::Scene& scene) {
    constexpr std::size_t kMostVertices = std::size_t{1} << 15;
    std::size_t triangles = 0;
    for (const scene::Geometry& geometry : scene.geometries())
        if (geometry.triangles.size() <= plan::kMostTrianglesOfSmall) triangles += geometry.triangles.size();
    triangles = std::max(triangles, plan::kMostTrianglesOfSmall);  // levels of others are small, too
    vertices_at_most_ = std::min(3 * triangles, kMostVertices);
    triangles_at_most_ = 2 * std::min(triangles, kMostVertices);
}

GpuGeometry allocate_alone(const GeometrySizes& sizes) {
    GpuGeometry geometry;
    geometry.index_count = static_cast<GLsizei>(sizes.triangles * 3);
    geometry.buffers = make_geometry_buffers(sizes, false);
    return geometry;
}

GpuGeometry GeometryBufferPool::allocate(const GeometrySizes& sizes) {
    // There may be vertices that no triangle uses.
    const bool is_small = sizes.triangles <= plan::kMostTrianglesOfSmall &&
                          sizes.vertices <= 3 * plan::kMostTrianglesOfSmall && !sizes.colors &&
                          !sizes.low_positions;
    if (!is_small) return allocate_alone(sizes);
    GpuGeometry geometry;
    geometry.index_count = static_cast<GLsizei>(sizes.triangles * 3);
    share(sizes, geometry);
    return geometry;
}

void GeometryBufferPool::share(const GeometrySizes& sizes, GpuGeometry& geometry) {
    const std::size_t triangles = 2 * sizes.triangles;  // turned ones, too
    geometry.buffers = shared_.lock();
    if (!geometry.buffers || shared_vertices_ + sizes.vertices > vertices_at_most_ ||
        shared_triangles_ + triangles > triangles_at_most_) {
        geometry.buffers =
            make_geometry_buffers({vertices_at_most_, triangles_at_most_, /*texcoords=*/true}, true);
        shared_ = geometry.buffers;
        shared_vertices_ = shared_triangles_ = 0;
    }
    geometry.first_vertex = static_cast<GLint>(shared_vertices_);
    geometry.first_index = static_cast<GLuint>(3 * shared_triangles_);
    geometry.first_turned_index = static_cast<GLuint>(3 * (shared_triangles_ + sizes.triangles));
    shared_vertices_ += sizes.vertices;
    shared_triangles_ += triangles;
}

}  // namespace vrut::gl
