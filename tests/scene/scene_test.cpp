#include "scene/scene.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <unordered_map>

#include "contains.hpp"

using namespace vrut;

namespace {

scene::SceneParts::PartNode part(scene::Id id, scene::Id parent,
                                 scene::NodeType type = scene::NodeType::assembly) {
    return {scene::Node{id, {}, type, scene::kNone, {}, true, glm::dmat4(1), {}}, parent};
}

scene::SceneParts::PartNode geometry_part(scene::Id id, scene::Id parent, scene::Index geometry,
                                          const glm::dmat4& matrix = glm::dmat4(1)) {
    return {scene::Node{id,
                        {},
                        scene::NodeType::geometry,
                        scene::kNone,
                        {},
                        true,
                        matrix,
                        scene::GeometryData{geometry, scene::kNone}},
            parent};
}

scene::Geometry geometry_of(std::vector<glm::dvec3> points) {
    scene::Geometry geometry;
    geometry.positions = std::move(points);
    geometry.triangles.emplace_back(0, 0, 0);
    for (const glm::dvec3& point : geometry.positions) geometry.bounds.add(point);
    return geometry;
}

scene::Scene built(std::vector<scene::SceneParts::PartNode> nodes,
                   std::vector<scene::Geometry> geometries = {}) {
    scene::SceneParts parts;
    parts.nodes = std::move(nodes);
    parts.geometries = std::move(geometries);
    auto scene = scene::Scene::build(std::move(parts));
    REQUIRE_MESSAGE(scene, scene.error().message);
    return *std::move(scene);
}

/// Given as it is written in a book: row by row, the last row left out.
glm::dmat4 rows(const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& z) {
    return glm::transpose(glm::dmat4(x, y, z, {0, 0, 0, 1}));
}

glm::dmat4 moved_by(double x, double y, double z) { return rows({1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}); }

std::vector<scene::Id> shown_ids(const scene::PlacedScene& placed,
                                 const std::optional<glm::dvec3>& eye = std::nullopt) {
    const std::vector<bool> shown = scene::shown_nodes(placed, eye);
    REQUIRE(shown.size() == placed.scene->nodes().size());
    std::vector<scene::Id> ids;
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (shown[i]) ids.push_back(placed.scene->nodes()[i].id);
    std::sort(ids.begin(), ids.end());
    return ids;
}

std::vector<scene::Id> shown_ids(scene::Scene scene, const std::optional<glm::dvec3>& eye = std::nullopt) {
    return shown_ids(scene::place(std::move(scene)), eye);
}

using Ids = std::vector<scene::Id>;

}  // namespace

TEST_CASE("the order in the file does not matter") {
    std::mt19937 random(7);
    std::vector<scene::SceneParts::PartNode> nodes{part(0, 0, scene::NodeType::root)};
    for (scene::Id id = 1; id <= 300; ++id) {
        // Every third hangs under a higher id; the others under lower ones, but not under the one that hangs
        // on them.
        const bool upwards = id % 3 == 0 && id < 300;
        nodes.push_back(
            part(id, upwards ? id + 1 : static_cast<scene::Id>(random()) % std::max<scene::Id>(id - 1, 1)));
        nodes.back().node.name = "n" + std::to_string(id);
    }
    std::vector<scene::Id> parent_of(301);
    for (const auto& node : nodes) parent_of[static_cast<std::size_t>(node.node.id)] = node.parent_id;

    Ids first_order;
    for (int round = 0; round < 20; ++round) {
        const scene::Scene scene = built(nodes);
        REQUIRE(scene.nodes().size() == 301);
        CHECK(scene.nodes()[0].id == 0);
        CHECK(scene.nodes()[0].parent == scene::kNone);
        Ids order;
        std::size_t children = 0;
        for (std::size_t i = 0; i < scene.nodes().size(); ++i) {
            const scene::Node& node = scene.nodes()[i];
            order.push_back(node.id);
            CHECK(scene.find_node(node.id) == static_cast<scene::Index>(i));
            if (node.id != 0) {
                CHECK(node.name == "n" + std::to_string(node.id));
                REQUIRE(node.parent < static_cast<scene::Index>(i));
                CHECK(scene.nodes()[static_cast<std::size_t>(node.parent)].id ==
                      parent_of[static_cast<std::size_t>(node.id)]);
            }
            scene::Id before = -1;
            for (const scene::Index child : node.children) {
                const scene::Node& below = scene.nodes()[static_cast<std::size_t>(child)];
                CHECK(below.parent == static_cast<scene::Index>(i));
                CHECK(below.id > before);
                before = below.id;
            }
            children += node.children.size();
        }
        CHECK(children == 300);
        if (round == 0) first_order = order;
        CHECK(order == first_order);
        std::shuffle(nodes.begin(), nodes.end(), random);
    }
}

TEST_CASE("a root is added where the file has none") {
    const scene::Scene scene = built({part(5, 0), part(9, 5)});
    REQUIRE(scene.nodes().size() == 3);
    CHECK(scene.nodes()[0].type == scene::NodeType::root);
    CHECK(scene.nodes()[1].id == 5);
    CHECK(scene.nodes()[1].parent == 0);
    CHECK(scene.find_node(7) == scene::kNone);

    const scene::Scene empty;
    REQUIRE(empty.nodes().size() == 1);
    CHECK(empty.nodes()[0].type == scene::NodeType::root);
    CHECK(empty.find_node(0) == 0);
    CHECK(scene::place(scene::Scene()).bounds.empty());
}

TEST_CASE("what is no tree is refused, with the node at fault") {
    struct Case {
        std::string what;
        std::vector<scene::SceneParts::PartNode> nodes;
        std::size_t culprit;
        std::string message;
    };
    const std::vector<Case> cases{
        {"duplicate id", {part(1, 0), part(2, 0), part(1, 2)}, 2, "each node once, found 1 twice"},
        {"two roots",
         {part(0, 0, scene::NodeType::root), part(0, 0, scene::NodeType::root)},
         1,
         "each node once, found 0 twice"},
        {"no parent", {part(1, 0), part(2, 77)}, 1, "parent 77 of node 2"},
        {"own parent",
         {part(1, 0), part(3, 3)},
         1,
         "node 3 below the root, found it among its own ancestors"},
        {"cycle of two",
         {part(1, 0), part(4, 5), part(5, 4)},
         1,
         "node 4 below the root, found it among its own ancestors"},
        {"what hangs under a cycle is not in it",
         {part(9, 8), part(8, 5), part(4, 5), part(5, 6), part(6, 4), part(7, 0)},
         3,
         "node 5 below the root, found it among its own ancestors"},
        {"id 0 that is no root",
         {part(1, 0), part(0, 0)},
         1,
         "id 0 for the root and no other node, found assembly 0"},
        {"root with another id",
         {part(0, 0, scene::NodeType::root), part(3, 0, scene::NodeType::root)},
         1,
         "id 0 for the root and no other node, found root 3"},
    };
    for (const Case& c : cases) {
        CAPTURE(c.what);
        scene::SceneParts parts;
        parts.nodes = c.nodes;
        const auto scene = scene::Scene::build(std::move(parts));
        REQUIRE_FALSE(scene);
        CHECK(scene.error().node == c.culprit);
        CHECK_MESSAGE(contains(scene.error().message, c.message), scene.error().message);
    }
}

TEST_CASE("what the file holds comes through; geometry without a material has the default one") {
    scene::SceneParts parts;
    parts.name = "car";
    parts.unit = 0.001;
    parts.notices = {"a notice"};
    parts.materials.resize(2);
    parts.materials[1].name = "Paint";
    parts.geometries = {geometry_of({{0, 0, 0}}), geometry_of({{1, 1, 1}})};
    parts.geometries[1].triangles.resize(10);
    parts.nodes = {geometry_part(1, 0, 0), geometry_part(2, 0, 1), geometry_part(3, 0, 1),
                   geometry_part(4, 0, scene::kNone)};
    const auto scene = scene::Scene::build(std::move(parts));
    REQUIRE(scene);
    CHECK(scene->name() == "car");
    CHECK(scene->unit() == 0.001);
    CHECK(scene->notices() == std::vector<std::string>{"a notice"});
    CHECK(scene->triangle_count() == 1 + 10 + 10);
    CHECK(scene->material(1).name == "Paint");
    const scene::Material& usual = scene->material(scene::kNone);
    CHECK(usual.ambient == glm::dvec4(0, 0, 0, 1));
    CHECK(usual.diffuse == glm::dvec4(0.8, 0.8, 0.8, 1));
    CHECK(usual.specular == glm::dvec4(0, 0, 0, 1));
    CHECK(usual.emission == glm::dvec4(0, 0, 0, 1));
    CHECK(usual.shininess == 0);
    CHECK(usual.reflectivity == 0);
    CHECK_FALSE(usual.two_sided);
}

TEST_CASE("world = parent * local, from the root down") {
    std::vector<scene::SceneParts::PartNode> nodes{part(0, 0, scene::NodeType::root), part(2, 3), part(3, 0),
                                                   part(4, 0)};
    nodes[0].node.matrix = moved_by(10, 20, 30);
    nodes[1].node.matrix = rows({2, 0, 0, 5}, {0, 3, 0, 0}, {0, 0, 4, 0});
    nodes[2].node.matrix = rows({0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 7});  // a quarter turn about z
    const scene::Scene scene = built(nodes);
    const std::vector<glm::dmat4> world = scene::world_matrices(scene, scene::file_states(scene));
    const auto of = [&](scene::Id id) { return world[static_cast<std::size_t>(scene.find_node(id))]; };
    CHECK(of(0) == moved_by(10, 20, 30));
    CHECK(of(4) == moved_by(10, 20, 30));
    CHECK(of(3) == rows({0, -1, 0, 10}, {1, 0, 0, 20}, {0, 0, 1, 37}));
    // (1, 1, 1) goes to (7, 3, 4), then to (-3, 7, 11), then to (7, 27, 41).
    CHECK(of(2) * glm::dvec4(1, 1, 1, 1) == glm::dvec4(7, 27, 41, 1));
}

TEST_CASE("a node shows only where all above it are active") {
    std::vector<scene::SceneParts::PartNode> nodes{part(0, 0, scene::NodeType::root), part(1, 0), part(2, 1),
                                                   part(3, 2), part(4, 0)};
    CHECK(shown_ids(built(nodes)) == Ids{0, 1, 2, 3, 4});
    nodes[2].node.active = false;
    CHECK(shown_ids(built(nodes)) == Ids{0, 1, 4});
    nodes[0].node.active = false;
    CHECK(shown_ids(built(nodes)).empty());
}

TEST_CASE("a switch shows the active child, by order of ids, if that is itself active") {
    const auto with = [](int active_child) {
        std::vector<scene::SceneParts::PartNode> nodes{part(8, 1), part(9, 2), part(6, 2), part(7, 2),
                                                       part(2, 1)};
        nodes.push_back(part(1, 0, scene::NodeType::switch_));
        nodes[2].node.active = false;
        nodes.back().node.data = scene::SwitchData{active_child};
        return built(nodes);
    };
    CHECK(shown_ids(with(0)) == Ids{0, 1, 2, 7, 9});
    CHECK(shown_ids(with(1)) == Ids{0, 1, 8});
    CHECK(shown_ids(with(2)) == Ids{0, 1});
    CHECK(shown_ids(with(1 << 30)) == Ids{0, 1});
    CHECK(shown_ids(with(scene::SwitchData::kNoChild)) == Ids{0, 1});
    CHECK(shown_ids(with(scene::SwitchData::kAllChildren)) == Ids{0, 1, 2, 7, 8, 9});

    std::vector<scene::SceneParts::PartNode> nodes{part(1, 0, scene::NodeType::switch_), part(2, 1),
                                                   part(3, 1)};
    nodes[0].node.data = scene::SwitchData{0};
    nodes[1].node.active = false;
    CHECK(shown_ids(built(nodes)) == Ids{0, 1});
}

TEST_CASE("a LOD shows the first child whose range is beyond the eye") {
    const auto with = [](std::vector<double> ranges, int children) {
        std::vector<scene::SceneParts::PartNode> nodes{part(1, 0), part(2, 1, scene::NodeType::lod)};
        nodes[0].node.matrix = moved_by(1000, 0, 0);
        nodes[1].node.matrix = moved_by(0, 5, 0);
        nodes[1].node.data = scene::LodData{std::move(ranges)};
        for (int i = 0; i < children; ++i) {
            nodes.push_back(part(10 + i, 2));
            nodes.back().node.matrix = moved_by(0, 0, 777);  // only the LOD's own origin counts
        }
        return built(nodes);
    };
    const auto at = [](double distance) { return glm::dvec3(1000, 5, distance); };
    const scene::Scene three = with({10, 40}, 3);
    CHECK(shown_ids(three, at(0)) == Ids{0, 1, 2, 10});
    CHECK(shown_ids(three, at(9.999)) == Ids{0, 1, 2, 10});
    CHECK(shown_ids(three, at(10)) == Ids{0, 1, 2, 11});
    CHECK(shown_ids(three, at(-39.999)) == Ids{0, 1, 2, 11});
    CHECK(shown_ids(three, at(40)) == Ids{0, 1, 2, 12});
    CHECK(shown_ids(three, at(1e9)) == Ids{0, 1, 2, 12});
    CHECK(shown_ids(three) == Ids{0, 1, 2, 10, 11, 12});
    CHECK(shown_ids(with({10, 40}, 2), at(41)) == Ids{0, 1, 2});
    CHECK(shown_ids(with({10, 40}, 5), at(41)) == Ids{0, 1, 2, 12});
    CHECK(shown_ids(with({}, 2), at(3)) == Ids{0, 1, 2, 10});
    CHECK(shown_ids(with({40, 10}, 3), at(20)) == Ids{0, 1, 2, 10});
}

TEST_CASE("drawable is what has triangles and shows from some eye, by rising id") {
    std::vector<scene::SceneParts::PartNode> nodes{part(1, 0, scene::NodeType::lod),
                                                   geometry_part(9, 1, 0),
                                                   geometry_part(3, 1, 0),
                                                   part(2, 0, scene::NodeType::switch_),
                                                   geometry_part(4, 2, 0),
                                                   geometry_part(8, 2, 0),
                                                   geometry_part(5, 0, scene::kNone),
                                                   geometry_part(6, 0, 1),
                                                   geometry_part(7, 0, 0),
                                                   geometry_part(10, 0, 0)};
    nodes[0].node.data = scene::LodData{{10}};
    nodes[3].node.data = scene::SwitchData{1};
    nodes[8].node.active = false;
    scene::Geometry points = geometry_of({{0, 0, 0}});
    points.triangles.clear();
    const scene::PlacedScene placed = scene::place(built(nodes, {geometry_of({{0, 0, 0}}), points}));
    Ids ids;
    for (const scene::Index node : placed.drawable)
        ids.push_back(placed.scene->nodes()[static_cast<std::size_t>(node)].id);
    CHECK(ids == Ids{3, 8, 9, 10});
}

TEST_CASE("bounds") {
    math::Bounds box;
    CHECK(box.empty());
    CHECK(box.radius() == 0);
    CHECK(box.center() == glm::dvec3(0));
    box.add(math::Bounds{});
    CHECK(box.empty());
    CHECK(math::transformed(moved_by(1, 2, 3), box).empty());
    box.add({1, 2, 3});
    CHECK_FALSE(box.empty());
    CHECK(box.radius() == 0);
    CHECK(box.center() == glm::dvec3(1, 2, 3));
    box.add({3, 8, -6});
    CHECK(box.min == glm::dvec3(1, 2, -6));
    CHECK(box.max == glm::dvec3(3, 8, 3));
    CHECK(box.center() == glm::dvec3(2, 5, -1.5));
    CHECK(box.half_extent() == glm::dvec3(1, 3, 4.5));
    CHECK(box.radius() == doctest::Approx(std::sqrt(1 + 9 + 20.25)).epsilon(1e-15));

    math::Bounds huge;
    huge.add({1.5e308, 0, 0});
    huge.add({1.7e308, 0, 0});
    CHECK(huge.center().x == doctest::Approx(1.6e308));
}

TEST_CASE("a transformed box is the box around its transformed corners") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> number(-3, 3);
    const auto vector = [&] { return glm::dvec3(number(random), number(random), number(random)); };
    for (int round = 0; round < 1000; ++round) {
        math::Bounds box;
        box.add(vector() * 10.0);
        box.add(vector());
        glm::dmat4 matrix(glm::dvec4(vector(), 0), glm::dvec4(vector(), 0), glm::dvec4(vector(), 0),
                          glm::dvec4(vector() * 100.0, 1));
        if (round % 10 == 0) matrix[1] = matrix[0];  // flattened
        math::Bounds expected;
        for (const double x : {box.min.x, box.max.x})
            for (const double y : {box.min.y, box.max.y})
                for (const double z : {box.min.z, box.max.z})
                    expected.add(glm::dvec3(matrix[0]) * x + glm::dvec3(matrix[1]) * y +
                                 glm::dvec3(matrix[2]) * z + glm::dvec3(matrix[3]));
        const math::Bounds result = math::transformed(matrix, box);
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(std::abs(result.min[axis] - expected.min[axis]) < 1e-12 * 400);
            CHECK(std::abs(result.max[axis] - expected.max[axis]) < 1e-12 * 400);
        }
    }
}

TEST_CASE("the scene's bounds hold what could show from anywhere") {
    const std::vector<scene::Geometry> geometries{geometry_of({{-1, -1, -1}, {1, 1, 1}}), scene::Geometry{}};
    const auto bounds_of = [&](const std::vector<scene::SceneParts::PartNode>& nodes) {
        return scene::place(built(nodes, geometries)).bounds;
    };
    const auto at = [](scene::Id id, scene::Id parent, double x) {
        return geometry_part(id, parent, 0, moved_by(x, 0, 0));
    };

    CHECK(bounds_of({part(1, 0)}).empty());
    CHECK(bounds_of({geometry_part(1, 0, 1), geometry_part(2, 0, scene::kNone)}).empty());

    std::vector<scene::SceneParts::PartNode> nodes{at(1, 0, 0), at(2, 0, 10), at(3, 0, -20)};
    CHECK(bounds_of(nodes).min == glm::dvec3(-21, -1, -1));
    CHECK(bounds_of(nodes).max == glm::dvec3(11, 1, 1));
    nodes[2].node.active = false;
    CHECK(bounds_of(nodes).min == glm::dvec3(-1, -1, -1));

    std::vector<scene::SceneParts::PartNode> switched{part(1, 0, scene::NodeType::switch_), at(2, 1, 0),
                                                      at(3, 1, 50)};
    switched[0].node.data = scene::SwitchData{1};
    CHECK(bounds_of(switched).min == glm::dvec3(49, -1, -1));
    std::vector<scene::SceneParts::PartNode> lod{part(1, 0, scene::NodeType::lod), at(2, 1, 0), at(3, 1, 50)};
    lod[0].node.data = scene::LodData{{1}};
    CHECK(bounds_of(lod).min == glm::dvec3(-1, -1, -1));
    CHECK(bounds_of(lod).max == glm::dvec3(51, 1, 1));
}

TEST_CASE("a subtree's bounds hold what shows at and below its node") {
    const std::vector<scene::Geometry> geometries{geometry_of({{-1, -1, -1}, {1, 1, 1}})};
    const auto at = [](scene::Id id, scene::Id parent, double x) {
        return geometry_part(id, parent, 0, moved_by(x, 0, 0));
    };
    std::vector<scene::SceneParts::PartNode> nodes{part(9, 0), at(1, 9, 10), at(2, 1, 10), at(3, 0, -50),
                                                   at(4, 0, 90)};
    nodes[4].node.active = false;
    const scene::PlacedScene placed = scene::place(built(nodes, geometries));
    const auto of = [&](scene::Id id) { return scene::subtree_bounds(placed, placed.scene->find_node(id)); };
    CHECK(of(9).min == glm::dvec3(9, -1, -1));
    CHECK(of(9).max == glm::dvec3(21, 1, 1));
    CHECK(of(2).min == glm::dvec3(19, -1, -1));
    CHECK(of(3).max == glm::dvec3(-49, 1, 1));
    CHECK(of(4).empty());
    CHECK(of(0).min == placed.bounds.min);
    CHECK(of(0).max == placed.bounds.max);
}

TEST_CASE("a geometry needs double-single positions where some instance is longer than 256 m") {
    const auto needs = [](double unit, const glm::dmat4& matrix, double length) {
        scene::SceneParts parts;
        parts.unit = unit;
        parts.geometries = {geometry_of({{0, 0, 0}, {length, 1, 1}}), scene::Geometry()};
        parts.nodes = {geometry_part(1, 0, 0), geometry_part(2, 0, 0), geometry_part(3, 0, 1)};
        parts.nodes[1].node.matrix = matrix;
        const auto scene = scene::Scene::build(std::move(parts));
        REQUIRE(scene);
        CHECK_FALSE(scene->needs_double_single(1));  // without positions
        return scene->needs_double_single(0);
    };
    CHECK_FALSE(needs(1, glm::dmat4(1), 255));
    CHECK(needs(1, glm::dmat4(1), 257));
    CHECK_FALSE(needs(0.001, glm::dmat4(1), 2e5));
    CHECK(needs(0.001, glm::dmat4(1), 3e5));
    CHECK(needs(1, glm::dmat4(glm::dmat3(300)), 1));
}

TEST_CASE("parts beyond the range of double leave the bounds alone") {
    const double infinity = std::numeric_limits<double>::infinity();
    const std::vector<scene::Geometry> geometries{geometry_of({{-1, -1, -1}, {1, 1, 1}})};
    std::vector<scene::SceneParts::PartNode> nodes{geometry_part(1, 0, 0)};
    for (const double bad : {infinity, -infinity, std::nan(""), 1e200}) {
        const scene::Id id = 10 + static_cast<scene::Id>(nodes.size()) * 10;
        nodes.push_back(geometry_part(id, 0, 0, moved_by(bad, 0, 0)));
        nodes.push_back(geometry_part(id + 1, 0, 0, rows({1, 0, 0, 0}, {0, bad, 0, 0}, {0, 0, 1, 0})));
    }
    // Finite factors, but no finite product.
    nodes.push_back(geometry_part(2, 0, 0, glm::dmat4(1e200)));
    nodes.push_back(geometry_part(3, 2, 0, glm::dmat4(1e200)));
    const scene::PlacedScene placed = scene::place(built(nodes, geometries));
    CHECK(placed.bounds.min == glm::dvec3(-1, -1, -1));
    CHECK(placed.bounds.max == glm::dvec3(1, 1, 1));
    CHECK(scene::is_finite(placed.world[static_cast<std::size_t>(placed.scene->find_node(1))]));
    CHECK_FALSE(scene::is_finite(placed.world[static_cast<std::size_t>(placed.scene->find_node(3))]));
}

TEST_CASE("a chain of a million nodes is built, placed and given back") {
    constexpr scene::Id kCount = 1'000'000;
    const auto chain = [&](scene::Id last_parent) {
        scene::SceneParts parts;
        parts.geometries = {geometry_of({{0, 0, 0}})};
        parts.nodes.reserve(static_cast<std::size_t>(kCount));
        parts.nodes.push_back(geometry_part(1, 2, 0, moved_by(1, 0, 0)));
        for (scene::Id id = 2; id <= kCount; ++id) {  // each child stands before its parent
            parts.nodes.push_back(part(id, id == kCount ? last_parent : id + 1));
            parts.nodes.back().node.matrix = moved_by(1, 0, 0);
        }
        return scene::Scene::build(std::move(parts));
    };
    auto scene = chain(0);
    REQUIRE(scene);
    const scene::PlacedScene placed = scene::place(*std::move(scene));
    CHECK(placed.scene->nodes().size() == static_cast<std::size_t>(kCount) + 1);
    CHECK(placed.bounds.min == glm::dvec3(1e6, 0, 0));
    CHECK(placed.bounds.max == glm::dvec3(1e6, 0, 0));

    const auto ring = chain(1);
    REQUIRE_FALSE(ring);
    CHECK(contains(ring.error().message, "among its own ancestors"));
}

TEST_CASE("ids that are chosen to be in one place of a table cost no more than others") {
    constexpr scene::Id kCount = 60'000;
    const auto seconds = [](scene::Id step) {
        std::vector<scene::SceneParts::PartNode> nodes;
        for (scene::Id i = 1; i <= kCount; ++i) nodes.push_back(part(i * step, 0));
        const auto start = std::chrono::steady_clock::now();
        CHECK(built(std::move(nodes)).find_node(kCount * step) != scene::kNone);
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    std::unordered_map<scene::Id, scene::Index> table;
    table.reserve(kCount + 1);
    const double others = seconds(1);
    CHECK(seconds(static_cast<scene::Id>(table.bucket_count())) < 10 * others + 0.2);
}

TEST_CASE("nodes start as the file says") {
    std::vector<scene::SceneParts::PartNode> nodes{part(1, 0), part(2, 1), part(3, 1), part(4, 0)};
    nodes[0].node.type = scene::NodeType::switch_;
    nodes[0].node.data = scene::SwitchData{-2};
    nodes[0].node.matrix = moved_by(1, 2, 3);
    nodes[1].node.active = false;
    nodes[2].node.type = scene::NodeType::geometry;
    nodes[2].node.data = scene::GeometryData{0, 1};
    scene::SceneParts parts;
    parts.nodes = nodes;
    parts.materials.resize(2);
    parts.geometries.resize(1);
    const auto scene = scene::Scene::build(std::move(parts));
    REQUIRE(scene);
    const std::vector<scene::NodeState> states = scene::file_states(*scene);
    REQUIRE(states.size() == 5);
    const auto of = [&](scene::Id id) { return states[static_cast<std::size_t>(scene->find_node(id))]; };
    CHECK(of(1) == scene::NodeState{true, -2, scene::kNone, moved_by(1, 2, 3)});
    CHECK(of(2) == scene::NodeState{false, 0, scene::kNone, glm::dmat4(1)});
    CHECK(of(3) == scene::NodeState{true, 0, 1, glm::dmat4(1)});
    CHECK(of(4) == scene::NodeState{});
    CHECK(scene::place(scene::Scene()).nodes == std::vector<scene::NodeState>{scene::NodeState{}});
}

TEST_CASE("what shows, and where, follows from the states and not from the file") {
    std::vector<scene::SceneParts::PartNode> nodes{part(1, 0), part(2, 1), part(3, 1)};
    nodes[0].node.type = scene::NodeType::switch_;
    nodes[0].node.data = scene::SwitchData{0};
    const std::vector<scene::Geometry> geometries{geometry_of({{0, 0, 0}, {1, 1, 1}})};
    for (std::size_t i = 1; i <= 2; ++i) {
        nodes[i].node.type = scene::NodeType::geometry;
        nodes[i].node.data = scene::GeometryData{0, scene::kNone};
    }
    const auto scene = std::make_shared<const scene::Scene>(built(nodes, geometries));
    const scene::PlacedScene first = scene::place(scene, scene::file_states(*scene));
    CHECK(shown_ids(first) == Ids{0, 1, 2});
    CHECK(first.bounds.max == glm::dvec3(1));

    const auto at = [&](scene::Id id) { return static_cast<std::size_t>(scene->find_node(id)); };
    std::vector<scene::NodeState> states = first.nodes;
    states[at(1)].active_child = 1;
    states[at(1)].matrix = moved_by(10, 0, 0);
    states[at(3)].matrix = moved_by(0, 5, 0);
    const scene::PlacedScene second = scene::place(scene, states);
    CHECK(second.scene == scene);
    CHECK(shown_ids(second) == Ids{0, 1, 3});
    CHECK(glm::dvec3(second.world[at(3)][3]) == glm::dvec3(10, 5, 0));
    CHECK(second.bounds.min == glm::dvec3(10, 5, 0));
    CHECK(second.bounds.max == glm::dvec3(11, 6, 1));
    states[at(3)].active = false;
    CHECK(shown_ids(scene::place(scene, states)) == Ids{0, 1});
    CHECK(scene::place(scene, states).bounds.empty());
}

TEST_CASE("whole numbers are taken off texture coordinates, but where a texture does not repeat") {
    for (const bool repeats : {true, false}) {
        scene::SceneParts parts;
        parts.geometries = {geometry_of({{0, 0, 0}, {1, 0, 0}})};
        parts.geometries[0].texcoords = {{5, 0.5F}, {6, 0.5F}};
        parts.materials.resize(1);
        if (!repeats) parts.materials[0].sampler.wraps[0] = scene::Wrap::clamp;
        parts.nodes = {geometry_part(1, 0, 0)};
        std::get<scene::GeometryData>(parts.nodes[0].node.data).material = 0;
        const auto scene = scene::Scene::build(std::move(parts));
        REQUIRE(scene);
        CHECK(scene->geometries()[0].texcoords[0] == glm::vec2(repeats ? 0 : 5, 0.5F));
    }
}
