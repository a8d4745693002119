#include "gl/gpu_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>

#include "gl/gpu_textures.hpp"
#include "mesh/simplification.hpp"

namespace vrut::gl {

namespace {

struct GpuVertex {
    glm::vec3 position, normal;
};

struct VertexArrays {
    std::vector<GpuVertex> vertices;
    std::vector<unsigned> corners;      ///< for each vertex the geometry's of which it is made
    std::vector<glm::uvec3> triangles;  ///< empty: the geometry's
};

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

/// Corners whose normal is missing or zero get the face normal and a vertex of their own, so that the shader
/// needs no special case. Most geometries have none of them and keep their index buffer.
VertexArrays make_arrays(const scene::Geometry& geometry, const glm::dvec3& origin) {
    const auto position = [&](unsigned i) { return glm::vec3(geometry.positions[i] - origin); };
    // Unit, so that float can square them.
    const auto normal = [&](unsigned i) {
        const glm::dvec3 given = geometry.normals.empty() ? glm::dvec3(0) : glm::dvec3(geometry.normals[i]);
        const double length = glm::length(given);
        return length > 0 ? glm::vec3(given / length) : glm::vec3(0);
    };

    VertexArrays arrays;
    bool all = !geometry.normals.empty();
    if (all) {
        arrays.vertices.reserve(geometry.positions.size());
        for (unsigned i = 0; i < geometry.positions.size(); ++i) {
            arrays.vertices.push_back({position(i), normal(i)});
            all = all && arrays.vertices.back().normal != glm::vec3(0);
        }
        arrays.corners.resize(arrays.vertices.size());
        std::iota(arrays.corners.begin(), arrays.corners.end(), 0U);
    }
    if (all) return arrays;
    arrays.triangles = geometry.triangles;
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
            arrays.corners.push_back(corners[k]);
        }
    }
    return arrays;
}

const std::vector<glm::uvec3>& triangles_of(const VertexArrays& arrays, const scene::Geometry& geometry) {
    return arrays.triangles.empty() ? geometry.triangles : arrays.triangles;
}

/// Subtracts an integer offset, which repeating textures do not show, so that float keeps more digits of the
/// interpolated coordinates.
std::vector<glm::vec2> texcoords_of(const std::vector<unsigned>& corners, const scene::Geometry& geometry) {
    glm::dvec2 low(geometry.texcoords.front()), high = low;
    for (const glm::dvec2 texcoord : geometry.texcoords) {
        low = glm::min(low, texcoord);
        high = glm::max(high, texcoord);
    }
    const glm::dvec2 origin = glm::floor((low + high) / 2.0);
    std::vector<glm::vec2> result;
    result.reserve(corners.size());
    for (const unsigned corner : corners)
        result.emplace_back(glm::dvec2(geometry.texcoords[corner]) - origin);
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

/// For each position the lowest index of one that is the same, so that corners with normals of their own are
/// known as one.
std::vector<unsigned> first_with_same_position(const std::vector<glm::dvec3>& positions) {
    std::vector<unsigned> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto before = [&](unsigned a, unsigned b) {
        const glm::dvec3 &p = positions[a], &q = positions[b];
        return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
    };
    std::sort(order.begin(), order.end(), before);
    std::vector<unsigned> first(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

/// Pairs of vertices. An edge takes the normals of the first triangle that it belongs to.
std::vector<glm::uvec2> unique_edges(const scene::Geometry& geometry,
                                     const std::vector<glm::uvec3>& vertices) {
    struct EdgeCandidate {
        glm::uvec2 corners;  // known as one, the lower first
        std::size_t number;
        glm::uvec2 vertices;
    };
    const std::vector<unsigned> representative = first_with_same_position(geometry.positions);
    std::vector<EdgeCandidate> edges;
    edges.reserve(vertices.size() * 3);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            const int next = (k + 1) % 3;
            const unsigned a = representative[geometry.triangles[i][k]],
                           b = representative[geometry.triangles[i][next]];
            if (a == b) continue;
            edges.push_back(
                {{std::min(a, b), std::max(a, b)}, edges.size(), {vertices[i][k], vertices[i][next]}});
        }
    const auto key = [](const EdgeCandidate& edge) {
        return std::tie(edge.corners.x, edge.corners.y, edge.number);
    };
    std::sort(edges.begin(), edges.end(),
              [&](const EdgeCandidate& a, const EdgeCandidate& b) { return key(a) < key(b); });
    std::vector<glm::uvec2> result;
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (i == 0 || edges[i].corners != edges[i - 1].corners) result.push_back(edges[i].vertices);
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

bool GpuScene::ByOrder::operator()(const GpuTriangles* a, const GpuTriangles* b) const {
    if (a->geometry != b->geometry) return a->geometry < b->geometry;
    return a->order != b->order && *a->order < *b->order;
}

/// The geometry's triangles by the vertices that they have in its buffers.
const std::vector<glm::uvec3>& GpuScene::uploaded_triangles(scene::Index index) {
    const auto [found, is_new] = uploaded_triangles_.try_emplace(index);
    if (is_new) {
        const scene::Geometry& read = scene_->geometries()[static_cast<std::size_t>(index)];
        found->second = triangles_of(make_arrays(read, read.bounds.center()), read);
    }
    return found->second;
}

GpuTriangles GpuScene::upload_sorted(const plan::DrawItem& item) {
    const std::vector<glm::uvec3>& in_file = uploaded_triangles(item.geometry);
    std::vector<glm::uvec3> triangles;
    triangles.reserve(item.order->size());
    for (const unsigned number : *item.order) {
        glm::uvec3& triangle = triangles.emplace_back(in_file[number % in_file.size()]);
        if (number >= in_file.size()) std::swap(triangle.y, triangle.z);
    }
    const GpuGeometry& uploaded = geometry(item.geometry);
    GpuTriangles result{item.geometry, item.order, {}, {}, static_cast<GLsizei>(triangles.size() * 3)};
    result.indices =
        make_buffer("ordered triangles", triangles.data(), triangles.size() * sizeof(glm::uvec3));
    result.vertex_array = vertex_array_of(uploaded.vertices, result.indices);
    if (uploaded.texcoords) add_texcoords(uploaded.texcoords, result.vertex_array);
    ++uploads_;
    return result;
}

const GpuTriangles& GpuScene::sorted_triangles(const plan::DrawItem& item) {
    GpuTriangles wanted;
    wanted.geometry = item.geometry;
    wanted.order = item.order;
    if (const auto found = sorted_by_order_.find(&wanted); found != sorted_by_order_.end()) {
        sorted_triangles_.splice(sorted_triangles_.begin(), sorted_triangles_, found->second);
        return sorted_triangles_.front();
    }
    constexpr std::size_t kObjectBytes = 1024;  // about what the driver takes for a buffer and a vertex array
    const auto bytes = [](const GpuTriangles& triangles) {
        return kObjectBytes + triangles.order->size() * sizeof(glm::uvec3);
    };
    while (!sorted_triangles_.empty() && sorted_bytes_ + bytes(wanted) > kMaxSortedBytes) {
        sorted_bytes_ -= bytes(sorted_triangles_.back());
        sorted_by_order_.erase(&sorted_triangles_.back());
        sorted_triangles_.pop_back();
    }
    sorted_triangles_.push_front(upload_sorted(item));
    sorted_by_order_.emplace(&sorted_triangles_.front(), sorted_triangles_.begin());
    sorted_bytes_ += bytes(wanted);
    return sorted_triangles_.front();
}

}  // namespace vrut::gl
