#include "io/placed_parts.hpp"

#include <utility>

namespace vrut::io {

std::optional<scene::PlacedScene> placed_nodes(const scene::SceneParts& parts) {
    scene::SceneParts nodes;
    nodes.nodes = parts.nodes;
    nodes.geometries.resize(parts.geometries.size());
    nodes.materials.resize(parts.materials.size());
    auto built = scene::Scene::build(std::move(nodes));
    if (!built) return std::nullopt;
    return scene::place(*std::move(built));
}

std::vector<bool> nodes_shown_near(const scene::PlacedScene& placed) {
    std::vector<bool> shown = scene::shown_nodes(placed, std::nullopt);
    const auto& nodes = placed.scene->nodes();
    for (std::size_t i = 1; i < nodes.size(); ++i) {
        const scene::Node& parent = nodes[static_cast<std::size_t>(nodes[i].parent)];
        const bool chosen = !std::holds_alternative<scene::LodData>(parent.data) ||
                            static_cast<std::size_t>(parent.children.front()) == i;
        shown[i] = shown[i] && shown[static_cast<std::size_t>(nodes[i].parent)] && chosen;
    }
    return shown;
}

}  // namespace vrut::io
