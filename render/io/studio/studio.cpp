#include "io/studio/studio.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/srgb.hpp"
#include "io/placed_parts.hpp"
#include "io/studio/contact_shadow.hpp"
#include "io/studio/environment.hpp"
#include "scene/style.hpp"

namespace vrut::io {

namespace {

using scene::SceneParts;

bool is_see_through(const SceneParts& parts, scene::Index index) {
    if (index == scene::kNone) return false;
    const scene::Material& material = parts.materials[static_cast<std::size_t>(index)];
    return material.diffuse.a < 1 || (material.texture != scene::kNone &&
                                      parts.textures[static_cast<std::size_t>(material.texture)].transparent);
}

/// Glass casts no shadow, nor does a sheet with a shadow that the file has itself.
std::vector<PlacedGeometry> shown_geometries(const SceneParts& parts, const scene::PlacedScene& placed) {
    std::vector<PlacedGeometry> geometries;
    const std::vector<bool> shown = nodes_shown_near(placed);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto* data = std::get_if<scene::GeometryData>(&placed.scene->nodes()[i].data);
        if (!shown[i] || !data || data->geometry == scene::kNone ||
            placed.scene->is_presentation(static_cast<scene::Index>(i)))
            continue;
        const scene::Geometry& geometry = parts.geometries[static_cast<std::size_t>(data->geometry)];
        if (!geometry.triangles.empty())
            geometries.push_back({&geometry, placed.world[i], !is_see_through(parts, data->material)});
    }
    return geometries;
}

/// 1 above the highest.
template <class Items, class IdOf>
scene::Id first_free_id(const Items& items, const IdOf& id_of) {
    scene::Id highest = 0;
    for (const auto& item : items) highest = std::max(highest, id_of(item));
    return highest + 1;
}

struct FreeIds {
    scene::Id node = 0, material = 0, geometry = 0;  ///< and all above
};

FreeIds free_ids(const SceneParts& parts) {
    return {first_free_id(parts.nodes, [](const auto& part) { return part.node.id; }),
            first_free_id(parts.materials, [](const auto& material) { return material.id; }),
            first_free_id(parts.geometries, [](const auto& geometry) { return geometry.id; })};
}

SceneParts::PartNode studio_node(scene::Id id, const char* name, scene::NodeType type, scene::Id parent) {
    SceneParts::PartNode part;
    part.node.id = id;
    part.node.name = name;
    part.node.type = type;
    part.parent_id = parent;
    return part;
}

/// Its index.
template <class Item>
scene::Index add_to(std::vector<Item>& items, Item item) {
    items.push_back(std::move(item));
    return static_cast<scene::Index>(items.size() - 1);
}

void add_environment(SceneParts& parts, const FreeIds& ids) {
    constexpr std::array<const char*, 6> kNames{"studio-px.png", "studio-nx.png", "studio-py.png",
                                                "studio-ny.png", "studio-pz.png", "studio-nz.png"};
    scene::Material color;
    color.id = ids.material;
    color.name = "Studio";
    color.diffuse = {scene::kDefaultBackground, 1};
    scene::BackgroundData background;
    background.material = add_to(parts.materials, color);
    background.only_reflected = true;
    std::array<scene::Image, 6> images = studio_cube_map();
    background.cube_map.emplace();
    background.cube_textures.emplace();
    for (std::size_t i = 0; i < images.size(); ++i) {
        (*background.cube_map)[i] = kNames[i];
        (*background.cube_textures)[i] =
            add_to(parts.textures, scene::Texture{kNames[i], std::move(images[i]), false});
    }
    auto part = studio_node(ids.node + 1, "Studio", scene::NodeType::background, ids.node);
    part.node.data = std::move(background);
    parts.nodes.push_back(std::move(part));
}

/// The sheet that shows it, seen from above.
scene::Geometry sheet_of(const ContactShadow& shadow, scene::Id id) {
    const glm::dvec3 &low = shadow.low, &high = shadow.high;
    scene::Geometry sheet;
    sheet.id = id;
    sheet.positions = {low, {low.x, low.y, high.z}, high, {high.x, low.y, low.z}};
    sheet.normals.assign(4, {0, 1, 0});
    sheet.texcoords = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (const glm::dvec3& position : sheet.positions) sheet.bounds.add(position);
    return sheet;
}

void add_shadow(SceneParts& parts, ContactShadow shadow, const FreeIds& ids) {
    constexpr const char* kName = "contact-shadow.png";
    scene::Material black;
    black.id = ids.material + 1;
    black.name = "Contact shadow";
    black.diffuse = {0, 0, 0, 1};
    black.image = kName;
    scene::GeometryData data;
    data.geometry = add_to(parts.geometries, sheet_of(shadow, ids.geometry));
    black.texture = add_to(parts.textures, scene::Texture{kName, std::move(shadow.image), true});
    data.material = add_to(parts.materials, black);
    auto part = studio_node(ids.node + 2, "Contact shadow", scene::NodeType::geometry, ids.node);
    part.node.data = data;
    parts.nodes.push_back(std::move(part));
}

/// By what surrounds it: its colours as base colours, its highlight as roughness, its emission as light.
void light_by_environment(scene::Material& material) {
    const glm::dvec3 black(0);
    const bool shines = glm::dvec3(material.specular) != black;
    const bool is_matte = glm::dvec3(material.diffuse) != black || material.texture != scene::kNone;
    if (material.metallic_roughness || (!shines && !is_matte)) return;  // as unlit ones
    // The inverse of Phong's exponent by the glTF reader's rule.
    const double roughness = shines ? std::pow(2 * std::max(material.shininess, 0.0) + 1, -0.25) : 1;
    material.metallic_roughness = {0, roughness, 0};
    if (material.emissive_texture == scene::kNone)
        material.emissive += base::linear_from_srgb(glm::clamp(glm::dvec3(material.emission), 0.0, 1.0));
}

}  // namespace

void add_studio(SceneParts& parts) {
    const bool has_background = std::ranges::any_of(parts.nodes, [](const auto& part) {
        return std::holds_alternative<scene::BackgroundData>(part.node.data);
    });
    const FreeIds ids = free_ids(parts);
    constexpr scene::Id kLastFirst = scene::kMaxId - 2;  // of three ids
    if (has_background || std::max({ids.node, ids.material, ids.geometry}) > kLastFirst) return;
    const std::optional<scene::PlacedScene> placed = placed_nodes(parts);
    if (!placed) return;
    const std::vector<PlacedGeometry> shown = shown_geometries(parts, *placed);
    if (shown.empty()) return;
    std::optional<ContactShadow> shadow = contact_shadow(shown);
    auto studio = studio_node(ids.node, "Studio", scene::NodeType::assembly, 0);
    studio.node.presentation = true;
    parts.nodes.push_back(std::move(studio));
    for (scene::Material& material : parts.materials) light_by_environment(material);
    add_environment(parts, ids);
    if (shadow) add_shadow(parts, *std::move(shadow), ids);
}

}  // namespace vrut::io
