#include "room/scene_tree.hpp"

#include <doctest/doctest.h>

#include <set>

#include "codec.hpp"

using namespace vrut;
using namespace vrut::server::room;
using protocol::Tree;
using protocol::TreePage;

namespace {

scene::SceneParts::PartNode part(scene::Id id, scene::Id parent, std::string name = {}) {
    return {scene::Node{
                id, std::move(name), scene::NodeType::assembly, scene::kNone, {}, true, glm::dmat4(1), {}},
            parent};
}

scene::PlacedScene placed(std::vector<scene::SceneParts::PartNode> nodes) {
    scene::SceneParts parts;
    parts.nodes = std::move(nodes);
    auto scene = scene::Scene::build(std::move(parts));
    REQUIRE_MESSAGE(scene, scene.error().message);
    return scene::place(*std::move(scene));
}

TreePage page_of(const scene::PlacedScene& scene, const Tree& tree) {
    auto page = tree_page(scene, tree);
    REQUIRE_MESSAGE(page, page.error().message);
    return *std::move(page);
}

std::vector<std::int64_t> ids(const TreePage& page) {
    std::vector<std::int64_t> result;
    for (const protocol::TreeNode& node : page.nodes) result.push_back(node.id);
    return result;
}

/// As it comes over the wire.
Tree asked(const std::string& members) {
    const auto message = protocol::decode("{\"type\":\"tree\"," + members + "}");
    REQUIRE_MESSAGE(message, message.error().message);
    return std::get<Tree>(message->payload);
}

using Ids = std::vector<std::int64_t>;

/// The root 0 has 5 and 10; 5 has 7 and 6; 6 has 20; 10 has 8.
scene::PlacedScene small() {
    return placed({part(10, 0, "Door left"), part(5, 0, "Body"), part(7, 5, "DOOR right"),
                   part(6, 5, "Wheel"), part(20, 6, "Outdoor tyre"), part(8, 10, "Handle")});
}

/// All pages, and how many there were. `tree.after` is used for it.
std::pair<Ids, int> all_pages(const scene::PlacedScene& scene, Tree tree) {
    Ids all;
    int pages = 0;
    for (;;) {
        const TreePage page = page_of(scene, tree);
        const Ids here = ids(page);
        all.insert(all.end(), here.begin(), here.end());
        ++pages;
        if (!page.next) return {all, pages};
        tree.after = page.next;
        REQUIRE(pages < 10'000);
    }
}

}  // namespace

TEST_CASE("the node itself comes first, then what is below it down to the depth, by rising id") {
    const scene::PlacedScene scene = small();
    CHECK(ids(page_of(scene, {})) == Ids{0, 5, 10});
    CHECK(ids(page_of(scene, asked(R"("depth":0)"))) == Ids{0});
    CHECK(ids(page_of(scene, asked(R"("depth":2)"))) == Ids{0, 5, 6, 7, 10, 8});
    CHECK(ids(page_of(scene, asked(R"("depth":1000000000)"))) == Ids{0, 5, 6, 20, 7, 10, 8});
    CHECK(ids(page_of(scene, asked(R"("node":5)"))) == Ids{5, 6, 7});
    CHECK(ids(page_of(scene, asked(R"("node":20)"))) == Ids{20});
    CHECK_FALSE(page_of(scene, {}).next);
}

TEST_CASE("a node is told with parent, children, triangles and material, as it stands now") {
    scene::SceneParts parts;
    parts.materials.resize(2);
    parts.materials[0].id = 3;
    parts.materials[1].id = 9;
    scene::Geometry geometry;
    geometry.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    geometry.triangles = {{0, 1, 2}, {0, 2, 1}};
    parts.geometries = {geometry};
    parts.nodes = {part(1, 0, "Group"),
                   {scene::Node{2,
                                "Part",
                                scene::NodeType::geometry,
                                scene::kNone,
                                {},
                                true,
                                glm::dmat4(1),
                                scene::GeometryData{0, 0}},
                    1}};
    auto scene = scene::Scene::build(std::move(parts));
    REQUIRE(scene);
    scene::PlacedScene now = scene::place(*std::move(scene));
    const auto index = static_cast<std::size_t>(now.scene->find_node(2));
    now.nodes[index].active = false;
    now.nodes[index].material = 1;
    const TreePage page = page_of(now, asked(R"("depth":2)"));
    REQUIRE(page.nodes.size() == 3);
    CHECK_FALSE(page.nodes[0].parent);
    CHECK(page.nodes[0].type == "root");
    CHECK(page.nodes[1].parent == 0);
    CHECK(page.nodes[1].children == 1);
    CHECK(page.nodes[1].triangles == 0);
    CHECK_FALSE(page.nodes[1].material);
    CHECK(page.nodes[2].name == "Part");
    CHECK(page.nodes[2].type == "geometry");
    CHECK(page.nodes[2].parent == 1);
    CHECK_FALSE(page.nodes[2].active);
    CHECK(page.nodes[2].triangles == 2);
    CHECK(page.nodes[2].material == 9);
}

TEST_CASE("a hinge is told with its unit axis and the file's matrix, however the node stands now") {
    auto door = part(1, 0, "Door");
    door.node.matrix[3] = {1, 2, 3, 1};
    door.node.hinge = scene::Hinge{{0, -4, 0}, 65};
    scene::PlacedScene now = placed({door, part(2, 0, "Wall")});
    const auto index = static_cast<std::size_t>(now.scene->find_node(1));
    now.nodes[index].matrix = glm::dmat4(1);
    const TreePage page = page_of(now, {});
    REQUIRE(page.nodes.size() == 3);
    REQUIRE(page.nodes[1].hinge);
    CHECK(page.nodes[1].hinge->axis == glm::dvec3(0, -1, 0));
    CHECK(page.nodes[1].hinge->degrees == 65);
    CHECK(page.nodes[1].hinge->closed == door.node.matrix);
    CHECK_FALSE(page.nodes[1].matrix);
    CHECK_FALSE(page.nodes[2].hinge);
}

TEST_CASE("a search finds parts of names in either case, at any depth") {
    const scene::PlacedScene scene = small();
    CHECK(ids(page_of(scene, asked(R"("search":"door")"))) == Ids{20, 7, 10});
    CHECK(ids(page_of(scene, asked(R"("search":"dOOr r")"))) == Ids{7});
    CHECK(ids(page_of(scene, asked(R"("depth":1,"search":"door")"))) == Ids{10});
    CHECK(ids(page_of(scene, asked(R"("node":5,"search":"door")"))) == Ids{20, 7});
    CHECK(ids(page_of(scene, asked(R"("search":"none")"))).empty());
}

TEST_CASE("a page goes on behind any node at or below the one asked for") {
    const scene::PlacedScene scene = small();
    CHECK(ids(page_of(scene, asked(R"("depth":9,"after":20)"))) == Ids{7, 10, 8});
    CHECK(ids(page_of(scene, asked(R"("after":5)"))) == Ids{10});  // whose children lie below the depth
    CHECK(ids(page_of(scene, asked(R"("after":10)"))).empty());
    CHECK(ids(page_of(scene, asked(R"("node":5,"after":7)"))).empty());
    CHECK(ids(page_of(scene, asked(R"("node":5,"after":5)"))) == Ids{6, 7});
}

TEST_CASE("nodes that are not there, or not there, are unknown") {
    const scene::PlacedScene scene = small();
    const auto code = [&](const Tree& tree) {
        const auto page = tree_page(scene, tree);
        REQUIRE_FALSE(page);
        return page.error().code;
    };
    CHECK(code(asked(R"("node":99)")) == "unknown-node");
    CHECK(code(asked(R"("after":99)")) == "unknown-node");
    CHECK(code(asked(R"("node":5,"after":10)")) == "unknown-node");
}

TEST_CASE("pages hold 500 nodes at most, and together each node once") {
    std::vector<scene::SceneParts::PartNode> nodes;
    for (scene::Id id = 1; id <= 1200; ++id) nodes.push_back(part(id, 0));
    const scene::PlacedScene scene = placed(std::move(nodes));
    const TreePage first = page_of(scene, {});
    CHECK(first.nodes.size() == 500);
    CHECK(first.next == 499);
    const auto [all, pages] = all_pages(scene, {});
    CHECK(pages == 3);
    CHECK(all.size() == 1201);
    CHECK(std::set<std::int64_t>(all.begin(), all.end()).size() == 1201);
}

TEST_CASE("500 nodes are one page, without a next") {
    std::vector<scene::SceneParts::PartNode> nodes;
    for (scene::Id id = 1; id <= 499; ++id) nodes.push_back(part(id, 0));
    const scene::PlacedScene scene = placed(std::move(nodes));
    CHECK(page_of(scene, {}).nodes.size() == 500);
    CHECK_FALSE(page_of(scene, {}).next);
}

TEST_CASE("long names make shorter pages") {
    std::vector<scene::SceneParts::PartNode> nodes;
    for (scene::Id id = 1; id <= 400; ++id) nodes.push_back(part(id, 0, std::string(10'000, 'x')));
    const scene::PlacedScene scene = placed(std::move(nodes));
    CHECK(page_of(scene, {}).nodes.size() <= 15);  // 128 KiB, and the one that went beyond
    CHECK(all_pages(scene, {}).first.size() == 401);
}

TEST_CASE("a chain of 100,000 nodes is walked in pages of bounded work") {
    constexpr scene::Id kLength = 100'000;
    std::vector<scene::SceneParts::PartNode> nodes;
    for (scene::Id id = 1; id <= kLength; ++id)
        nodes.push_back(part(id, id - 1, id == kLength ? "Last" : ""));
    const scene::PlacedScene scene = placed(std::move(nodes));
    const TreePage first = page_of(scene, asked(R"("search":"last")"));
    CHECK(first.nodes.empty());
    REQUIRE(first.next);
    CHECK(*first.next == 4'999);
    const auto [found, pages] = all_pages(scene, asked(R"("search":"last")"));
    CHECK(found == Ids{kLength});
    CHECK(pages == 21);
    CHECK(all_pages(scene, asked(R"("depth":1000000000)")).first.size() == kLength + 1);
}

TEST_CASE("only switches are listed, with what they offer and what the file chose") {
    std::vector<scene::SceneParts::PartNode> nodes{part(1, 0, "Paint"), part(7, 1, "Silver"),
                                                   part(3, 1, "Red"), part(4, 0, "Rims"),
                                                   part(8, 4, "Ten spokes")};
    for (const std::size_t at : {std::size_t{0}, std::size_t{3}}) {
        nodes[at].node.type = scene::NodeType::switch_;
        nodes[at].node.data = scene::SwitchData{static_cast<int>(at) - 1};
    }
    const scene::PlacedScene scene = placed(std::move(nodes));
    const TreePage page = page_of(scene, asked(R"("only":"switches")"));
    CHECK(ids(page) == Ids{1, 4});
    CHECK(page.nodes[0].choices == std::vector<std::string>{"Red", "Silver"});
    CHECK(page.nodes[0].active_child == -1);
    CHECK(page.nodes[1].active_child == 2);
    CHECK(ids(page_of(scene, asked(R"("only":"switches","depth":0)"))).empty());
    CHECK(ids(page_of(scene, asked(R"("only":"switches","search":"rim")"))) == Ids{4});
    CHECK(ids(page_of(scene, asked(R"("only":"hinges")"))).empty());
    CHECK(!page_of(scene, asked(R"("node":8)")).nodes[0].choices);
}

TEST_CASE("a switch of very many children is no choice") {
    std::vector<scene::SceneParts::PartNode> nodes{part(1, 0, "Many")};
    nodes[0].node.type = scene::NodeType::switch_;
    nodes[0].node.data = scene::SwitchData{};
    for (scene::Id id = 2; id < 2 + static_cast<scene::Id>(protocol::kMaxChoices); ++id)
        nodes.push_back(part(id, 1));
    CHECK(page_of(placed(nodes), asked(R"("only":"switches")")).nodes[0].choices->size() ==
          protocol::kMaxChoices);
    auto long_winded = nodes;
    long_winded[1].node.name = std::string(17'000, 'x');
    CHECK(!page_of(placed(long_winded), asked(R"("only":"switches")")).nodes[0].choices);
    nodes.push_back(part(1000, 1));
    CHECK(!page_of(placed(nodes), asked(R"("only":"switches")")).nodes[0].choices);
}

TEST_CASE("only what has a hinge is listed") {
    std::vector<scene::SceneParts::PartNode> nodes{part(1, 0, "Door"), part(2, 1, "Handle")};
    nodes[0].node.hinge = scene::Hinge{{0, 2, 0}, -65};
    const TreePage page = page_of(placed(std::move(nodes)), asked(R"("only":"hinges")"));
    CHECK(ids(page) == Ids{1});
    CHECK(page.nodes[0].hinge->degrees == -65);
}
