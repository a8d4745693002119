#include "room/named_part.hpp"

#include <algorithm>
#include <vector>

#include "mesh/support_function.hpp"

namespace vrut::server::room {

namespace {

/// From below the root to the hit.
std::vector<scene::Index> parts_above(const scene::Scene& scene, scene::Index hit) {
    const auto& nodes = scene.nodes();
    const auto at = [&](scene::Index i) -> const scene::Node& { return nodes[static_cast<std::size_t>(i)]; };
    std::vector<scene::Index> parts;
    for (scene::Index node = hit; at(node).parent != scene::kNone; node = at(node).parent) {
        const scene::NodeType above = at(at(node).parent).type;
        if (above != scene::NodeType::switch_ && above != scene::NodeType::lod) parts.push_back(node);
    }
    std::reverse(parts.begin(), parts.end());
    return parts;
}

}  // namespace

scene::Index named_part(const scene::PlacedScene& placed, scene::Index hit, scene::Index selected) {
    constexpr double kLargest = 0.5;  // of the scene's diagonal
    if (hit == scene::kNone) return scene::kNone;
    const std::vector<scene::Index> parts = parts_above(*placed.scene, hit);
    if (parts.empty()) return hit;
    const auto present = std::find(parts.begin(), parts.end(), selected);
    if (present != parts.end()) return std::next(present) != parts.end() ? *std::next(present) : *present;

    const auto hinged = std::find_if(parts.begin(), parts.end(), [&](scene::Index node) {
        return placed.scene->nodes()[static_cast<std::size_t>(node)].hinge.has_value();
    });
    if (hinged != parts.end()) return *hinged;
    const auto radius = [&](scene::Index node) {
        return mesh::SupportFunction(placed, node, nullptr).bounds().radius();
    };
    const double largest = kLargest * radius(0);
    const auto small =
        std::find_if(parts.begin(), parts.end(), [&](scene::Index node) { return radius(node) <= largest; });
    return small != parts.end() ? *small : parts.back();
}

}  // namespace vrut::server::room
