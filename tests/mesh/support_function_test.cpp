#include "mesh/support_function.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <limits>

#include "grid_surfaces.hpp"
#include "random_parts.hpp"

using namespace vrut;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Each corner of each shown triangle is asked.
double expected(const scene::PlacedScene& placed, scene::Index node, const glm::dvec3& direction) {
    const std::vector<bool> shown = scene::shown_nodes(placed, std::nullopt);
    const std::vector<bool> below = scene::subtree(*placed.scene, node);
    double most = -kInfinity;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto* data = std::get_if<scene::GeometryData>(&placed.scene->nodes()[i].data);
        if (!data || !shown[i] || !below[i]) continue;
        const scene::Geometry& geometry =
            placed.scene->geometries()[static_cast<std::size_t>(data->geometry)];
        for (const glm::uvec3& triangle : geometry.triangles)
            for (int k = 0; k < 3; ++k)
                most = std::max(
                    most, glm::dot(direction, glm::dvec3(placed.world[i] *
                                                         glm::dvec4(geometry.positions[triangle[k]], 1))));
    }
    return most;
}

scene::SceneParts::PartNode group(scene::Id id, bool presentation) {
    scene::SceneParts::PartNode part;
    part.node.id = id;
    part.node.presentation = presentation;
    return part;
}

scene::SceneParts::PartNode cube(scene::Id id, scene::Id parent, double x) {
    scene::SceneParts::PartNode part;
    part.node.id = id;
    part.node.type = scene::NodeType::geometry;
    part.node.matrix = moved_by({x, 0, 0});
    part.node.data = scene::GeometryData{0, scene::kNone};
    part.parent_id = parent;
    return part;
}

}  // namespace

TEST_CASE("support: the farthest point of what is shown, to the same bits with trees") {
    Dice dice(3);
    std::vector<Part> parts = random_parts(dice, {});
    for (scene::Id id = 100; id < 104; ++id)
        parts.push_back({id, id % 2 ? ball(40, 20) : torus(30, 20), {}, dice.matrix()});
    const auto placed = scene_of(parts);
    const mesh::PickingTrees trees(placed->scene);
    trees.wait();
    for (const scene::Index node : {0, 1, static_cast<scene::Index>(placed->nodes.size() - 1)}) {
        const mesh::SupportFunction plain(*placed, node, nullptr), quick(*placed, node, &trees);
        for (int round = 0; round < 200; ++round) {
            const glm::dvec3 direction = dice.vector(1);
            const double support = plain(direction);
            CHECK(support == doctest::Approx(expected(*placed, node, direction)).epsilon(1e-12));
            CHECK(std::bit_cast<std::uint64_t>(quick(direction)) == std::bit_cast<std::uint64_t>(support));
        }
    }
}

TEST_CASE("support: hidden parts and presentation do not count, unless nothing else is there") {
    scene::SceneParts parts;
    parts.geometries = {box({1, 1, 1})};
    parts.nodes = {group(1, false), cube(2, 1, 0), cube(3, 1, 50), group(4, true), cube(5, 4, -30)};
    parts.nodes[2].node.active = false;
    auto built = scene::Scene::build(std::move(parts));
    REQUIRE(built);
    const scene::PlacedScene placed = scene::place(*std::move(built));
    const auto of = [&](scene::Id id) {
        return mesh::SupportFunction(placed, placed.scene->find_node(id), nullptr);
    };
    CHECK(of(0)({1, 0, 0}) == 1);
    CHECK(of(0)({-1, 0, 0}) == 1);
    CHECK(of(0).bounds().min == glm::dvec3(-1));
    CHECK(of(4)({-1, 0, 0}) == 31);
    CHECK(of(4).bounds().max.x == -29);
    CHECK(of(3)({1, 0, 0}) == -kInfinity);
    CHECK(of(3).bounds().empty());
}
