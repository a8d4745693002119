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
            warnings.add("a geometry that is hidden at the start is left out");
        else if (!scene::is_finite(world[i]))
            warnings.add("a geometry beyond the range of numbers is left out");
        else
            shapes.push_back({static_cast<scene::Index>(i), &geometry, data->material, world[i]});
    }
    return shapes;
}

void report_lost_nodes(const scene::Scene& scene, ConversionWarnings& warnings) {
    for (const scene::Node& node : scene.nodes()) {
        if (node.hinge) warnings.add("how a part turns about its hinge is not kept");
        if (node.type == scene::NodeType::background) warnings.add("a background is not kept");
        if (node.type == scene::NodeType::switch_)
            warnings.add("a switch is kept as the child that it chooses");
        if (node.type == scene::NodeType::lod) warnings.add("a level of detail is kept as its first child");
        if (node.type == scene::NodeType::sound) warnings.add("a sound is not kept");
    }
    if (scene.unit() != 1) warnings.add("how many metres a unit has is not kept");
}

void report_lost_tree(const scene::Scene& scene, ConversionWarnings& warnings) {
    for (const scene::Node& node : scene.nodes()) {
        if (node.type == scene::NodeType::camera) warnings.add("a camera is not kept");
        if (node.type == scene::NodeType::light) warnings.add("a light is not kept");
        if (node.type == scene::NodeType::assembly)
            warnings.add("an assembly is not kept: its matrix goes into the vertices");
    }
}

}  // namespace vrut::io
