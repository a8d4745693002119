#include "gl/gpu_scene.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "gl/vertex_arrays.hpp"
#include "mesh/simplification.hpp"
#include "plan/frame_plan.hpp"

namespace vrut::gl {

namespace {

/// Of a geometry of the scene, whose triangles need no copy; else with its triangles.
PreparedData geometry_data(const scene::Geometry& geometry, bool double_single) {
    PreparedData data;
    const glm::dvec3 origin = geometry.bounds.center();
    data.arrays = make_arrays(geometry, origin);
    data.clusters = mesh::triangle_clusters(geometry);
    if (double_single) data.low_positions = low_positions_of(data.arrays.corners, geometry, origin);
    if (!geometry.texcoords.empty()) data.texcoords = texcoords_of(data.arrays.corners, geometry);
    if (!geometry.colors.empty()) data.colors = colors_of(data.arrays.corners, geometry);
    return data;
}

PreparedData level_data(const scene::Geometry& geometry, const mesh::DetailLevel& level, bool double_single) {
    scene::Geometry simplified = mesh::geometry_of(geometry, level);
    PreparedData data = geometry_data(simplified, double_single);
    if (data.arrays.triangles.empty()) data.arrays.triangles = std::move(simplified.triangles);
    return data;
}

PreparedData edges_data(const scene::Geometry& geometry) {
    const VertexArrays arrays = make_arrays(geometry, geometry.bounds.center());
    PreparedData data;
    data.edges = unique_edges(geometry, triangles_of(arrays, geometry));
    return data;
}

int limit_of(GLenum name) {
    GLint limit = 0;
    glGetIntegerv(name, &limit);
    return limit;
}

using ResourceKind = ResourceKey::Kind;

std::array<const scene::Image*, 6> images_of(const scene::Scene& scene,
                                             const std::array<scene::Index, 6>& textures) {
    std::array<const scene::Image*, 6> images{};
    for (std::size_t i = 0; i < 6; ++i)
        images[i] = &scene.textures()[static_cast<std::size_t>(textures[i])].image;
    return images;
}

bool is_metallic_roughness(const scene::Material& material) {
    return material.metallic_roughness.has_value();
}

ResourceKey key_of(ResourceKind kind, scene::Index index, int level = 0) { return {kind, {index, level}}; }

}  // namespace

GpuScene::GpuScene(std::shared_ptr<const scene::Scene> scene)
    : scene_(std::move(scene)),
      geometries_(scene_->geometries().size()),
      edges_(geometries_.size()),
      textures_(scene_->textures().size()),
      lit_by_environment_(std::ranges::any_of(scene_->materials(), is_metallic_roughness)),
      buffer_pool_(*scene_) {}

// --- requests

bool GpuScene::is_resident(const ResourceKey& key) const {
    const auto index = static_cast<std::size_t>(key.indices[0]);
    switch (key.kind) {
        case ResourceKind::geometry:
            return bool(geometries_[index].buffers);
        case ResourceKind::level:
            return levels_.contains({key.indices[0], key.indices[1]});
        case ResourceKind::edges:
            return edges_[index].has_value();
        case ResourceKind::texture:
            return bool(textures_[index]);
        case ResourceKind::cube_map:
            return cube_maps_.contains(key.indices);
        case ResourceKind::environment_light:
            return environment_lights_.contains(key.indices);
    }
    return false;
}

bool GpuScene::can_draw(scene::Index geometry, const mesh::DetailLevel& level) const {
    if (is_resident(key_of(ResourceKind::level, geometry, level.number))) return true;
    const auto any = levels_.lower_bound({geometry, 0});
    return !is_resident(key_of(ResourceKind::geometry, geometry)) &&
           (any == levels_.end() || any->first.first != geometry);
}

/// Of what is not resident.
template <class Make>
bool GpuScene::request(const ResourceKey& key, Need need, const Make& make) {
    if (need == Need::soon && failed_.contains(key)) return false;
    const auto [requested, is_new] = requested_.try_emplace(key, need);
    if (need == Need::now) requested->second = need;
    if (is_new) preparation_.post(key, need, make);
    return false;
}

bool GpuScene::request_geometry(scene::Index index, Need need) {
    const ResourceKey key = key_of(ResourceKind::geometry, index);
    return is_resident(key) || request(key, need, [scene = scene_, index, &read = read_geometry(index)] {
               return geometry_data(read, scene->needs_double_single(index));
           });
}

bool GpuScene::request(scene::Index geometry, const mesh::DetailLevel& level,
                       const std::shared_ptr<const mesh::DetailLevels>& levels, Need need) {
    const ResourceKey key = key_of(ResourceKind::level, geometry, level.number);
    return is_resident(key) ||
           request(key, need, [scene = scene_, geometry, levels, &read = read_geometry(geometry), &level] {
               return level_data(read, level, scene->needs_double_single(geometry));
           });
}

bool GpuScene::request(const plan::DrawItem& item, const std::shared_ptr<const mesh::DetailLevels>& levels) {
    if (item.cut) return true;
    bool has_textures = true;
    for (const scene::Index texture : {item.texture, item.emissive_texture,
                                       item.occlusion_roughness_metallic_texture, item.normal_texture})
        has_textures = (texture == scene::kNone || request_texture(texture)) && has_textures;
    if (item.level) return request(item.geometry, *item.level, levels, Need::now) && has_textures;
    const bool has_level = !item.order && is_resident(key_of(ResourceKind::level, item.geometry, 0));
    return (has_level || request_geometry(item.geometry, Need::now)) && has_textures;
}

bool GpuScene::request_edges(const plan::DrawItem& item, Need need) {
    const scene::Index index = item.geometry;
    const ResourceKey key = key_of(ResourceKind::edges, index);
    const bool has_geometry = request_geometry(index, need);
    const bool has_edges =
        is_resident(key) ||
        request(key, need, [scene = scene_, &read = read_geometry(index)] { return edges_data(read); });
    return has_edges && has_geometry;
}

bool GpuScene::request_texture(scene::Index index) {
    return is_resident(key_of(ResourceKind::texture, index)) ||
           request(key_of(ResourceKind::texture, index), Need::now, make_texture(index));
}

std::function<PreparedData()> GpuScene::make_texture(scene::Index index) const {
    const bool is_color = std::ranges::none_of(scene_->materials(), [&](const scene::Material& material) {
        return material.normal_texture == index || material.occlusion_roughness_metallic_texture == index;
    });
    return [scene = scene_, index, is_color, largest = limit_of(GL_MAX_TEXTURE_SIZE)] {
        PreparedData data;
        const scene::Texture& texture = scene->textures()[static_cast<std::size_t>(index)];
        data.texture = texture_data(texture.image, largest);
        data.texture.is_color = is_color;
        data.texture.sampler = texture.sampler;
        return data;
    };
}

bool GpuScene::request_cube_map(const std::array<scene::Index, 6>& textures) {
    const ResourceKey key{ResourceKind::cube_map, textures};
    return is_resident(key) || request(key, Need::now, make_cube_map(textures));
}

std::function<PreparedData()> GpuScene::make_cube_map(const std::array<scene::Index, 6>& textures) const {
    return [scene = scene_, textures, largest = limit_of(GL_MAX_CUBE_MAP_TEXTURE_SIZE)] {
        PreparedData data;
        data.texture = cube_map_data(images_of(*scene, textures), largest);
        return data;
    };
}

bool GpuScene::request_environment_light(const std::array<scene::Index, 6>& textures) {
    const ResourceKey key{ResourceKind::environment_light, textures};
    return is_resident(key) || request(key, Need::now, make_environment_light(textures));
}

std::function<PreparedData()> GpuScene::make_environment_light(
    const std::array<scene::Index, 6>& textures) const {
    return [scene = scene_, textures] {
        PreparedData data;
        const scene::EnvironmentLight light = scene::prefilter(images_of(*scene, textures));
        data.texture = prefiltered_data(light);
        data.harmonics = light.harmonics;
        return data;
    };
}

bool GpuScene::request_background(const plan::View& view) {
    const plan::Background& background = view.background;
    bool has_cube_map = !background.cube_map || request_cube_map(*background.cube_map);
    if (background.cube_map && lit_by_environment_)
        has_cube_map = request_environment_light(*background.cube_map) && has_cube_map;
    const bool shows_texture = background.texture != scene::kNone && !background.shows_cube_map();
    return (!shows_texture || request_texture(background.texture)) && has_cube_map;
}

bool GpuScene::request_shown(const plan::View& view) {
    bool all = request_background(view);
    for (const plan::DrawItem& item : plan::visible_items(view)) all = request(item, view.levels) && all;
    return all;
}

// --- uploads

void GpuScene::create_geometry(Arrival& arrival) {
    const PreparedData& data = arrival.result.data;
    const scene::Geometry& read = read_geometry(arrival.result.key.indices[0]);
    const std::vector<glm::uvec3>& triangles = triangles_of(data.arrays, read);
    GpuGeometry& geometry = arrival.geometry;
    geometry = buffer_pool_.allocate({data.arrays.vertices.size(), triangles.size(), !data.texcoords.empty(),
                                      !data.colors.empty(), !data.low_positions.empty()});
    geometry.origin = read.bounds.center();
    geometry.clusters = std::move(arrival.result.data.clusters);
    const auto first_vertex = static_cast<std::size_t>(geometry.first_vertex);
    arrival.upload.add(geometry.buffers->vertices, data.arrays.vertices, first_vertex);
    arrival.upload.add(geometry.buffers->indices, triangles, geometry.first_index / 3);
    if (geometry.buffers->shared) {
        for (const glm::uvec3& corners : triangles)
            arrival.turned_triangles.emplace_back(corners.y, corners.x, corners.z);
        arrival.upload.add(geometry.buffers->indices, arrival.turned_triangles,
                           geometry.first_turned_index / 3);
    }
    if (!data.texcoords.empty())
        arrival.upload.add(geometry.buffers->texcoords, data.texcoords, first_vertex);
    if (!data.colors.empty()) arrival.upload.add(geometry.buffers->colors, data.colors);
    if (!data.low_positions.empty()) arrival.upload.add(geometry.buffers->low_positions, data.low_positions);
}

void GpuScene::create_edges(Arrival& arrival) {
    const std::vector<glm::uvec2>& edges = arrival.result.data.edges;
    if (edges.empty()) return;
    arrival.edges.indices = make_dynamic_buffer("edges", edges.size() * sizeof(glm::uvec2));
    arrival.upload.add(arrival.edges.indices, edges);
    arrival.edges.index_count = static_cast<GLsizei>(edges.size() * 2);
}

void GpuScene::create_storage(Arrival& arrival) {
    const ResourceKey& key = arrival.result.key;
    if (key.kind == ResourceKind::geometry || key.kind == ResourceKind::level) {
        create_geometry(arrival);
    } else if (key.kind == ResourceKind::edges) {
        create_edges(arrival);
    } else {
        const TextureData& data = arrival.result.data.texture;
        arrival.texture = make_texture_for(data);
        for (const TextureImage& image : data.images) arrival.upload.add(arrival.texture, image);
    }
    arrival.has_storage = true;
}

void GpuScene::finish(Arrival& arrival) {
    const ResourceKey& key = arrival.result.key;
    const scene::Index index = key.indices[0];
    const auto at = static_cast<std::size_t>(index);
    switch (key.kind) {
        case ResourceKind::geometry:
            geometries_[at] = std::move(arrival.geometry);
            break;
        case ResourceKind::level:
            levels_[{index, key.indices[1]}] = std::move(arrival.geometry);
            // The same triangles in another order: edges alone need the file's.
            if (key.indices[1] == 0 && !edges_[at] &&
                !requested_.contains(key_of(ResourceKind::edges, index)))
                geometries_[at] = {};
            break;
        case ResourceKind::edges:
            if (arrival.edges.indices)
                arrival.edges.vertex_array = vertex_array_of(geometry(index), arrival.edges.indices);
            edges_[at] = std::move(arrival.edges);
            break;
        case ResourceKind::texture:
            textures_[at] = std::move(arrival.texture);
            break;
        case ResourceKind::cube_map:
            cube_maps_[key.indices] = std::move(arrival.texture);
            break;
        case ResourceKind::environment_light:
            environment_lights_[key.indices] = {std::move(arrival.texture), arrival.result.data.harmonics};
            break;
    }
    ++uploads_;
}

/// True if it is resident.
bool GpuScene::proceed(Arrival& arrival, plan::DrawBudget& budget) {
    constexpr std::int64_t kObject = 400;  // for its storage, in units of DrawBudget
    if (arrival.result.error) std::rethrow_exception(arrival.result.error);
    if (is_resident(arrival.result.key)) return true;  // it was uploaded at once meanwhile
    if (!arrival.has_storage) {
        budget.spend(kObject);
        create_storage(arrival);
    }
    if (!arrival.upload.step(budget)) return false;
    finish(arrival);
    return true;
}

void GpuScene::upload(plan::DrawBudget& budget) {
    while (!budget.is_spent()) {
        if (!arrival_) {
            auto prepared = preparation_.take();
            if (!prepared) return;
            arrival_.emplace(Arrival{*std::move(prepared)});
        }
        const ResourceKey key = arrival_->result.key;
        try {
            if (!proceed(*arrival_, budget)) continue;
            arrival_.reset();
            requested_.erase(key);
        } catch (const std::exception&) {
            arrival_.reset();
            if (requested_.extract(key).mapped() == Need::now) throw;
            failed_.insert(key);
        }
    }
}

void GpuScene::upload_at_once(const ResourceKey& key, const std::function<PreparedData()>& make) {
    Arrival arrival{{key, make(), nullptr}};
    create_storage(arrival);
    for (plan::DrawBudget budget(true); !arrival.upload.step(budget);) budget = plan::DrawBudget(true);
    finish(arrival);
}

// --- lookups

const GpuGeometry& GpuScene::geometry(scene::Index index) {
    const ResourceKey key = key_of(ResourceKind::geometry, index);
    if (!is_resident(key))
        upload_at_once(
            key, [&] { return geometry_data(read_geometry(index), scene_->needs_double_single(index)); });
    return geometries_[static_cast<std::size_t>(index)];
}

const GpuGeometry& GpuScene::geometry(const plan::DrawItem& item) {
    if (item.cut) return cut(item).faces;
    const ResourceKey key = key_of(ResourceKind::level, item.geometry, item.level ? item.level->number : 0);
    if (item.level && !is_resident(key))
        upload_at_once(key, [&] {
            return level_data(read_geometry(item.geometry), *item.level,
                              scene_->needs_double_single(item.geometry));
        });
    const bool as_in_file = !item.level && (is_resident(key_of(ResourceKind::geometry, item.geometry)) ||
                                            item.order || !is_resident(key));
    return as_in_file ? geometry(item.geometry) : levels_.at({item.geometry, key.indices[1]});
}

const GpuEdges* GpuScene::edges(scene::Index index) const {
    const std::optional<GpuEdges>& edges = edges_[static_cast<std::size_t>(index)];
    return edges ? &*edges : nullptr;
}

const GlTexture& GpuScene::texture(scene::Index index) {
    const ResourceKey key = key_of(ResourceKind::texture, index);
    if (!is_resident(key)) upload_at_once(key, make_texture(index));
    return textures_[static_cast<std::size_t>(index)];
}

const GlTexture& GpuScene::cube_map(const std::array<scene::Index, 6>& textures) {
    const ResourceKey key{ResourceKind::cube_map, textures};
    if (!is_resident(key)) upload_at_once(key, make_cube_map(textures));
    return cube_maps_.at(textures);
}

const GpuEnvironmentLight& GpuScene::environment_light(const std::array<scene::Index, 6>& textures) {
    const ResourceKey key{ResourceKind::environment_light, textures};
    if (!is_resident(key)) upload_at_once(key, make_environment_light(textures));
    return environment_lights_.at(textures);
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
    result.vertex_array = vertex_array_of(uploaded, result.indices);
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
