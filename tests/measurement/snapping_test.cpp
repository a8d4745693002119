#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "measurement/measure.hpp"
#include "near.hpp"
#include "random_parts.hpp"
#include "repetitions.hpp"
#include "snapped_rays.hpp"

using namespace vrut;
using measurement::Snap;

namespace {

constexpr double kRadius = 0.01;  // 0.05 at a distance of 5

/// Looks down, a little aslant, at a point of a scene that is placed by the variant.
std::optional<measurement::Snapped> snapped_at(const Variant& variant, const std::vector<Part>& parts,
                                               const glm::dvec3& at, const std::vector<Snap>& to = {},
                                               const glm::dvec3& from = {0.7, 0.4, 5}) {
    const auto scene = scene_under(variant.matrix, parts);
    return snapped(*scene, ray_in(variant, at + from, at), kRadius, to);
}

void check_points(const Variant& variant, const std::vector<Part>& parts, const glm::dvec3& at, Snap snap,
                  const std::vector<glm::dvec3>& points, double tolerance = 0) {
    CAPTURE(variant.name);
    const auto found = snapped_at(variant, parts, at);
    REQUIRE(found);
    REQUIRE(found->feature.snap == snap);
    REQUIRE(found->feature.points.size() == measurement::point_count(snap));
    CHECK(found->feature.node == 7);
    for (std::size_t i = 0; i < points.size(); ++i)
        CHECK(near(found->feature.points[i], points[i], tolerance));
    const glm::dvec3 world(variant.matrix * parts[0].matrix * glm::dvec4(found->feature.points[0], 1));
    CHECK(near(found->point, world, 1e-8 * variant.scale));
    CHECK(found->offset <= kRadius);
}

void check_circle(const Variant& variant, const std::vector<Part>& parts, const glm::dvec3& at,
                  const glm::dvec3& center, double radius, double tolerance = 1e-12) {
    check_points(variant, parts, at, Snap::center, {center}, tolerance * radius);
    const auto found = snapped_at(variant, parts, at);
    for (const std::size_t k : {1U, 2U})
        CHECK(std::abs(glm::distance(found->feature.points[0], found->feature.points[k]) - radius) <
              tolerance * radius);
}

std::vector<Part> part(const scene::Geometry& geometry, const glm::dmat4& matrix = glm::dmat4(1)) {
    return {{7, geometry, {}, matrix}};
}

}  // namespace

TEST_CASE("a ray snaps to corners, midpoints, edges and faces of a box") {
    const auto parts = part(box({1, 1, 1}));
    for (const Variant& variant : variants()) {
        check_points(variant, parts, {0.98, 0.97, 1}, Snap::vertex, {{1, 1, 1}});
        check_points(variant, parts, {1.02, 1.01, 1}, Snap::vertex, {{1, 1, 1}});
        check_points(variant, parts, {0.98, 0.02, 1}, Snap::midpoint, {{1, 0, 1}});
        check_points(variant, parts, {0.98, 0.5, 1}, Snap::edge, {});
        check_points(variant, parts, {0.3, 0.2, 1}, Snap::plane, {});
        const auto edge = snapped_at(variant, parts, {0.98, 0.5, 1});
        CHECK(edge->feature.points[0].x == 1);
        CHECK(edge->feature.points[0].z == 1);
        CHECK(std::abs(edge->feature.points[0].y - 0.5) < 0.05);
        CHECK(edge->line.size() == 2);
        CHECK(glm::distance(edge->line[0], edge->line[1]) == doctest::Approx(2 * variant.scale));
    }
}

TEST_CASE("a plane is spanned from the picked point, around its front") {
    for (const Variant& variant : variants()) {
        const auto found = snapped_at(variant, part(box({1, 1, 1})), {0.3, 0.2, 1});
        REQUIRE(found);
        const auto& p = found->feature.points;
        CHECK(near(p[0], {0.3, 0.2, 1}, 1e-7));
        CHECK(near(glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0])), {0, 0, 1}, 1e-12));
        CHECK(found->line.empty());
    }
}

TEST_CASE("a plane is that of the largest of its triangles") {
    scene::Geometry flat;
    flat.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-5, 1e-13}, {0.5, 1, 0}, {0.5, -1, 0}};
    flat.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {1, 0, 4}};
    for (const double y : {5e-6, 0.3, -0.3}) {
        const auto found = snapped_at({}, part(with_bounds(flat)), {0.52, y, 0}, {Snap::plane}, {0, 0, 5});
        REQUIRE(found);
        const auto& p = found->feature.points;
        CHECK(near(glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0])), {0, 0, 1}, 1e-12));
        CHECK(std::abs(p[0].z) < 1e-15);
    }
}

TEST_CASE("a ray snaps to the center of a circle by its rim") {
    for (const Variant& variant : variants()) {
        check_points(variant, part(plate()), {1.02, 0.1, 0}, Snap::center, {{0, 0, 0}}, 1e-12);
        const auto hole = snapped_at(variant, part(plate()), {1.02, 0.1, 0});
        const auto& p = hole->feature.points;
        CHECK(std::abs(glm::distance(p[0], p[1]) - 1) < 1e-12);
        CHECK(std::abs(glm::distance(p[0], p[2]) - 1) < 1e-12);
        CHECK(std::abs(glm::dot(p[1] - p[0], p[2] - p[0])) < 1e-12);
        CHECK(hole->line.size() == 64);
        CHECK(hole->line.front() == hole->line.back());
        for (const glm::dvec3& point : hole->line)
            CHECK(std::abs(glm::distance(point, hole->point) - variant.scale) < 1e-7 * variant.scale);
        check_points(variant, part(prism(circle_outline(0.5, 24), 1)), {0.49, 0.03, 0}, Snap::center,
                     {{0, 0, 0}}, 1e-12);
        check_points(variant, part(prism(circle_outline(0.5, 24), 1, 0)), {0.01, 0, 0}, Snap::vertex,
                     {{0, 0, 0}});
    }
}

TEST_CASE("a circle is as far as its rim, and its facets do not count") {
    const auto fine = snapped_at({}, part(plate(2, 1, 512)), {1.02, 0.1, 0}, {}, {0, 0, 5});
    REQUIRE(fine);
    CHECK(fine->feature.snap == Snap::center);
    CHECK(std::abs(fine->offset - (std::hypot(1.02, 0.1) - 1) / 5) < 1e-4);
    const glm::dvec2 facet = (on_circle(4, 0, 24) + on_circle(4, 1, 24)) * 0.499;
    check_points({}, part(prism(circle_outline(4, 24), 1)), {facet, 0}, Snap::center, {{0, 0, 0}}, 1e-12);
}

TEST_CASE("pieces of a curve that is no circle have no midpoints") {
    Outline ellipse = circle_outline(1, 64);
    for (glm::dvec2& p : ellipse) p.x *= 2;
    const glm::dvec2 middle = (ellipse[8] + ellipse[9]) * 0.499;
    check_points({}, part(prism(ellipse, 1)), {middle, 0}, Snap::edge, {});
    const auto asked = snapped_at({}, part(prism(ellipse, 1)), {middle, 0}, {Snap::midpoint});
    REQUIRE(asked);
    CHECK(near(asked->feature.points[0], {(ellipse[8] + ellipse[9]) * 0.5, 0}));
}

TEST_CASE("pieces of an edge that is not quite straight have no midpoints") {
    Outline square = square_outline(2, 8);
    square[0].x += 1e-3;  // the middle of a side
    const glm::dvec2 middle = (square[0] + square[1]) * 0.499;
    check_points({}, part(prism(square, 1)), {middle, 0}, Snap::edge, {});
    const glm::dvec2 of_whole = (square[3] + square[5]) * 0.499;
    check_points({}, part(prism(square, 1)), {of_whole, 0}, Snap::midpoint, {{-2, 0, 0}});
}

TEST_CASE("a sliver of floats takes the plane of the triangle beside it") {
    const glm::dmat4 turn = turned_by(25, glm::normalize(glm::dvec3(1, 2, 3)));
    scene::Geometry sheet;
    for (const glm::dvec3& p : {glm::dvec3(-1, 0, 0), {1, 0, 0}, {0, 2, 0}, {0.1, -1e-5, 0}})
        sheet.positions.emplace_back(glm::vec3(turn * glm::dvec4(p, 1)));
    sheet.triangles = {{0, 1, 2}, {1, 0, 3}};
    const glm::dvec3 normal(turn * glm::dvec4(0, 0, 1, 0)), at(turn * glm::dvec4(0.1, -3e-6, 0, 1));
    const auto placed = scene_of({{1, with_bounds(sheet), {}}});
    measurement::MeshEdgesMemo memo;
    const mesh::Ray ray{at + 5.0 * normal, -normal};
    const auto hit = mesh::pick(*placed, ray);
    REQUIRE(hit);
    const auto found = measurement::snap(*placed, *hit, ray, {.radius = 1e-3, .to = {Snap::plane}}, memo);
    REQUIRE(found);
    const std::vector<glm::dvec3>& p = found->feature.points;
    CHECK(glm::length(glm::cross(glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0])), normal)) < 1e-6);
}

TEST_CASE("what is a circle in the world counts, not in the part") {
    const double stretch = 1.5;
    Outline ellipse = circle_outline(1, 32);
    for (glm::dvec2& p : ellipse) p.x /= stretch;
    const scene::Geometry stretched = ring(ellipse, square_outline(3, 32), -0.25, 0);
    const glm::dmat4 matrix = scaled_by({stretch, 1, 1});
    for (const Variant& variant : variants()) {
        CAPTURE(variant.name);
        const auto parts = part(stretched, matrix);
        const auto found = snapped_at(variant, parts, {1.02, 0.1, 0});
        REQUIRE(found);
        REQUIRE(found->feature.snap == Snap::center);
        measurement::MeshEdgesMemo memo;
        const std::vector<measurement::Feature> picks{found->feature};
        const auto scene = scene_under(variant.matrix, parts);
        const auto radius = measurement::measure(*scene, measurement::Kind::radius, picks, memo);
        REQUIRE(radius.value);
        CHECK(std::abs(*radius.value - variant.scale) < 1e-9 * variant.scale);
        const auto round = snapped_at(variant, part(plate(), matrix), {1.52, 0.1, 0});
        REQUIRE(round);
        CHECK(round->feature.snap != Snap::center);
    }
}

TEST_CASE("a hexagon has six corners and no center") {
    const auto parts = part(prism(circle_outline(1, 6), 1));
    for (unsigned i = 0; i < 6; ++i) {
        const glm::dvec2 corner = on_circle(1, i, 6), next = on_circle(1, i + 1, 6);
        check_points({}, parts, {corner * 0.99, 0}, Snap::vertex, {{corner, 0}});
        check_points({}, parts, {(corner + next) * 0.495, 0}, Snap::midpoint, {{(corner + next) * 0.5, 0}},
                     1e-15);
        check_points({}, parts, {(corner * 0.75 + next * 0.25) * 0.99, 0}, Snap::edge, {});
    }
}

TEST_CASE("a coarse hole is a circle, whose corners and facets do not count") {
    for (const unsigned count : {10U, 12U, 16U}) {
        const auto parts = part(plate(2, 1, count));
        const glm::dvec2 corner = on_circle(1, 1, count), next = on_circle(1, 2, count);
        for (const Variant& variant : variants())
            for (const glm::dvec2& at : {corner, (corner + next) * 0.5, corner * 0.75 + next * 0.25}) {
                check_circle(variant, parts, {at * 1.005, 0}, {0, 0, 0}, 1);
                check_circle(variant, parts, {at * 0.995, 0}, {0, 0, 0}, 1);
            }
    }
}

TEST_CASE("a coarse cylinder has a circle, whichever way its triangles are turned") {
    scene::Geometry cylinder = prism(circle_outline(0.5, 12), 1);
    const glm::dvec2 corner = on_circle(0.5, 1, 12), facet = (corner + on_circle(0.5, 2, 12)) * 0.5;
    for (const Variant& variant : variants())
        for (const glm::dvec2& at : {corner, facet})
            check_circle(variant, part(cylinder), {at * 0.99, 0}, {0, 0, 0}, 0.5);
    for (std::size_t i = 0; i < cylinder.triangles.size(); i += 3)
        std::swap(cylinder.triangles[i].x, cylinder.triangles[i].y);
    scene::Material two_sided;
    two_sided.two_sided = true;
    for (unsigned i = 0; i < 12; ++i)
        check_circle({}, {{7, cylinder, two_sided}}, {on_circle(0.495, i, 12), 0}, {0, 0, 0}, 0.5);
}

TEST_CASE("an octagon has eight corners and no center, and a circle nine") {
    const auto octagon = part(plate(2, 1, 8)), nonagon = part(plate(2, 1, 9));
    for (unsigned i = 0; i < 8; ++i) {
        const glm::dvec2 corner = on_circle(1, i, 8), next = on_circle(1, i + 1, 8);
        check_points({}, octagon, {corner * 1.01, 0}, Snap::vertex, {{corner, 0}});
        check_points({}, octagon, {(corner + next) * 0.505, 0}, Snap::midpoint, {{(corner + next) * 0.5, 0}},
                     1e-15);
    }
    CHECK_FALSE(snapped_at({}, octagon, {on_circle(1.01, 1, 8), 0}, {Snap::center}));
    check_circle({}, nonagon, {on_circle(1.01, 1, 9), 0}, {0, 0, 0}, 1);
}

TEST_CASE("corners and facets of a coarse hole are found where they are asked for") {
    const auto parts = part(plate(2, 1, 12));
    const glm::dvec3 corner(on_circle(1, 1, 12), 0), next(on_circle(1, 2, 12), 0),
        middle = (corner + next) * 0.5;
    CHECK(snapped_at({}, parts, corner * 1.01, {Snap::vertex})->feature.points[0] == corner);
    CHECK(near(snapped_at({}, parts, middle * 1.01, {Snap::midpoint})->feature.points[0], middle));
    CHECK(snapped_at({}, parts, middle * 1.01, {Snap::edge})->feature.snap == Snap::edge);
    CHECK(snapped_at({}, parts, middle * 1.01, {Snap::center})->feature.snap == Snap::center);
}

TEST_CASE("a coarse hole is a circle if it is one in the world") {
    Outline ellipse = circle_outline(1, 10);
    for (glm::dvec2& p : ellipse) p.x /= 3;
    const auto stretched = part(ring(ellipse, square_outline(3, 10), -1, 0), scaled_by({3, 1, 1}));
    const auto squeezed = part(plate(2, 1, 16), scaled_by({0.9, 1, 1}));
    for (const Variant& variant : variants())
        for (unsigned i = 0; i < 10; ++i) {
            const auto found = snapped_at(variant, stretched, {on_circle(1.01, i, 10), 0});
            REQUIRE(found);
            CHECK(found->feature.snap == Snap::center);
            CHECK(near(found->feature.points[0], {0, 0, 0}, 1e-12));
        }
    CHECK(snapped_at({}, squeezed, {0.905, 0, 0})->feature.snap == Snap::vertex);
}

TEST_CASE("a circle with corners has at most 512 edges") {
    for (const unsigned count : {512U, 513U}) {
        scene::Geometry disc = prism(circle_outline(4, count), 1);
        for (unsigned i = 0; i < count; ++i) {
            const auto first = static_cast<unsigned>(disc.positions.size());
            for (const double size : {1.0, 1.1})
                for (const double z : {0.0, -1.0})
                    disc.positions.emplace_back(on_circle(4, i, count) * size, z);
            disc.triangles.emplace_back(first, first + 3, first + 1);
        }
        const auto found = snapped_at({}, part(with_bounds(disc)), {on_circle(3.99, 1, count), 0});
        REQUIRE(found);
        CHECK(found->feature.snap == (count == 512 ? Snap::center : Snap::vertex));
    }
}

TEST_CASE("a rounded corner has a center, and the sides beside it are straight") {
    Outline outline;
    for (unsigned i = 0; i < 24; ++i) {
        const glm::dvec2 side(i < 6 || i >= 18 ? 2 : -2, i < 12 ? 1.5 : -1.5);
        for (const unsigned at : {i, i + 1})
            if (at == i || at % 6 == 0) outline.push_back(side + on_circle(2, at, 24));
    }
    const auto parts = part(prism(outline, 1));
    for (const Variant& variant : variants())
        for (unsigned i = 0; i < 24; ++i) {
            const glm::dvec2 side(i < 6 || i >= 18 ? 2 : -2, i < 12 ? 1.5 : -1.5);
            const glm::dvec2 facet = (on_circle(2, i, 24) + on_circle(2, i + 1, 24)) * 0.495;
            check_circle(variant, parts, {side + facet, 0}, {side, 0}, 2, 1e-11);
        }
    check_points({}, parts, {3.98, 0, 0}, Snap::midpoint, {{4, 0, 0}}, 1e-15);
    check_points({}, parts, {0.7, 3.48, 0}, Snap::edge, {});
    const auto squeezed = part(prism(outline, 1), scaled_by({0.9, 1, 1}));
    CHECK(
        snapped_at({}, squeezed, {(on_circle(2, 3, 24) + glm::dvec2(2, 1.5)) * glm::dvec2(0.9, 1) * 0.995, 0})
            ->feature.snap == Snap::edge);
}

TEST_CASE("edges of several pieces are one") {
    const auto found = snapped_at({}, part(plate()), {1.98, 0.8, 0});
    REQUIRE(found);
    REQUIRE(found->feature.snap == Snap::edge);
    CHECK(glm::distance(found->feature.points[1], found->feature.points[2]) == 4);
    check_points({}, part(plate()), {1.98, 0.01, 0}, Snap::midpoint, {{2, 0, 0}});
}

TEST_CASE("an outline without corners has whole edges, wherever the mesh begins") {
    Outline outline;
    const double step = 0.5 / (0.5 + std::sqrt(0.75));
    for (unsigned side = 0; side < 4; ++side)
        for (const glm::dvec2& p :
             {glm::dvec2(2, 0), glm::dvec2(2, 1.5), glm::dvec2(2 - 0.5 * step, 1.5 + std::sqrt(0.75) * step),
              glm::dvec2(1.5, 2)}) {
            const glm::dvec2 turned = side % 2 ? glm::dvec2(-p.y, p.x) : p;
            outline.push_back(side < 2 ? turned : -turned);
        }
    scene::Geometry sheet;
    sheet.positions.assign(1, glm::dvec3(0));
    for (unsigned i = 0; i < outline.size(); ++i) {
        sheet.positions.emplace_back(outline[i], 0);
        sheet.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % outline.size());
    }
    const auto found = snapped_at({}, part(with_bounds(sheet)), {1.98, 0.5, 0});
    REQUIRE(found);
    REQUIRE(found->feature.snap == Snap::edge);
    CHECK(glm::distance(found->feature.points[1], found->feature.points[2]) == 3);
}

TEST_CASE("vertices count where a mesh is coarse, and points where it is fine") {
    const auto height = [](double u, double v) { return 0.1 * std::cos(u * 2 - 1) * std::cos(v * 2 - 1); };
    const auto bump = [&](unsigned columns) {
        return surface(columns, columns,
                       [&](double u, double v) { return glm::dvec3(4 * u - 2, 4 * v - 2, height(u, v)); });
    };
    const glm::dvec3 vertex(1, 1, height(0.75, 0.75)), near_it = vertex + glm::dvec3(0.01, 0.01, 0);
    check_points({}, part(bump(8)), near_it, Snap::vertex, {vertex});
    check_points({}, part(bump(64)), near_it, Snap::point, {});
    const auto any = snapped_at({}, part(bump(64)), near_it, {Snap::vertex});
    REQUIRE(any);
    CHECK(any->feature.points[0] == vertex);
}

TEST_CASE("among more triangles than a finger can distinguish, planes and points alone are found") {
    const auto sheet = [](unsigned columns) {
        return surface(columns, columns, [](double u, double v) { return glm::dvec3(u - 0.5, v - 0.5, 0); });
    };
    const glm::dvec3 corner(0.5, 0.5, 0), inside = corner - glm::dvec3(0.001, 0.001, 0);
    const auto snap_of = [&](unsigned columns, const std::vector<Snap>& to = {}) {
        const auto found = snapped_at({}, part(sheet(columns)), inside, to);
        return found ? std::optional(found->feature.snap) : std::nullopt;
    };
    CHECK(snap_of(200) == Snap::vertex);  // some 1,000 near
    CHECK(snap_of(1500) == Snap::plane);  // more than 20,000
    CHECK(snap_of(1500, {Snap::vertex, Snap::loop}) == std::nullopt);
    CHECK(snap_of(1500, {Snap::point}) == Snap::point);
}

TEST_CASE("only kinds that are asked for are found") {
    const auto parts = part(box({1, 1, 1}));
    const glm::dvec3 corner(0.99, 0.98, 1), middle(0.3, 0.2, 1);
    for (const Snap snap : {Snap::point, Snap::vertex, Snap::edge, Snap::loop, Snap::plane}) {
        const auto found = snapped_at({}, parts, corner, {snap});
        REQUIRE(found);
        CHECK(found->feature.snap == snap);
    }
    CHECK_FALSE(snapped_at({}, parts, corner, {Snap::midpoint, Snap::center}));
    CHECK_FALSE(
        snapped_at({}, parts, middle, {Snap::vertex, Snap::midpoint, Snap::center, Snap::edge, Snap::loop}));
    CHECK_FALSE(snapped_at({}, parts, {3, 3, 1}));
}

TEST_CASE("what is nearest to the ray is found, whatever its kind's order in the mesh") {
    for (const double x : {-0.99, 0.99})
        for (const double y : {-0.985, 0.985})
            check_points({}, part(box({1, 1, 1})), {x, y, 1}, Snap::vertex,
                         {{std::copysign(1, x), std::copysign(1, y), 1}});
    const auto thin = part(box({0.02, 1, 1}));
    check_points({}, thin, {0.016, 0.5, 1}, Snap::edge, {});
    CHECK(snapped_at({}, thin, {0.016, 0.5, 1})->feature.points[0].x == 0.02);
    CHECK(snapped_at({}, thin, {-0.016, 0.5, 1})->feature.points[0].x == -0.02);
}

TEST_CASE("the far side of a thin part is not found") {
    const auto parts = part(box({1, 1, 0.01}));
    for (const Variant& variant : variants())
        for (const double aslant : {0.0, -0.3, -2.0, 2.0}) {
            CAPTURE(variant.name);
            CAPTURE(aslant);
            const glm::dvec3 from(aslant, aslant, 5);
            for (const double x : {0.97, 0.98, 0.99}) {
                const auto corner = snapped_at(variant, parts, {x, x, 0.01}, {Snap::vertex}, from);
                if (corner)
                    CHECK(corner->feature.points[0] ==
                          glm::dvec3(1, 1, aslant > 0 ? corner->feature.points[0].z : 0.01));
                const auto edge = snapped_at(variant, parts, {x, 0.5, 0.01}, {Snap::edge}, from);
                REQUIRE(edge);
                if (aslant <= 0) CHECK(edge->feature.points[0].z == 0.01);
            }
        }
}

TEST_CASE("what is far behind the hit is not found") {
    scene::Geometry wall;
    wall.positions = {{-1, -1, 0}, {0, -1, 0}, {0, 1.3, 0}, {-1, 1.3, 0}, {0.02, 0, -1}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}};
    const auto found = snapped_at({}, part(with_bounds(wall)), {-0.01, 0, 0}, {}, {0, 0, 5});
    REQUIRE(found);
    CHECK(found->feature.snap == Snap::edge);
    CHECK(found->feature.points[0].x == 0);
}

TEST_CASE("faces that are culled hide nothing, and faces that are seen from behind do") {
    const scene::Geometry inside_out = turned_inside_out(box({1, 1, 0.05}));
    scene::Material two_sided;
    two_sided.two_sided = true;
    for (const Variant& variant : variants()) {
        CAPTURE(variant.name);
        for (const bool culled : {true, false}) {
            const std::vector<Part> parts{{7, inside_out, culled ? scene::Material() : two_sided}};
            const auto found = snapped_at(variant, parts, {0.98, 0.98, 0}, {Snap::vertex}, {0, 0, 5});
            REQUIRE(found);
            CHECK(found->feature.points[0] == glm::dvec3(1, 1, culled ? -0.05 : 0.05));
            const auto edge = snapped_at(variant, parts, {0.96, 0.5, 0}, {Snap::edge}, {-3, 0, 5});
            if (culled || edge) CHECK(edge->feature.points[0].z == (culled ? -0.05 : 0.05));
        }
    }
}

TEST_CASE("what a clip plane cuts off hides nothing") {
    const auto scene = scene_of(part(box({1, 1, 0.05})));
    const std::vector<scene::ClipPlane> cut{{{0, 0, 1}, 0}};
    const mesh::Ray ray{{0.98, 0.98, 5}, {0, 0, -1}};
    const auto hit = mesh::pick(*scene, ray, {.clip_planes = cut});
    REQUIRE(hit);
    measurement::MeshEdgesMemo memo;
    const auto found =
        measurement::snap(*scene, *hit, ray, {.radius = kRadius, .to = {}, .clip_planes = cut}, memo);
    REQUIRE(found);
    CHECK(found->feature.points[0] == glm::dvec3(1, 1, -0.05));
}

TEST_CASE("nothing beyond a clip plane is found") {
    const auto scene = scene_of(part(box({1, 1, 1})));
    const mesh::Ray ray{{0.99, 0.5, 5}, {0, 0, -1}};
    measurement::MeshEdgesMemo memo;
    const auto hit = mesh::pick(*scene, ray);
    REQUIRE(hit);
    const std::vector<scene::ClipPlane> kept{{{1, 0, 0}, 1.5}}, cut{{{1, 0, 0}, 0.995}};
    const measurement::SnapOptions with{.radius = kRadius, .to = {}, .clip_planes = kept};
    CHECK(measurement::snap(*scene, *hit, ray, with, memo)->feature.snap == Snap::edge);
    const measurement::SnapOptions without{.radius = kRadius, .to = {}, .clip_planes = cut};
    CHECK(measurement::snap(*scene, *hit, ray, without, memo)->feature.snap == Snap::plane);
}

TEST_CASE("a hit on a cap, on no node, or on a flattened part") {
    const auto scene = scene_of(part(box({1, 1, 1})));
    const mesh::Ray ray{{0.95, 0.5, 5}, {0, 0, -1}};
    measurement::MeshEdgesMemo memo;
    const mesh::Hit cap{scene->scene->find_node(7), {0.95, 0.5, 0.2}, {0, 0, 1}, 4.8};
    const auto found = measurement::snap(*scene, cap, ray, {.radius = kRadius, .to = {}}, memo);
    REQUIRE(found);
    CHECK(found->feature == measurement::Feature{7, Snap::point, {{0.95, 0.5, 0.2}}});
    CHECK_FALSE(measurement::snap(*scene, mesh::Hit(), ray, {.radius = kRadius, .to = {}}, memo));
    const mesh::Hit root{0, {0.9, 0.5, 0.2}, {0, 0, 1}, 4.8};
    CHECK_FALSE(measurement::snap(*scene, root, ray, {.radius = kRadius, .to = {}}, memo));
    CHECK_FALSE(measurement::snap(*scene, cap, ray, {.radius = NAN, .to = {}}, memo));
    for (int i = 0; i < 8; ++i) {
        const glm::dmat4 turned = turned_by(10 * i, glm::normalize(glm::dvec3(1, 2, 3)));
        const auto flat = scene_of(part(box({1, 1, 1}), turned * scaled_by({1, 1, 0}) * turned));
        CHECK_FALSE(measurement::snap(*flat, cap, ray, {.radius = kRadius, .to = {}}, memo));
    }
}

TEST_CASE("what is found is near the ray and on the part") {
    Dice dice(9);
    int found_count = 0;
    for (int round = 0; round < test::repetitions(300); ++round) {
        const std::vector<Part> parts{{7, round % 2 ? plate() : box({1, 1, 0.5}), {}, dice.matrix()}};
        const auto scene = scene_under(dice.matrix(), parts);
        const auto node = static_cast<std::size_t>(scene->scene->find_node(7));
        const glm::dvec3 target(scene->world[node] * glm::dvec4(dice.vector(1.5), 1));
        const glm::dvec3 from = target + 20.0 * glm::normalize(dice.vector(1));
        const mesh::Ray ray{from, glm::normalize(target - from)};
        const auto found = snapped(*scene, ray, kRadius);
        if (!found) continue;
        ++found_count;
        CHECK(found->offset <= kRadius * (1 + 1e-9));
        const auto& points = found->feature.points;
        REQUIRE(points.size() == measurement::point_count(found->feature.snap));
        CHECK(near(found->point, glm::dvec3(scene->world[node] * glm::dvec4(points[0], 1)), 1e-9));
        if (found->feature.snap == Snap::center) continue;
        const double along = glm::dot(found->point - from, ray.direction);
        CHECK(glm::length(found->point - from - ray.direction * along) <= kRadius * along * (1 + 1e-6));
        const auto& positions = parts[0].geometry.positions;
        if (found->feature.snap == Snap::vertex)
            CHECK(std::find(positions.begin(), positions.end(), points[0]) != positions.end());
    }
    CHECK(found_count > test::repetitions(100));
}
