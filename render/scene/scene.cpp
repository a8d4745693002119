#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vrut {

std::string_view name_of(NodeType type) {
    switch (type) {
        case NodeType::assembly:
            return "assembly";
        case NodeType::root:
            return "root";
        case NodeType::camera:
            return "camera";
        case NodeType::geometry:
            return "geometry";
        case NodeType::light:
            return "light";
        case NodeType::lod:
            return "lod";
        case NodeType::switch_:
            return "switch";
        case NodeType::background:
            return "background";
        case NodeType::sound:
            return "sound";
    }
    return "";
}

Scene::Scene() { *this = *build({}); }

namespace {

Node make_root() {
    Node root;
    root.type = NodeType::root;
    return root;
}

/// Parents before children, children by id; fewer than all nodes come back where there is a cycle.
std::vector<Index> top_down_order(const std::vector<std::vector<Index>>& children, Index root) {
    std::vector<Index> order{root};
    order.reserve(children.size());
    for (std::size_t next = 0; next < order.size(); ++next)
        for (Index child : children[static_cast<std::size_t>(order[next])]) order.push_back(child);
    return order;
}

using Places = std::unordered_map<Id, Index>;
using PartNodes = std::vector<SceneParts::PartNode>;

tl::expected<Places, Scene::BuildError> places_by_id(const PartNodes& nodes) {
    Places places;
    places.reserve(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& node = nodes[i].node;
        if (!places.emplace(node.id, static_cast<Index>(i)).second)
            return tl::unexpected(
                Scene::BuildError{"expected each node once, found " + std::to_string(node.id) + " twice", i});
        if ((node.id == 0) != (node.type == NodeType::root))
            return tl::unexpected(Scene::BuildError{"expected id 0 for the root and no other node, found " +
                                                        std::string(name_of(node.type)) + " " +
                                                        std::to_string(node.id),
                                                    i});
    }
    return places;
}

/// For each node the places of its children, by rising id.
tl::expected<std::vector<std::vector<Index>>, Scene::BuildError> children_by_id(const PartNodes& nodes,
                                                                                const Places& places) {
    const auto at = [&](Index i) -> const SceneParts::PartNode& {
        return nodes[static_cast<std::size_t>(i)];
    };
    std::vector<Index> by_id(nodes.size());
    std::iota(by_id.begin(), by_id.end(), 0);
    std::sort(by_id.begin(), by_id.end(), [&](Index a, Index b) { return at(a).node.id < at(b).node.id; });
    std::vector<std::vector<Index>> children(nodes.size());
    for (Index i : by_id) {
        if (at(i).node.id == 0) continue;
        const auto parent = places.find(at(i).parent_id);
        if (parent == places.end())
            return tl::unexpected(Scene::BuildError{"expected parent " + std::to_string(at(i).parent_id) +
                                                        " of node " + std::to_string(at(i).node.id) +
                                                        " in the file, found none",
                                                    static_cast<std::size_t>(i)});
        children[static_cast<std::size_t>(parent->second)].push_back(i);
    }
    return children;
}

/// What the root does not reach hangs in a cycle, or below one.
Scene::BuildError find_cycle(const PartNodes& nodes, const Places& places,
                             const std::vector<Index>& reached) {
    std::vector<bool> seen(nodes.size());
    for (Index i : reached) seen[static_cast<std::size_t>(i)] = true;
    // Upwards from any of the rest: the first node met twice is in the cycle, and not just below it.
    auto culprit = static_cast<std::size_t>(std::find(seen.begin(), seen.end(), false) - seen.begin());
    while (!seen[culprit]) {
        seen[culprit] = true;
        culprit = static_cast<std::size_t>(places.at(nodes[culprit].parent_id));
    }
    return {"expected node " + std::to_string(nodes[culprit].node.id) +
                " below the root, found it among its own ancestors",
            culprit};
}

}  // namespace

tl::expected<Scene, Scene::BuildError> Scene::build(SceneParts parts) {
    auto& in = parts.nodes;
    const auto is_root = [](const SceneParts::PartNode& part) { return part.node.id == 0; };
    if (std::none_of(in.begin(), in.end(), is_root)) in.push_back({make_root(), 0});

    const auto place = places_by_id(in);
    if (!place) return tl::unexpected(place.error());
    auto linked = children_by_id(in, *place);
    if (!linked) return tl::unexpected(linked.error());
    auto& children = *linked;
    const std::vector<Index> order = top_down_order(children, place->at(0));
    if (order.size() != in.size()) return tl::unexpected(find_cycle(in, *place, order));

    // The same nodes, in that order.
    Scene scene(Unlinked{});
    scene.name_ = std::move(parts.name);
    scene.unit_ = parts.unit;
    scene.materials_ = std::move(parts.materials);
    scene.geometries_ = std::move(parts.geometries);
    scene.notices_ = std::move(parts.notices);
    std::vector<Index> new_place(in.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        new_place[static_cast<std::size_t>(order[i])] = static_cast<Index>(i);
    scene.nodes_.reserve(in.size());
    for (Index old : order) {
        Node& node = scene.nodes_.emplace_back(std::move(in[static_cast<std::size_t>(old)].node));
        node.children = std::move(children[static_cast<std::size_t>(old)]);
        for (Index& child : node.children) child = new_place[static_cast<std::size_t>(child)];
        scene.index_of_.emplace(node.id, static_cast<Index>(scene.nodes_.size() - 1));
    }
    for (std::size_t i = 0; i < scene.nodes_.size(); ++i)
        for (Index child : scene.nodes_[i].children)
            scene.nodes_[static_cast<std::size_t>(child)].parent = static_cast<Index>(i);
    return scene;
}

const Material& Scene::material(Index index) const {
    static const Material default_material;
    return index == kNone ? default_material : materials_[static_cast<std::size_t>(index)];
}

Index Scene::find_node(Id id) const {
    const auto found = index_of_.find(id);
    return found == index_of_.end() ? kNone : found->second;
}

std::uint64_t Scene::triangle_count() const {
    std::uint64_t count = 0;
    for (const Node& node : nodes_)
        if (const auto* data = std::get_if<GeometryData>(&node.data); data && data->geometry != kNone)
            count += geometries_[static_cast<std::size_t>(data->geometry)].triangles.size();
    return count;
}

std::vector<glm::dmat4> world_matrices(const Scene& scene) {
    std::vector<glm::dmat4> world(scene.nodes().size());
    for (std::size_t i = 0; i < world.size(); ++i) {
        const Node& node = scene.nodes()[i];
        world[i] =
            node.parent == kNone ? node.matrix : world[static_cast<std::size_t>(node.parent)] * node.matrix;
    }
    return world;
}

namespace {

/// Whether a LOD or switch at `index` lets its child number `place` show.
bool chooses(const Node& node, std::size_t place, const glm::dvec3& origin,
             const std::optional<glm::dvec3>& eye) {
    if (const auto* data = std::get_if<SwitchData>(&node.data))
        return data->active_child == SwitchData::kAllChildren ||
               data->active_child == static_cast<int>(place);
    if (const auto* data = std::get_if<LodData>(&node.data); data && eye) {
        const double distance = glm::distance(*eye, origin);
        std::size_t level = 0;
        while (level < data->ranges.size() && distance >= data->ranges[level]) ++level;
        return place == level;
    }
    return true;
}

}  // namespace

std::vector<bool> shown_nodes(const Scene& scene, const std::vector<glm::dmat4>& world,
                              const std::optional<glm::dvec3>& eye) {
    const auto& nodes = scene.nodes();
    std::vector<bool> shown(nodes.size());
    shown[0] = nodes[0].active;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!shown[i]) continue;
        for (std::size_t place = 0; place < nodes[i].children.size(); ++place) {
            const auto child = static_cast<std::size_t>(nodes[i].children[place]);
            shown[child] = nodes[child].active && chooses(nodes[i], place, glm::dvec3(world[i][3]), eye);
        }
    }
    return shown;
}

namespace {

Bounds bounds_below(const Scene& scene, const std::vector<glm::dmat4>& world, std::size_t top) {
    // Squares and sums of what is used below stay finite.
    constexpr double kFarthest = 1e150;
    Bounds bounds;
    const std::vector<bool> shown = shown_nodes(scene, world, std::nullopt);
    std::vector<bool> below(shown.size());
    for (std::size_t i = top; i < shown.size(); ++i) {
        const Index parent = scene.nodes()[i].parent;
        below[i] = i == top || (parent != kNone && below[static_cast<std::size_t>(parent)]);
        const auto* data = std::get_if<GeometryData>(&scene.nodes()[i].data);
        if (!below[i] || !shown[i] || !data || data->geometry == kNone || !is_finite(world[i])) continue;
        const Bounds box =
            transformed(world[i], scene.geometries()[static_cast<std::size_t>(data->geometry)].bounds);
        if (!box.empty() && glm::length(box.min) < kFarthest && glm::length(box.max) < kFarthest)
            bounds.add(box);
    }
    return bounds;
}

}  // namespace

Bounds scene_bounds(const Scene& scene, const std::vector<glm::dmat4>& world) {
    return bounds_below(scene, world, 0);
}

Bounds subtree_bounds(const PlacedScene& placed, Index node) {
    return bounds_below(placed.scene, placed.world, static_cast<std::size_t>(node));
}

PlacedScene place(Scene scene) {
    PlacedScene placed{std::move(scene), {}, {}};
    placed.world = world_matrices(placed.scene);
    placed.bounds = scene_bounds(placed.scene, placed.world);
    return placed;
}

/// Volume of the matrix's axes over that of a box with the same edges: 0 for a flattened part, ±1 for a rigid
/// one.
double relative_determinant(const glm::dmat3& m) {
    const double edges = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
    return edges > 0 ? glm::determinant(m) / edges : 0;
}

bool is_finite(const glm::dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    return true;
}

}  // namespace vrut
