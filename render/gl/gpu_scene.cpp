#include "gl/gpu_scene.hpp"

#include <cstddef>
#include <utility>

#include "gl/gpu_textures.hpp"
#include "gl/vertex_arrays.hpp"
#include "mesh/simplification.hpp"

namespace vrut::gl {

namespace {

GlVertexArray vertex_array_of(const GlBuffer& vertices, const GlBuffer& indices) {
    GlVertexArray result = make_vertex_array();
    const GLuint array = result.get();
    glVertexArrayVertexBuffer(array, 0, vertices.get(), 0, sizeof(GpuVertex));
    glVertexArrayElementBuffer(array, indices.get());
    const auto attribute = [&](GLuint location, std::size_t offset) {
        glEnableVertexArrayAttrib(array, location);
        glVertexArrayAttribFormat(array, location, 3, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
        glVertexArrayAttribBinding(array, location, 0);
    };
    attribute(0, offsetof(GpuVertex, position));
    attribute(1, offsetof(GpuVertex, normal));
    return result;
}

void add_texcoords(const GlBuffer& texcoords, const GlVertexArray& vertex_array) {
    const GLuint array = vertex_array.get();
    glVertexArrayVertexBuffer(array, 1, texcoords.get(), 0, sizeof(glm::vec2));
    glEnableVertexArrayAttrib(array, 2);
    glVertexArrayAttribFormat(array, 2, 2, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(array, 2, 1);
}

GpuGeometry upload(const scene::Geometry& geometry) {
    GpuGeometry result;
    result.origin = geometry.bounds.center();
    const VertexArrays arrays = make_arrays(geometry, result.origin);
    result.vertices =
        make_buffer("vertices", arrays.vertices.data(), arrays.vertices.size() * sizeof(GpuVertex));
    const std::vector<glm::uvec3>& triangles = triangles_of(arrays, geometry);
    result.indices = make_buffer("triangles", triangles.data(), triangles.size() * sizeof(glm::uvec3));
    result.index_count = static_cast<GLsizei>(triangles.size() * 3);

    result.vertex_array = vertex_array_of(result.vertices, result.indices);
    if (geometry.texcoords.empty()) return result;
    const std::vector<glm::vec2> texcoords = texcoords_of(arrays.corners, geometry);
    result.texcoords =
        make_buffer("texture coordinates", texcoords.data(), texcoords.size() * sizeof(glm::vec2));
    add_texcoords(result.texcoords, result.vertex_array);
    return result;
}

GpuEdges upload_edges(const scene::Geometry& geometry, const GpuGeometry& uploaded) {
    GpuEdges result;
    const VertexArrays arrays = make_arrays(geometry, uploaded.origin);
    const auto edges = unique_edges(geometry, triangles_of(arrays, geometry));
    if (edges.empty()) return result;
    result.indices = make_buffer("edges", edges.data(), edges.size() * sizeof(glm::uvec2));
    result.vertex_array = vertex_array_of(uploaded.vertices, result.indices);
    result.index_count = static_cast<GLsizei>(edges.size() * 2);
    return result;
}

}  // namespace

GpuScene::GpuScene(std::shared_ptr<const scene::Scene> scene)
    : scene_(std::move(scene)),
      geometries_(scene_->geometries().size()),
      edges_(geometries_.size()),
      textures_(scene_->textures().size()) {}

void GpuScene::upload_shown(const plan::View& view) {
    for (const plan::DrawItem& item : plan::visible_items(view)) {
        geometry(item.geometry);
        if (item.texture != scene::kNone) texture(item.texture);
    }
    if (view.background.cube_map)
        cube_map(*view.background.cube_map);
    else if (view.background.texture != scene::kNone)
        texture(view.background.texture);
}

const GpuGeometry& GpuScene::geometry(scene::Index index) {
    GpuGeometry& geometry = geometries_[static_cast<std::size_t>(index)];
    if (!geometry.vertex_array) {
        geometry = upload(scene_->geometries()[static_cast<std::size_t>(index)]);
        ++uploads_;
    }
    return geometry;
}

const GpuGeometry& GpuScene::geometry(const plan::DrawItem& item) {
    if (!item.level) return geometry(item.geometry);
    GpuGeometry& level = levels_[{item.geometry, item.level->number}];
    if (!level.vertex_array) {
        level = upload(
            mesh::geometry_of(scene_->geometries()[static_cast<std::size_t>(item.geometry)], *item.level));
        ++uploads_;
        // The same in another order: what still needs the file's uploads it again.
        if (item.level->number == 0) geometries_[static_cast<std::size_t>(item.geometry)] = {};
    }
    return level;
}

bool GpuScene::is_resident(const plan::DrawItem& item) const {
    if (!item.level) return bool(geometries_[static_cast<std::size_t>(item.geometry)].vertex_array);
    return levels_.contains({item.geometry, item.level->number});
}

const GpuEdges& GpuScene::edges(scene::Index index) {
    std::optional<GpuEdges>& edges = edges_[static_cast<std::size_t>(index)];
    if (!edges) {
        edges = upload_edges(scene_->geometries()[static_cast<std::size_t>(index)], geometry(index));
        ++uploads_;
    }
    return *edges;
}

const GlTexture& GpuScene::texture(scene::Index index) {
    GlTexture& texture = textures_[static_cast<std::size_t>(index)];
    if (!texture) {
        texture = upload_texture(scene_->textures()[static_cast<std::size_t>(index)].image);
        ++uploads_;
    }
    return texture;
}

const GlTexture& GpuScene::cube_map(const std::array<scene::Index, 6>& textures) {
    GlTexture& cube_map = cube_maps_[textures];
    if (!cube_map) {
        std::array<const scene::Image*, 6> images{};
        for (std::size_t i = 0; i < 6; ++i)
            images[i] = &scene_->textures()[static_cast<std::size_t>(textures[i])].image;
        cube_map = upload_cube_map(images);
        ++uploads_;
    }
    return cube_map;
}

const GpuTriangles& GpuScene::sorted_triangles(const plan::DrawItem& item) {
    const std::vector<unsigned>& order = *item.order;
    GpuTriangles& result = sorted_triangles_[{item.geometry, order.size()}];
    if (result.order && (result.order == item.order || *result.order == order)) return result;
    if (!result.vertex_array) {
        const GpuGeometry& uploaded = geometry(item.geometry);
        const scene::Geometry& read = scene_->geometries()[static_cast<std::size_t>(item.geometry)];
        result.in_file = triangles_of(make_arrays(read, uploaded.origin), read);
        result.indices = make_dynamic_buffer("ordered triangles", order.size() * sizeof(glm::uvec3));
        result.vertex_array = vertex_array_of(uploaded.vertices, result.indices);
        if (uploaded.texcoords) add_texcoords(uploaded.texcoords, result.vertex_array);
        result.index_count = static_cast<GLsizei>(order.size() * 3);
        ++uploads_;
    }
    std::vector<glm::uvec3> triangles;
    triangles.reserve(order.size());
    for (const unsigned number : order) {
        glm::uvec3& triangle = triangles.emplace_back(result.in_file[number % result.in_file.size()]);
        if (number >= result.in_file.size()) std::swap(triangle.y, triangle.z);
    }
    glNamedBufferSubData(result.indices.get(), 0,
                         static_cast<GLsizeiptr>(triangles.size() * sizeof(glm::uvec3)), triangles.data());
    result.order = item.order;
    return result;
}

}  // namespace vrut::gl
