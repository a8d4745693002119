#include "mesh/picking_trees.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cstring>

#include "grid_surfaces.hpp"
#include "mesh/picking.hpp"
#include "random_parts.hpp"

using namespace vrut;

namespace {

bool same_bits(const std::optional<mesh::Hit>& a, const std::optional<mesh::Hit>& b) {
    if (!a || !b) return !a && !b;
    return a->node == b->node && std::memcmp(&a->point, &b->point, sizeof(a->point)) == 0 &&
           std::memcmp(&a->normal, &b->normal, sizeof(a->normal)) == 0 &&
           std::bit_cast<std::uint64_t>(a->distance) == std::bit_cast<std::uint64_t>(b->distance);
}

glm::dmat4 sheared_by(const glm::dvec3& by) {
    glm::dmat4 matrix(1);
    matrix[1][0] = by.x;
    matrix[2][0] = by.y;
    matrix[2][1] = by.z;
    return matrix;
}

/// Triangles between points of a grid of eighths, so that many share edges and planes and coincide.
scene::Geometry coincident_soup(Dice& dice, int triangles) {
    scene::Geometry geometry;
    for (int i = 0; i < triangles; ++i) {
        const auto at = static_cast<unsigned>(geometry.positions.size());
        geometry.triangles.emplace_back(at, at + 1, at + 2);
        for (int k = 0; k < 3; ++k) {
            geometry.positions.push_back(glm::round(dice.vector(4)) / 8.0);
            geometry.bounds.add(geometry.positions.back());
        }
    }
    return geometry;
}

/// Long and thin, in all directions.
scene::Geometry slivers(Dice& dice, int triangles) {
    scene::Geometry geometry;
    for (int i = 0; i < triangles; ++i) {
        const auto at = static_cast<unsigned>(geometry.positions.size());
        geometry.triangles.emplace_back(at, at + 1, at + 2);
        const glm::dvec3 a = dice.vector(1), b = dice.vector(1);
        const double thin = std::pow(10.0, dice.between(-16, -3));
        for (const glm::dvec3& corner : {a, b, glm::mix(a, b, dice.between(0, 1)) + dice.vector(thin)}) {
            geometry.positions.push_back(corner);
            geometry.bounds.add(corner);
        }
    }
    return geometry;
}

scene::Geometry moved(scene::Geometry geometry, const glm::dvec3& by) {
    geometry.bounds = {};
    for (glm::dvec3& position : geometry.positions) geometry.bounds.add(position += by);
    return geometry;
}

scene::Material material(bool two_sided) {
    scene::Material result = material_of({1, 1, 1});
    result.two_sided = two_sided;
    return result;
}

struct Comparison {
    int rays = 0, hits = 0, different = 0;
};

/// From around the part and from inside to its corners, edges and anywhere in it.
Comparison compare(const scene::PlacedScene& placed, Dice& dice, int rays) {
    const mesh::PickingTrees trees(placed.scene);
    trees.wait();
    Comparison result;
    const auto& nodes = placed.scene->nodes();
    while (result.rays < rays) {
        const auto i = static_cast<std::size_t>(dice.between(0, static_cast<double>(nodes.size())));
        const auto* data = std::get_if<scene::GeometryData>(&nodes[i].data);
        if (!data) continue;
        REQUIRE(trees.of(data->geometry));
        const scene::Geometry& geometry =
            placed.scene->geometries()[static_cast<std::size_t>(data->geometry)];
        const auto any = [&] {
            const auto number =
                static_cast<std::size_t>(dice.between(0, static_cast<double>(geometry.triangles.size())));
            const glm::uvec3& t = geometry.triangles[number];
            const glm::dvec3 &a = geometry.positions[t.x], &b = geometry.positions[t.y];
            const int kind = result.rays % 3;
            const glm::dvec3 on = kind == 0   ? a
                                  : kind == 1 ? glm::mix(a, b, dice.between(0, 1))
                                              : (a + b + geometry.positions[t.z]) / 3.0;
            return glm::dvec3(placed.world[i] * glm::dvec4(on, 1));
        };
        const glm::dvec3 target = any();
        const double radius = glm::distance(target, any()) + 1e-3 * glm::length(target - any());
        const glm::dvec3 from =
            result.rays % 5 == 0 ? any() : target + dice.vector(1) * radius * dice.between(0, 40);
        ++result.rays;
        const mesh::Ray ray{from, glm::normalize(target - from)};
        const auto expected = mesh::pick(placed, ray);
        result.hits += expected.has_value();
        result.different += !same_bits(expected, mesh::pick(placed, ray, {.trees = &trees}));
    }
    return result;
}

}  // namespace

TEST_CASE("with trees a pick is the same to the last bit") {
    Dice dice(5);
    const std::vector<scene::Geometry> geometries{ball(40, 20), torus(30, 20), coincident_soup(dice, 400),
                                                  slivers(dice, 400), corrugated(30, 12)};
    for (std::size_t g = 0; g < geometries.size(); ++g)
        for (const bool two_sided : {true, false}) {
            CAPTURE(g);
            CAPTURE(two_sided);
            const scene::Geometry& geometry = geometries[g];
            const scene::Material surface = material(two_sided);
            int hits = 0;
            const auto test = [&](const scene::Geometry& part, const glm::dmat4& matrix) {
                const Comparison result = compare(*scene_of({{1, part, surface, matrix}}), dice, 300);
                CHECK(result.different == 0);
                hits += result.hits;
            };
            test(geometry, glm::dmat4(1));
            for (int i = 0; i < 4; ++i) test(geometry, dice.matrix());
            test(geometry, sheared_by(dice.vector(30)) * dice.matrix());
            test(geometry, scaled_by({-1, 1, 1}) * dice.matrix());
            test(geometry, dice.matrix() * scaled_by({1e-9, 1e-9, 1e-9}));
            test(geometry, dice.matrix() * scaled_by({1e12, 1e12, 1e12}));
            test(geometry, dice.matrix() * scaled_by({1, 1, 1e-8}) * dice.matrix());
            test(geometry, dice.matrix() * scaled_by({1, 1, 1e-14}) * dice.matrix());
            test(geometry, dice.matrix() * scaled_by({1, 0, 1}) * dice.matrix());
            test(geometry, moved_by(dice.vector(1e8)) * dice.matrix());
            test(geometry, moved_by(dice.vector(1e14)) * dice.matrix());
            const glm::dvec3 far = dice.vector(1e9);
            test(moved(geometry, far), dice.matrix() * moved_by(-far));
            test(moved(geometry, far), glm::dmat4(1));
            CHECK(hits > 16 * 300 / 5);
        }
}

TEST_CASE("with trees the higher id is hit of parts in one place") {
    Dice dice(6);
    const scene::Geometry soup = coincident_soup(dice, 300), globe = ball(24, 12);
    std::vector<Part> parts;
    for (scene::Id id = 1; id <= 12; ++id)
        parts.push_back({id * 7 % 13, id % 2 ? soup : globe, material(id % 3 == 0),
                         moved_by({id / 4, 0, 0}) * scaled_by({id % 5 == 0 ? -1.0 : 1.0, 1, 1})});
    const Comparison result = compare(*scene_of(parts), dice, 4000);
    CHECK(result.different == 0);
    CHECK(result.hits > 1000);
}

TEST_CASE("a geometry of few triangles or of numbers that are not finite has no tree") {
    scene::Geometry broken = ball(40, 20);
    broken.positions[5].x = std::numeric_limits<double>::quiet_NaN();
    const auto placed = scene_of({{1, quad(1), material(true)}, {2, broken, material(true)}});
    const mesh::PickingTrees trees(placed->scene);
    trees.wait();
    for (scene::Index geometry : {0, 1}) CHECK_FALSE(trees.of(geometry));
    CHECK(mesh::pick(*placed, {{0.1, 0.2, 5}, {0, 0, -1}}, {.trees = &trees}));
}
