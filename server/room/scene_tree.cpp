#include "room/scene_tree.hpp"

#include <algorithm>
#include <limits>

namespace vrut::server::room {

namespace {

constexpr std::size_t kMostNodes = 500, kMostBytes = std::size_t{64} * 1024;  // of a page
constexpr int kMostVisited = 5'000;
constexpr std::size_t kMostChoiceBytes = std::size_t{16} * 1024;  // of one switch

const scene::Node& at(const scene::Scene& scene, scene::Index index) {
    return scene.nodes()[static_cast<std::size_t>(index)];
}

/// A place in the walk below `top`, depth first, children by rising id.
struct Walk {
    const scene::Scene& scene;
    scene::Index top = scene::kNone;
    int max_depth = 0;
    scene::Index node = scene::kNone;  // kNone: at the end
    int depth = 0;

    void next() {
        const scene::Node& here = at(scene, node);
        if (depth < max_depth && !here.children.empty()) {
            node = here.children.front();
            ++depth;
            return;
        }
        for (; node != top; node = at(scene, node).parent, --depth) {
            const auto& siblings = at(scene, at(scene, node).parent).children;
            const scene::Id id = at(scene, node).id;
            const auto after = std::upper_bound(
                siblings.begin(), siblings.end(), id,
                [&](scene::Id wanted, scene::Index sibling) { return wanted < at(scene, sibling).id; });
            if (after != siblings.end()) {
                node = *after;
                return;
            }
        }
        node = scene::kNone;
    }
};

/// How far `node` lies below `top`; none where it does not.
std::optional<int> depth_below(const scene::Scene& scene, scene::Index top, scene::Index node) {
    for (int depth = 0; node != scene::kNone; node = at(scene, node).parent, ++depth)
        if (node == top) return depth;
    return std::nullopt;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool holds(const std::string& name, const std::string& part) {
    return std::search(name.begin(), name.end(), part.begin(), part.end(),
                       [](char a, char b) { return lower(a) == lower(b); }) != name.end();
}

bool is_wanted(const scene::Node& node, const protocol::Tree& tree) {
    using Only = protocol::Tree::Only;
    if (tree.only == Only::switches && node.type != scene::NodeType::switch_) return false;
    if (tree.only == Only::hinges && !node.hinge) return false;
    return tree.search.empty() || holds(node.name, tree.search);
}

/// The children's names; none where there are too many of them, or too much to read.
std::optional<std::vector<std::string>> choices_of(const scene::Scene& scene, const scene::Node& node) {
    if (node.children.size() > protocol::kMaxChoices) return std::nullopt;
    std::vector<std::string> names;
    std::size_t bytes = 0;
    for (const scene::Index child : node.children) {
        bytes += at(scene, child).name.size();
        if (bytes > kMostChoiceBytes) return std::nullopt;
        names.push_back(at(scene, child).name);
    }
    return names;
}

protocol::TreeNode describe(const scene::PlacedScene& placed, scene::Index index) {
    const scene::Scene& scene = *placed.scene;
    const scene::Node& node = at(scene, index);
    const scene::NodeState& state = placed.nodes[static_cast<std::size_t>(index)];
    protocol::TreeNode described;
    described.id = node.id;
    described.name = node.name;
    described.type = scene::name_of(node.type);
    if (node.parent != scene::kNone) described.parent = at(scene, node.parent).id;
    described.active = state.active;
    described.children = node.children.size();
    if (state.matrix != glm::dmat4(1)) described.matrix = state.matrix;
    if (node.hinge) described.hinge = {scene::unit_axis(*node.hinge), node.hinge->degrees, node.matrix};
    if (const auto* data = std::get_if<scene::SwitchData>(&node.data)) {
        described.active_child = data->active_child;
        described.choices = choices_of(scene, node);
    }
    if (const auto* data = std::get_if<scene::GeometryData>(&node.data)) {
        if (data->geometry != scene::kNone)
            described.triangles =
                scene.geometries()[static_cast<std::size_t>(data->geometry)].triangles.size();
        if (state.material != scene::kNone)
            described.material = scene.materials()[static_cast<std::size_t>(state.material)].id;
    }
    return described;
}

/// About that of its JSON, in bytes.
std::size_t size_of(const protocol::TreeNode& node) {
    std::size_t bytes = node.name.size() + 100 + (node.matrix ? 400 : 0) + (node.hinge ? 500 : 0);
    if (node.choices)
        for (const std::string& choice : *node.choices) bytes += choice.size() + 3;
    return bytes;
}

protocol::Error unknown(scene::Id node, const std::string& why) {
    return {{}, protocol::error_code::unknown_node, why + " " + std::to_string(node)};
}

}  // namespace

tl::expected<protocol::TreePage, protocol::Error> tree_page(const scene::PlacedScene& placed,
                                                            const protocol::Tree& tree) {
    const scene::Scene& scene = *placed.scene;
    const scene::Index top = scene.find_node(tree.node.value_or(0));
    if (top == scene::kNone) return tl::unexpected(unknown(*tree.node, "there is no node"));
    const int all = std::numeric_limits<int>::max();
    Walk walk{scene, top, tree.depth.value_or(tree.search.empty() && !tree.only ? 1 : all), top};
    if (tree.after) {
        const scene::Index after = scene.find_node(*tree.after);
        const auto depth = after == scene::kNone ? std::nullopt : depth_below(scene, top, after);
        if (!depth || *depth > walk.max_depth)
            return tl::unexpected(unknown(*tree.after, "'after': there is no such node below:"));
        walk.node = after;
        walk.depth = *depth;
        walk.next();
    }
    protocol::TreePage page;
    std::size_t bytes = 0;
    scene::Index last = scene::kNone;
    for (int visited = 0; walk.node != scene::kNone; walk.next(), ++visited) {
        if (visited == kMostVisited || page.nodes.size() == kMostNodes || bytes > kMostBytes) {
            page.next = at(scene, last).id;
            break;
        }
        last = walk.node;
        if (!is_wanted(at(scene, walk.node), tree)) continue;
        page.nodes.push_back(describe(placed, walk.node));
        bytes += size_of(page.nodes.back());
    }
    return page;
}

}  // namespace vrut::server::room
