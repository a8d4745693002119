#include "io/visible_shapes.hpp"

#include <algorithm>

namespace vrut::io {

namespace {

bool shows_child(const scene::Node& parent, scene::Index child) {
    const auto place =
        std::find(parent.children.begin(), parent.children.end(), child) - parent.children.begin();
    if (const auto* data = std::get_if<scene::SwitchData>(&parent.data))
        return data->active_child == scene::SwitchData::kAllChildren || data->active_child == place;
    return !std::holds_alternative<scene::LodData>(parent.data) || place == 0;
}

}  // namespace

std::vector<ShownShape> shown_shapes(const scene::Scene& scene, ConversionWarnings& warnings) {
    const auto world = scene::world_matrices(scene, scene::file_states(scene));
    std::vector<bool> shown(scene.nodes().size());
    std::vector<ShownShape> shapes;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const scene::Node& node = scene.nodes()[i];
        const auto parent = static_cast<std::size_t>(node.parent);
        shown[i] = node.active &&
                   (node.parent == scene::kNone ||
                    (shown[parent] && shows_child(scene.nodes()[parent], static_cast<scene::Index>(i))));
        const auto* const data = std::get_if<scene::GeometryData>(&node.data);
        if (data == nullptr || data->geometry == scene::kNone) continue;
        const scene::Geometry& geometry = scene.geometries()[static_cast<std::size_t>(data->geometry)];
        if (geometry.triangles.empty()) continue;
        if (!shown[i])
            warnings.add("an initially hidden geometry is omitted");
        else if (!scene::is_finite(world[i]))
            warnings.add("a geometry whose world matrix is not finite is omitted");
        else
            shapes.push_back({static_cast<scene::Index>(i), &geometry, data->material, world[i]});
    }
    return shapes;
}

void report_lost_nodes(const scene::Scene& scene, ConversionWarnings& warnings) {
    for (const scene::Node& node : scene.nodes()) {
        if (node.hinge) warnings.add("a hinge is lost");
        if (node.presentation) warnings.add("a mark of presentation is lost");
        if (node.type == scene::NodeType::background) warnings.add("a background is lost");
        if (node.type == scene::NodeType::switch_) warnings.add("a switch is replaced by its active child");
        if (node.type == scene::NodeType::lod) warnings.add("a LOD node is replaced by its first child");
        if (node.type == scene::NodeType::sound) warnings.add("a sound is lost");
    }
    if (scene.unit().value_or(1) != 1) warnings.add("the scene's unit is lost");
}

void report_lost_tree(const scene::Scene& scene, ConversionWarnings& warnings) {
    for (const scene::Node& node : scene.nodes()) {
        if (node.type == scene::NodeType::camera) warnings.add("a camera is lost");
        if (node.type == scene::NodeType::light) warnings.add("a light is lost");
        if (node.type == scene::NodeType::assembly)
            warnings.add("an assembly is lost: its matrix is applied to the vertices");
    }
}

}  // namespace vrut::io
