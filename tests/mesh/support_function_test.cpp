#include "mesh/support_function.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <functional>
#include <limits>

#include "grid_surfaces.hpp"
#include "random_parts.hpp"

using namespace vrut;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Calls `visit` with the values of `direction` at the three corners of each triangle that is shown below a
/// node.
void for_each_triangle(const scene::PlacedScene& placed, scene::Index node, const glm::dvec3& direction,
                       const std::function<void(const glm::dvec3&)>& visit) {
    const std::vector<bool> shown = scene::shown_nodes(placed, std::nullopt);
    const std::vector<bool> below = scene::subtree(*placed.scene, node);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto* data = std::get_if<scene::GeometryData>(&placed.scene->nodes()[i].data);
        if (!data || !shown[i] || !below[i]) continue;
        const scene::Geometry& geometry =
            placed.scene->geometries()[static_cast<std::size_t>(data->geometry)];
        for (const glm::uvec3& triangle : geometry.triangles) {
            glm::dvec3 values;
            for (int k = 0; k < 3; ++k)
                values[k] = glm::dot(
                    direction, glm::dvec3(placed.world[i] * glm::dvec4(geometry.positions[triangle[k]], 1)));
            visit(values);
        }
    }
}

double expected(const scene::PlacedScene& placed, scene::Index node, const glm::dvec3& direction) {
    double most = -kInfinity;
    for_each_triangle(placed, node, direction, [&](const glm::dvec3& values) {
        for (int k = 0; k < 3; ++k) most = std::max(most, values[k]);
    });
    return most;
}

/// What a plane leaves of the scene reaches this far along its normal: to the plane where a triangle crosses
/// it, else to the farthest corner below it.
double expected_below(const scene::PlacedScene& placed, const glm::dvec3& normal, double distance) {
    double most = -kInfinity;
    for_each_triangle(placed, 0, normal, [&](const glm::dvec3& values) {
        for (int k = 0; k < 3; ++k)
            if (values[k] <= distance) most = std::max(most, values[k]);
        if (glm::any(glm::lessThanEqual(values, glm::dvec3(distance))) &&
            glm::any(glm::greaterThan(values, glm::dvec3(distance))))
            most = distance;
    });
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

TEST_CASE("support: what planes leave, with the points where they cut") {
    scene::SceneParts parts;
    parts.geometries = {box({1, 1, 1})};
    parts.nodes = {group(1, false), cube(2, 1, 0), cube(3, 1, 5), group(4, true), cube(5, 4, -30)};
    auto built = scene::Scene::build(std::move(parts));
    REQUIRE(built);
    const scene::PlacedScene placed = scene::place(*std::move(built));
    const auto of = [&](std::vector<scene::ClipPlane> planes) {
        return mesh::SupportFunction(placed, 0, nullptr, planes);
    };
    const glm::dvec3 diagonal = glm::normalize(glm::dvec3(1, 1, 0));
    const mesh::SupportFunction one = of({{{1, 0, 0}, 0.25}});
    CHECK(one({1, 0, 0}) == doctest::Approx(0.25));
    CHECK(one({-1, 0, 0}) == 1);
    CHECK(one(diagonal) == doctest::Approx(1.25 / std::sqrt(2)));
    CHECK(one.bounds().max == glm::dvec3(0.25, 1, 1));
    const mesh::SupportFunction two = of({{{1, 0, 0}, 0.25}, {diagonal, 0.5}});
    CHECK(two(diagonal) == doctest::Approx(0.5));
    CHECK(two({0, 1, 0}) == 1);
    CHECK(two({1, 0, 0}) == doctest::Approx(0.25));
    CHECK(of({{{1, 0, 0}, 7}})({1, 0, 0}) == 6);
    CHECK(of({{{1, 0, 0}, -2}}).bounds().empty());
    CHECK(of({{{1, 0, 0}, -2}})({1, 0, 0}) == -kInfinity);
}

TEST_CASE("support: nothing beyond the planes, and no less than the corners that they leave") {
    Dice dice(5);
    const auto placed = scene_of(random_parts(dice, {}));
    for (int round = 0; round < 50; ++round) {
        const glm::dvec3 normal = glm::normalize(dice.vector(1)), direction = dice.vector(1);
        const mesh::SupportFunction whole(*placed, 0, nullptr);
        const double low = -whole(-normal), distance = low + 0.3 * (whole(normal) - low);
        const std::vector<scene::ClipPlane> planes{{normal, distance}};
        const mesh::SupportFunction cut(*placed, 0, nullptr, planes);
        const double size = whole(normal) - low;
        CHECK(std::abs(cut(normal) - expected_below(*placed, normal, distance)) <= 1e-9 * size);
        CHECK(cut(-normal) == doctest::Approx(whole(-normal)).epsilon(1e-12));
        CHECK(cut(direction) <= whole(direction) + 1e-9 * size);
    }
}
