#include "scene/scene.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "scene/fitted_plane.hpp"
#include "scene/texture_coordinates.hpp"

namespace vrut::scene {

std::string_view name_of(Wrap wrap) {
    return wrap == Wrap::repeat ? "repeat" : wrap == Wrap::mirror ? "mirror" : "clamp";
}

std::string_view name_of(Magnification magnification) {
    return magnification == Magnification::linear ? "linear" : "nearest";
}

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

glm::dvec3 unit_axis(const Hinge& hinge) {
    const glm::dvec3 sizes = glm::abs(hinge.axis);
    return glm::normalize(hinge.axis / std::max({sizes.x, sizes.y, sizes.z}));  // whose squares are in range
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

using IdToIndex = Scene::IdToIndex;
using PartNodes = std::vector<SceneParts::PartNode>;

Index index_of(const IdToIndex& index_by_id, Id id) {
    const auto found = std::lower_bound(index_by_id.begin(), index_by_id.end(), std::pair(id, Index{0}));
    return found == index_by_id.end() || found->first != id ? kNone : found->second;
}

Scene::BuildError fault_at(const PartNodes& nodes, std::size_t i, bool twice) {
    const Node& node = nodes[i].node;
    if (twice) return {"expected each node once, found " + std::to_string(node.id) + " twice", i};
    return {"expected id 0 for the root and no other node, found " + std::string(name_of(node.type)) + " " +
                std::to_string(node.id),
            i};
}

tl::expected<IdToIndex, Scene::BuildError> make_index_by_id(const PartNodes& nodes) {
    IdToIndex index_by_id;
    index_by_id.reserve(nodes.size());
    std::size_t twice = nodes.size(), root = nodes.size();  // the first at fault
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& node = nodes[i].node;
        index_by_id.emplace_back(node.id, static_cast<Index>(i));
        if ((node.id == 0) != (node.type == NodeType::root)) root = std::min(root, i);
    }
    std::sort(index_by_id.begin(), index_by_id.end());
    for (std::size_t i = 1; i < index_by_id.size(); ++i)
        if (index_by_id[i].first == index_by_id[i - 1].first)
            twice = std::min(twice, static_cast<std::size_t>(index_by_id[i].second));
    if (const std::size_t first = std::min(twice, root); first < nodes.size())
        return tl::unexpected(fault_at(nodes, first, twice == first));
    return index_by_id;
}

/// For each node the places of its children, by rising id.
tl::expected<std::vector<std::vector<Index>>, Scene::BuildError> children_by_id(
    const PartNodes& nodes, const IdToIndex& index_by_id) {
    const auto at = [&](Index i) -> const SceneParts::PartNode& {
        return nodes[static_cast<std::size_t>(i)];
    };
    std::vector<std::vector<Index>> children(nodes.size());
    for (const auto& [id, i] : index_by_id) {
        if (id == 0) continue;
        const Index parent = index_of(index_by_id, at(i).parent_id);
        if (parent == kNone)
            return tl::unexpected(Scene::BuildError{"expected parent " + std::to_string(at(i).parent_id) +
                                                        " of node " + std::to_string(at(i).node.id) +
                                                        " in the file, found none",
                                                    static_cast<std::size_t>(i)});
        children[static_cast<std::size_t>(parent)].push_back(i);
    }
    return children;
}

/// What the root does not reach hangs in a cycle, or below one.
Scene::BuildError find_cycle(const PartNodes& nodes, const IdToIndex& index_by_id,
                             const std::vector<Index>& reached) {
    std::vector<bool> seen(nodes.size());
    for (Index i : reached) seen[static_cast<std::size_t>(i)] = true;
    // Upwards from any of the rest: the first node met twice is in the cycle, and not just below it.
    auto culprit = static_cast<std::size_t>(std::find(seen.begin(), seen.end(), false) - seen.begin());
    while (!seen[culprit]) {
        seen[culprit] = true;
        culprit = static_cast<std::size_t>(index_of(index_by_id, nodes[culprit].parent_id));
    }
    return {"expected node " + std::to_string(nodes[culprit].node.id) +
                " below the root, found it among its own ancestors",
            culprit};
}

std::vector<std::optional<math::Plane>> fitted_planes(const std::vector<Geometry>& geometries) {
    std::vector<std::optional<math::Plane>> planes;
    planes.reserve(geometries.size());
    for (const Geometry& geometry : geometries) planes.push_back(fitted_plane(geometry));
    return planes;
}

/// Of the nodes' children.
void link_parents(std::vector<Node>& nodes) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (const Index child : nodes[i].children)
            nodes[static_cast<std::size_t>(child)].parent = static_cast<Index>(i);
}

/// Where whole numbers make no difference: where textures repeat.
void move_texcoords_near_zero(std::vector<Geometry>& geometries, const std::vector<Material>& materials,
                              const std::vector<SceneParts::PartNode>& nodes) {
    std::vector<bool> repeats(geometries.size(), true);
    for (const SceneParts::PartNode& part : nodes) {
        const auto* data = std::get_if<GeometryData>(&part.node.data);
        if (data && data->geometry != kNone && data->material != kNone &&
            !materials[static_cast<std::size_t>(data->material)].sampler.repeats())
            repeats[static_cast<std::size_t>(data->geometry)] = false;
    }
    for (std::size_t i = 0; i < geometries.size(); ++i)
        if (repeats[i]) move_near_zero(geometries[i].texcoords);
}

std::vector<Index> looking_cameras_of(const std::vector<Node>& nodes) {
    std::vector<Index> looking;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto* camera = std::get_if<CameraData>(&nodes[i].data);
        if (camera && camera->look_radius > 0) looking.push_back(static_cast<Index>(i));
    }
    return looking;
}

std::vector<Index> reflected_backgrounds_of(const Scene& scene) {
    std::vector<Index> reflected;
    for (const auto& [id, index] : scene.index_by_id()) {
        const auto* data = std::get_if<BackgroundData>(&scene.nodes()[static_cast<std::size_t>(index)].data);
        if (data && data->only_reflected && data->cube_textures) reflected.push_back(index);
    }
    return reflected;
}

/// For each node whether it or one above it is marked; parents come before their children.
std::vector<bool> presentation_of(const std::vector<Node>& nodes) {
    std::vector<bool> marked;
    marked.reserve(nodes.size());
    for (const Node& node : nodes)
        marked.push_back(node.presentation ||
                         (node.parent != kNone && marked[static_cast<std::size_t>(node.parent)]));
    return marked;
}

/// Of each geometry the longest side of the world-space boxes around its instances, in metres.
std::vector<double> extents_of(const Scene& scene) {
    std::vector<double> extents(scene.geometries().size());
    const std::vector<glm::dmat4> world = world_matrices(scene, file_states(scene));
    for (std::size_t i = 0; i < world.size(); ++i) {
        const auto* data = std::get_if<GeometryData>(&scene.nodes()[i].data);
        if (!data || data->geometry == kNone) continue;
        const auto geometry = static_cast<std::size_t>(data->geometry);
        const math::Bounds& bounds = scene.geometries()[geometry].bounds;
        if (bounds.empty()) continue;
        const glm::dvec3 half = math::transformed(world[i], bounds).half_extent();
        extents[geometry] =
            std::max(extents[geometry], 2 * scene.unit().value_or(1) * std::max({half.x, half.y, half.z}));
    }
    return extents;
}

}  // namespace

tl::expected<Scene, Scene::BuildError> Scene::build(SceneParts parts) {
    auto& in = parts.nodes;
    const auto is_root = [](const SceneParts::PartNode& part) { return part.node.id == 0; };
    if (std::none_of(in.begin(), in.end(), is_root)) in.push_back({make_root(), 0});

    const auto place = make_index_by_id(in);
    if (!place) return tl::unexpected(place.error());
    auto linked = children_by_id(in, *place);
    if (!linked) return tl::unexpected(linked.error());
    auto& children = *linked;
    const std::vector<Index> order = top_down_order(children, index_of(*place, 0));
    if (order.size() != in.size()) return tl::unexpected(find_cycle(in, *place, order));

    // The same nodes, in that order.
    Scene scene(Unlinked{});
    scene.name_ = std::move(parts.name);
    scene.unit_ = parts.unit;
    scene.textures_ = std::move(parts.textures);
    scene.materials_ = std::move(parts.materials);
    scene.geometries_ = std::move(parts.geometries);
    scene.notices_ = std::move(parts.notices);
    move_texcoords_near_zero(scene.geometries_, scene.materials_, in);
    scene.planes_ = fitted_planes(scene.geometries_);
    std::vector<Index> new_index(in.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        new_index[static_cast<std::size_t>(order[i])] = static_cast<Index>(i);
    scene.nodes_.reserve(in.size());
    for (Index old : order) {
        Node& node = scene.nodes_.emplace_back(std::move(in[static_cast<std::size_t>(old)].node));
        node.children = std::move(children[static_cast<std::size_t>(old)]);
        for (Index& child : node.children) child = new_index[static_cast<std::size_t>(child)];
        scene.index_by_id_.emplace_back(node.id, static_cast<Index>(scene.nodes_.size() - 1));
    }
    std::sort(scene.index_by_id_.begin(), scene.index_by_id_.end());
    link_parents(scene.nodes_);
    scene.is_presentation_ = presentation_of(scene.nodes_);
    scene.looking_cameras_ = looking_cameras_of(scene.nodes_);
    scene.reflected_backgrounds_ = reflected_backgrounds_of(scene);
    scene.has_lods_ = std::ranges::any_of(
        scene.nodes_, [](const Node& node) { return std::holds_alternative<LodData>(node.data); });
    scene.extents_ = extents_of(scene);
    return scene;
}

const Material& Scene::material(Index index) const {
    static const Material default_material;
    return index == kNone ? default_material : materials_[static_cast<std::size_t>(index)];
}

bool Scene::is_transparent(const Material& material) const {
    return material.diffuse.a < 1 ||
           (material.texture != kNone && textures_[static_cast<std::size_t>(material.texture)].transparent);
}

bool Scene::is_transparent(const Material& material, Index geometry) const {
    const bool textured =
        geometry != kNone && !geometries_[static_cast<std::size_t>(geometry)].texcoords.empty();
    return textured ? is_transparent(material) : material.diffuse.a < 1;
}

bool Scene::is_mirror(const Material& material, Index geometry) const {
    return material.reflectivity > 0 && !is_transparent(material, geometry) && plane(geometry);
}

Index Scene::find_node(Id id) const { return index_of(index_by_id_, id); }

std::uint64_t Scene::triangle_count() const {
    std::uint64_t count = 0;
    for (const Node& node : nodes_)
        if (const auto* data = std::get_if<GeometryData>(&node.data); data && data->geometry != kNone)
            count += geometries_[static_cast<std::size_t>(data->geometry)].triangles.size();
    return count;
}

NodeState file_state(const Node& node) {
    NodeState state;
    state.active = node.active;
    state.matrix = node.matrix;
    if (const auto* data = std::get_if<SwitchData>(&node.data)) state.active_child = data->active_child;
    if (const auto* data = std::get_if<GeometryData>(&node.data)) state.material = data->material;
    return state;
}

std::vector<NodeState> file_states(const Scene& scene) {
    std::vector<NodeState> states;
    states.reserve(scene.nodes().size());
    for (const Node& node : scene.nodes()) states.push_back(file_state(node));
    return states;
}

namespace {

std::vector<Index> drawable_nodes(const PlacedScene& placed) {
    const std::vector<bool> shown = shown_nodes(placed, std::nullopt);
    std::vector<Index> drawable;
    for (const auto& [id, index] : placed.scene->index_by_id()) {
        const auto at = static_cast<std::size_t>(index);
        const auto* data = std::get_if<GeometryData>(&placed.scene->nodes()[at].data);
        if (!shown[at] || !data || data->geometry == kNone) continue;
        const Geometry& geometry = placed.scene->geometries()[static_cast<std::size_t>(data->geometry)];
        if (!geometry.triangles.empty()) drawable.push_back(index);
    }
    return drawable;
}

}  // namespace

PlacedScene place(Scene scene) {
    std::vector<NodeState> states = file_states(scene);
    return place(std::make_shared<const Scene>(std::move(scene)), std::move(states));
}

PlacedScene place(std::shared_ptr<const Scene> scene, std::vector<NodeState> nodes) {
    assert(nodes.size() == scene->nodes().size());
    PlacedScene placed{std::move(scene), std::move(nodes), {}, {}, {}};
    placed.world = world_matrices(*placed.scene, placed.nodes);
    placed.bounds = subtree_bounds(placed, 0);
    placed.drawable = drawable_nodes(placed);
    return placed;
}

std::vector<glm::dmat4> world_matrices(const Scene& scene, const std::vector<NodeState>& states) {
    std::vector<glm::dmat4> world(states.size());
    for (std::size_t i = 0; i < world.size(); ++i) {
        const Index parent = scene.nodes()[i].parent;
        const glm::dmat4& matrix = states[i].matrix;
        world[i] = parent == kNone ? matrix : world[static_cast<std::size_t>(parent)] * matrix;
    }
    return world;
}

namespace {

/// Returns the place of the only child that a LOD or switch at `index` lets show, which may be past the last
/// one; none if it lets all show.
std::optional<std::size_t> chosen_child(const PlacedScene& placed, std::size_t index,
                                        const std::optional<glm::dvec3>& eye) {
    const Node& node = placed.scene->nodes()[index];
    if (std::holds_alternative<SwitchData>(node.data)) {
        const int active_child = placed.nodes[index].active_child;
        if (active_child == SwitchData::kAllChildren) return {};
        return active_child < 0 ? node.children.size() : static_cast<std::size_t>(active_child);
    }
    if (const auto* data = std::get_if<LodData>(&node.data); data && eye) {
        const double distance = glm::distance(*eye, glm::dvec3(placed.world[index][3]));
        std::size_t level = 0;
        while (level < data->ranges.size() && distance >= data->ranges[level]) ++level;
        return level;
    }
    return {};
}

}  // namespace

std::vector<bool> shown_nodes(const PlacedScene& placed, const std::optional<glm::dvec3>& eye) {
    const auto& nodes = placed.scene->nodes();
    std::vector<bool> shown(nodes.size());
    shown[0] = placed.nodes[0].active;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::vector<Index>& children = nodes[i].children;
        if (!shown[i] || children.empty()) continue;
        const std::optional<std::size_t> chosen = chosen_child(placed, i, eye);
        const std::size_t first = std::min(chosen.value_or(0), children.size());
        const std::size_t end = chosen ? std::min(first + 1, children.size()) : children.size();
        for (std::size_t place = first; place < end; ++place) {
            const auto child = static_cast<std::size_t>(children[place]);
            shown[child] = placed.nodes[child].active;
        }
    }
    return shown;
}

bool is_shown(const PlacedScene& placed, Index node, const std::optional<glm::dvec3>& eye) {
    const auto& nodes = placed.scene->nodes();
    if (node == kNone) return false;
    for (Index parent; placed.nodes[static_cast<std::size_t>(node)].active; node = parent) {
        parent = nodes[static_cast<std::size_t>(node)].parent;
        if (parent == kNone) return true;
        const auto& children = nodes[static_cast<std::size_t>(parent)].children;
        const auto place =
            static_cast<std::size_t>(std::find(children.begin(), children.end(), node) - children.begin());
        if (chosen_child(placed, static_cast<std::size_t>(parent), eye).value_or(place) != place)
            return false;
    }
    return false;
}

std::vector<bool> subtree(const Scene& scene, Index top) {
    std::vector<bool> below(scene.nodes().size());
    below[static_cast<std::size_t>(top)] = true;
    for (auto i = static_cast<std::size_t>(top) + 1; i < below.size(); ++i)
        below[i] = below[static_cast<std::size_t>(scene.nodes()[i].parent)];
    return below;
}

math::Bounds subtree_bounds(const PlacedScene& placed, Index node) {
    // Squares and sums of what is used below stay finite.
    constexpr double kFarthest = 1e150;
    math::Bounds bounds;
    const std::vector<bool> shown = shown_nodes(placed, std::nullopt);
    const std::vector<bool> below = subtree(*placed.scene, node);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const glm::dmat4& world = placed.world[i];
        const auto* data = std::get_if<GeometryData>(&placed.scene->nodes()[i].data);
        if (!below[i] || !shown[i] || !data || data->geometry == kNone || !is_finite(world)) continue;
        const math::Bounds box = math::transformed(
            world, placed.scene->geometries()[static_cast<std::size_t>(data->geometry)].bounds);
        if (!box.empty() && glm::length(box.min) < kFarthest && glm::length(box.max) < kFarthest)
            bounds.add(box);
    }
    return bounds;
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

}  // namespace vrut::scene
