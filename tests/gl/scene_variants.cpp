#include "scene_variants.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include "shapes.hpp"

namespace vrut {

namespace {

scene::SceneParts parts_of(const scene::Scene& scene) {
    scene::SceneParts parts{
        scene.name(), scene.unit(), scene.textures(), scene.materials(), scene.geometries(), {}, {}};
    for (const scene::Node& node : scene.nodes()) {
        const scene::Index parent = node.parent;
        parts.nodes.push_back(
            {node, parent == scene::kNone ? 0 : scene.nodes()[static_cast<std::size_t>(parent)].id});
        parts.nodes.back().node.parent = scene::kNone;
        parts.nodes.back().node.children.clear();
    }
    return parts;
}

plan::View showing(plan::View view, scene::SceneParts parts) {
    for (scene::Geometry& geometry : parts.geometries) {
        geometry.bounds = {};
        for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
    }
    view.scene =
        std::make_shared<const scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
    return view;
}

/// Node by node; the root is one of them.
template <typename Change>
plan::View with_nodes(const plan::View& view, const Change& change) {
    scene::SceneParts parts = parts_of(*view.scene->scene);
    for (auto& part : parts.nodes) change(part.node);
    return showing(view, std::move(parts));
}

bool is_root(const scene::Node& node) { return node.id == 0; }

bool has_geometry(const scene::Node& node) { return std::holds_alternative<scene::GeometryData>(node.data); }

/// Positions and everything that is a length, in the file itself.
plan::View scaled(plan::View view, double factor) {
    for (glm::dvec3* point :
         {&view.camera.eye, &view.camera.focus, &view.camera.center, &view.light.position})
        *point *= factor;
    for (scene::ClipPlane& plane : view.clip_planes) plane.distance *= factor;
    view.light.attenuation /= glm::dvec3(1, factor, factor * factor);
    scene::SceneParts parts = parts_of(*view.scene->scene);
    for (scene::Geometry& geometry : parts.geometries)
        for (glm::dvec3& position : geometry.positions) position *= factor;
    for (auto& part : parts.nodes) {
        part.node.matrix[3] = glm::dvec4(glm::dvec3(part.node.matrix[3]) * factor, 1);
        if (auto* lod = std::get_if<scene::LodData>(&part.node.data))
            for (double& range : lod->ranges) range *= factor;
    }
    return showing(view, std::move(parts));
}

/// The root, and within it the positions of each geometry, whose nodes bring it back.
plan::View moved(plan::View view, const glm::dvec3& offset) {
    for (glm::dvec3* point :
         {&view.camera.eye, &view.camera.focus, &view.camera.center, &view.light.position})
        *point += offset;
    for (scene::ClipPlane& plane : view.clip_planes) plane.distance += glm::dot(plane.normal, offset);
    scene::SceneParts parts = parts_of(*view.scene->scene);
    for (scene::Geometry& geometry : parts.geometries)
        for (glm::dvec3& position : geometry.positions) position += offset;
    for (auto& part : parts.nodes) {
        if (is_root(part.node)) part.node.matrix = moved_by(offset) * part.node.matrix;
        if (has_geometry(part.node)) part.node.matrix = part.node.matrix * moved_by(-offset);
    }
    return showing(view, std::move(parts));
}

/// Once in the geometry, whose front stays in front, and once in the nodes.
plan::View mirrored_twice(const plan::View& view) {
    scene::SceneParts parts = parts_of(*view.scene->scene);
    for (scene::Geometry& geometry : parts.geometries) {
        for (glm::dvec3& position : geometry.positions) position.x = -position.x;
        for (glm::vec3& normal : geometry.normals) normal.x = -normal.x;
        for (glm::uvec3& triangle : geometry.triangles) std::swap(triangle.y, triangle.z);
    }
    for (auto& part : parts.nodes)
        if (has_geometry(part.node)) part.node.matrix = part.node.matrix * scaled_by({-1, 1, 1});
    return showing(view, std::move(parts));
}

plan::View turned_around(const plan::View& view) {
    glm::dmat4 turn(1);
    for (int i = 0; i < 36; ++i) turn = turned_by(10, glm::normalize(glm::dvec3(1, 2, 3))) * turn;
    return with_nodes(view, [&](scene::Node& node) {
        if (is_root(node)) node.matrix = turn * node.matrix;
    });
}

/// Of nodes, materials and geometries.
plan::View shuffled(const plan::View& view) {
    std::mt19937 random(7);
    scene::SceneParts parts = parts_of(*view.scene->scene);
    std::shuffle(parts.nodes.begin(), parts.nodes.end(), random);
    const auto shuffle = [&](auto& items) {
        std::vector<scene::Index> places(items.size());  // where each goes to
        std::iota(places.begin(), places.end(), 0);
        std::shuffle(places.begin(), places.end(), random);
        auto old = items;
        for (std::size_t i = 0; i < old.size(); ++i) items[static_cast<std::size_t>(places[i])] = old[i];
        return places;
    };
    const auto geometry_places = shuffle(parts.geometries), material_places = shuffle(parts.materials);
    const auto rename = [](scene::Index& index, const std::vector<scene::Index>& places) {
        if (index != scene::kNone) index = places[static_cast<std::size_t>(index)];
    };
    for (auto& part : parts.nodes) {
        if (auto* data = std::get_if<scene::GeometryData>(&part.node.data)) {
            rename(data->geometry, geometry_places);
            rename(data->material, material_places);
        }
        if (auto* data = std::get_if<scene::BackgroundData>(&part.node.data))
            rename(data->material, material_places);
    }
    return showing(view, std::move(parts));
}

/// Every second triangle of each node moves to a node below it.
plan::View split(const plan::View& view) {
    scene::SceneParts parts = parts_of(*view.scene->scene);
    std::vector<scene::Geometry> halves = parts.geometries;
    for (std::size_t g = 0; g < halves.size(); ++g) {
        const std::vector<glm::uvec3> all = halves[g].triangles;
        halves[g].triangles.clear();
        parts.geometries[g].triangles.clear();
        for (std::size_t i = 0; i < all.size(); ++i)
            (i % 2 == 0 ? parts.geometries : halves)[g].triangles.push_back(all[i]);
    }
    const auto first_half = static_cast<scene::Index>(parts.geometries.size());
    parts.geometries.insert(parts.geometries.end(), halves.begin(), halves.end());
    const auto nodes = parts.nodes;
    for (auto& part : parts.nodes) {
        part.node.id *= 2;
        part.parent_id *= 2;
    }
    for (const auto& whole : nodes) {
        const auto* data = std::get_if<scene::GeometryData>(&whole.node.data);
        if (!data || data->geometry == scene::kNone) continue;
        scene::Node half;
        half.id = 2 * whole.node.id + 1;
        half.type = scene::NodeType::geometry;
        half.data = scene::GeometryData{first_half + data->geometry, data->material};
        parts.nodes.push_back({half, 2 * whole.node.id});
    }
    return showing(view, std::move(parts));
}

}  // namespace

std::vector<SceneVariant> variants_of(const plan::View& view) {
    return {{"a millionth of its size", scaled(view, 1e-6)},
            {"a million times its size", scaled(view, 1e6)},
            {"ten million away", moved(view, {1e7, -1e7, 1e7})},
            {"mirrored twice", mirrored_twice(view)},
            {"turned once around", turned_around(view)},
            {"shuffled", shuffled(view)},
            {"split", split(view), 2}};
}

}  // namespace vrut
