#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>

#include "grid_surfaces.hpp"
#include "mesh/picking.hpp"
#include "mesh/watertight.hpp"
#include "random_parts.hpp"
#include "repetitions.hpp"

using namespace vrut;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Cuts off what lies above.
const scene::ClipPlane kTop{{0, 0, 1}, 0};

bool all_solid(scene::Index /*geometry*/) { return true; }

mesh::Ray down(double x, double y, double z = 5) { return {{x, y, z}, {0, 0, -1}}; }

std::optional<mesh::Hit> picked(const std::vector<Part>& parts, const mesh::Ray& ray,
                                const std::vector<scene::ClipPlane>& planes, bool through = false) {
    return mesh::pick(*scene_of(parts), ray,
                      {.through_transparent = through, .clip_planes = planes, .is_solid = all_solid});
}

void check_cap(const std::optional<mesh::Hit>& hit, const glm::dvec3& normal, double distance) {
    REQUIRE(hit);
    CHECK(hit->normal == normal);
    CHECK(hit->distance == doctest::Approx(distance).epsilon(1e-12));
}

scene::Material white(double alpha = 1) {
    scene::Material material = material_of({1, 1, 1});
    material.diffuse.a = alpha;
    return material;
}

// The reference: windings by solid angles, and Möller and Trumbore's test, point by point.

/// How often the surface winds around the point: 1 inside, 0 outside (van Oosterom and Strackee 1983).
double winding_number(const std::vector<glm::dvec3>& positions, const scene::Geometry& geometry,
                      const glm::dvec3& point) {
    double sum = 0;
    for (const glm::uvec3& t : geometry.triangles) {
        const glm::dvec3 a = positions[t.x] - point, b = positions[t.y] - point, c = positions[t.z] - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        sum += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                              la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return sum / (4 * std::numbers::pi);
}

struct Expected {
    scene::Id id = -1;
    double distance = kInfinity, second = kInfinity;
    bool close_call = false, cap = false;

    void add(scene::Id of, double at) {
        second = std::min(second, std::max(distance, at));
        if (at > distance) return;
        distance = at;
        id = of;
    }
};

/// How far the point lies beyond the planes; below 0 it is kept.
double beyond(const std::vector<scene::ClipPlane>& planes, const glm::dvec3& point) {
    double most = -kInfinity;
    for (const scene::ClipPlane& plane : planes)
        most = std::max(most, glm::dot(plane.normal, point) - plane.distance);
    return most;
}

/// The distance at which the ray comes to what is kept, and the plane there.
std::pair<double, const scene::ClipPlane*> entry_of(const std::vector<scene::ClipPlane>& planes,
                                                    const mesh::Ray& ray) {
    if (beyond(planes, ray.origin) <= 0) return {0, nullptr};
    std::pair<double, const scene::ClipPlane*> first{kInfinity, nullptr};
    for (const scene::ClipPlane& plane : planes) {
        const double distance =
            (plane.distance - glm::dot(plane.normal, ray.origin)) / glm::dot(plane.normal, ray.direction);
        const glm::dvec3 point = ray.origin + ray.direction * distance;
        if (distance > 0 && distance < first.first && beyond(planes, point) < 1e-9)
            first = {distance, &plane};
    }
    return first;
}

/// A plane cuts the part and does not close it.
bool is_open(const std::vector<glm::dvec3>& positions, const std::vector<scene::ClipPlane>& planes,
             bool solid) {
    for (const scene::ClipPlane& plane : planes) {
        std::size_t out = 0;
        for (const glm::dvec3& position : positions) out += beyond({plane}, position) > 0;
        if (out > 0 && out < positions.size() && !(plane.caps && solid)) return true;
    }
    return false;
}

/// The part's faces along the ray, where they are kept.
void add_faces(Expected& expected, const Part& part, const std::vector<glm::dvec3>& positions,
               const std::vector<scene::ClipPlane>& planes, bool open, const mesh::Ray& ray) {
    const bool mirrored = glm::determinant(glm::dmat3(part.matrix)) < 0;
    for (const glm::uvec3& t : part.geometry.triangles) {
        const glm::dvec3 ab = positions[t.y] - positions[t.x], ac = positions[t.z] - positions[t.x];
        const glm::dvec3 p = glm::cross(ray.direction, ac), from = ray.origin - positions[t.x];
        const double determinant = glm::dot(ab, p);
        const glm::dvec3 q = glm::cross(from, ab);
        const double u = glm::dot(from, p) / determinant, v = glm::dot(ray.direction, q) / determinant;
        const double distance = glm::dot(ac, q) / determinant, inside = std::min({u, v, 1 - u - v});
        if (!(inside > -1e-9 && distance > 0)) continue;
        if (!part.material.two_sided && !open && (determinant > 0) == mirrored) continue;
        const double out = beyond(planes, ray.origin + ray.direction * distance);
        if (out > 1e-8) continue;
        expected.close_call |= inside < 1e-9 || out > -1e-8;
        expected.add(part.id, distance);
    }
}

Expected expected_pick(const std::vector<Part>& parts, const std::set<scene::Id>& solids,
                       const std::vector<scene::ClipPlane>& planes, const mesh::Ray& ray) {
    Expected expected;
    const auto [entry, plane] = entry_of(planes, ray);
    for (const Part& part : parts) {
        std::vector<glm::dvec3> positions;
        positions.reserve(part.geometry.positions.size());
        for (const glm::dvec3& position : part.geometry.positions)
            positions.emplace_back(part.matrix * glm::dvec4(position, 1));
        const bool open = is_open(positions, planes, solids.contains(part.id));
        add_faces(expected, part, positions, planes, open, ray);
        if (!plane || !plane->caps || !solids.contains(part.id)) continue;
        const double winding =
            std::abs(winding_number(positions, part.geometry, ray.origin + ray.direction * entry));
        if (winding < 0.5) continue;
        expected.close_call |= std::abs(winding - std::round(winding)) > 1e-3;
        if (expected.cap && part.id < expected.id) continue;
        expected = {part.id, entry, kInfinity, expected.close_call, true};
    }
    expected.close_call |= !expected.cap && expected.second - expected.distance < 1e-8;
    return expected;
}

std::array<std::uint64_t, 3> bits_of(const glm::dvec3& v) {
    return {std::bit_cast<std::uint64_t>(v.x), std::bit_cast<std::uint64_t>(v.y),
            std::bit_cast<std::uint64_t>(v.z)};
}

bool same_bits(const std::optional<mesh::Hit>& a, const std::optional<mesh::Hit>& b) {
    if (!a || !b) return !a && !b;
    return a->node == b->node && bits_of(a->point) == bits_of(b->point) &&
           bits_of(a->normal) == bits_of(b->normal) &&
           std::bit_cast<std::uint64_t>(a->distance) == std::bit_cast<std::uint64_t>(b->distance);
}

std::vector<Part> random_solids(Dice& dice) {
    scene::Geometry open = welded(sphere(0.8, 8));
    open.triangles.resize(open.triangles.size() / 2);
    const std::vector<scene::Geometry> geometries{box({1, 0.3, 0.6}), welded(sphere(0.9, 8)), torus(16, 10),
                                                  open};
    std::vector<Part> parts;
    for (scene::Id id = 1; id <= 12; ++id) {
        scene::Material material = white();
        material.two_sided = id % 5 == 0;
        parts.push_back(
            {id, geometries[static_cast<std::size_t>(id) % 4], material,
             moved_by(dice.vector(2)) * turned_by(dice.between(0, 360), glm::normalize(dice.vector(1))) *
                 scaled_by({dice.between(0.5, 2) * (id % 3 ? 1 : -1), 1, dice.between(1, 2)})});
    }
    return parts;
}

std::vector<scene::ClipPlane> random_planes(Dice& dice) {
    std::vector<scene::ClipPlane> planes(static_cast<std::size_t>(dice.between(1, 5)));
    for (scene::ClipPlane& plane : planes) {
        plane.normal = glm::normalize(dice.vector(1));
        plane.distance = dice.between(-0.5, 2);
        plane.caps = dice.between(0, 1) < 0.8;
    }
    return planes;
}

}  // namespace

TEST_CASE("a ray hits the cap of a part that is cut") {
    const std::vector<Part> parts{{1, box({1, 1, 1}), white()}};
    check_cap(picked(parts, down(0.3, 0.2), {{{0, 0, 1}, 0.25}}), {0, 0, 1}, 4.75);
    check_cap(picked(parts, down(0.3, 0.2, 0.5), {kTop}), {0, 0, 1}, 0.5);
    CHECK_FALSE(picked(parts, down(1.3, 0.2), {kTop}));
    CHECK(picked(parts, down(0.3, 0.2), {kTop})->point == glm::dvec3(0.3, 0.2, 0));

    const glm::dvec3 direction = glm::normalize(glm::dvec3(-1, 0, -2));
    const std::vector<scene::ClipPlane> edge{{{0, 0, 1}, 0.5}, {{1, 0, 0}, 0.25}};
    for (const double x : {0.2, 0.3}) {
        const mesh::Ray ray{glm::dvec3(x, 0.1, 0.5) - direction * 6.0, direction};
        if (x < 0.25)
            check_cap(picked(parts, ray, edge), {0, 0, 1}, 6);
        else
            check_cap(picked(parts, ray, edge), {1, 0, 0}, 6 + (x - 0.25) / -direction.x);
    }
    const std::vector<scene::ClipPlane> slab{{{0, 0, 1}, 0.001}, {{0, 0, -1}, 0.001}};
    check_cap(picked(parts, down(0.3, 0.2), slab), {0, 0, 1}, 4.999);
    CHECK_FALSE(picked(parts, down(1.3, 0.2), slab));
    CHECK_FALSE(picked(parts, down(0.3, 0.2), {{{0, 0, 1}, -0.001}, {{0, 0, -1}, -0.001}}));
}

TEST_CASE("what lies beyond a plane is passed, and picks go on to what does not") {
    const auto scene = scene_of({{1, quad(1), white(), moved_by({0, 0, 2})},
                                 {2, quad(1), white()},
                                 {3, quad(1), white(), moved_by({0, 0, -2})}});
    const auto distance = [&](const std::vector<scene::ClipPlane>& planes) {
        const auto hit = mesh::pick(*scene, down(0.3, 0.2), {.clip_planes = planes});
        return hit ? hit->distance : -1;
    };
    CHECK(distance({}) == 3);
    CHECK(distance({{{0, 0, 1}, 1}}) == 5);
    CHECK(distance({{{0, 0, 1}, -1}}) == 7);
    CHECK(distance({{{0, 0, 1}, -3}}) == -1);
    CHECK(distance({{{0, 0, 1}, 1}, {{0, 0, -1}, -0.5}}) == -1);
    CHECK(distance({{{0, 0, -1}, 1}}) == 3);
    CHECK(distance({{{0, 0, -1}, -2.5}}) == -1);
}

TEST_CASE("caps are hit of solid parts of planes that have them, from beyond only") {
    scene::Material material = white();
    material.two_sided = true;
    const auto scene = scene_of({{1, box({1, 1, 1}), material}});
    const auto distance = [&](const mesh::PickOptions& options) {
        return mesh::pick(*scene, down(0.3, 0.2), options)->distance;
    };
    const std::vector<scene::ClipPlane> capped{kTop};
    std::vector<scene::ClipPlane> bare{kTop};
    bare[0].caps = false;
    CHECK(distance({.clip_planes = capped, .is_solid = all_solid}) == 5);
    CHECK(distance({.clip_planes = bare, .is_solid = all_solid}) == 6);
    CHECK(distance({.clip_planes = capped, .is_solid = {}}) == 6);
    CHECK(distance({.clip_planes = capped, .is_solid = [](scene::Index) { return false; }}) == 6);
    const mesh::Ray up{{0.3, 0.2, -5}, {0, 0, 1}};
    CHECK(mesh::pick(*scene, up, {.clip_planes = capped, .is_solid = all_solid})->distance == 4);
    const mesh::Ray out{{0.3, 0.2, -0.5}, {0, 0, 1}};
    CHECK_FALSE(mesh::pick(*scene, out, {.clip_planes = capped, .is_solid = all_solid}));
    const std::vector<scene::ClipPlane> through_eye{{{0, 0, 1}, -0.5}};
    CHECK_FALSE(mesh::pick(*scene, out, {.clip_planes = through_eye, .is_solid = all_solid}));
    const mesh::Ray back{{0.3, 0.2, -0.5}, {0, 0, -1}};
    CHECK(mesh::pick(*scene, back, {.clip_planes = through_eye, .is_solid = all_solid})->distance == 0.5);
}

TEST_CASE("a part that a plane leaves open is hit from behind, too") {
    const std::vector<Part> parts{{1, quad(1), white(), turned_by(90, {0, 1, 0})}};
    const auto scene = scene_of(parts);
    const mesh::Ray behind{{-5, 0.2, 0.3}, {1, 0, 0}}, before{{5, 0.2, 0.3}, {-1, 0, 0}};
    const auto hits = [&](const mesh::Ray& ray, double height) {
        const std::vector<scene::ClipPlane> planes{{{0, 0, 1}, height}};
        return mesh::pick(*scene, ray, {.clip_planes = planes, .is_solid = all_solid}).has_value();
    };
    CHECK(hits(before, 2));
    CHECK_FALSE(hits(behind, 2));
    const std::vector<scene::ClipPlane> crossing{{{0, 0, 1}, 0.5}};
    const auto open = [](scene::Index) { return false; };
    CHECK(mesh::pick(*scene, behind, {.clip_planes = crossing, .is_solid = open}));
    CHECK_FALSE(hits(behind, 0.5));
}

TEST_CASE("glass has caps, which are hit even where glass is passed") {
    for (const double alpha : {0.5, 0.0})
        for (const bool through : {false, true})
            check_cap(picked({{1, box({1, 1, 1}), white(alpha)}}, down(0.3, 0.2), {kTop}, through), {0, 0, 1},
                      5);
    CHECK_FALSE(picked({{1, box({1, 1, 1}), white(0.5)}}, down(0.3, 0.2), {}, true));
    const std::vector<Part> both{{1, box({1, 1, 1}), white()},
                                 {2, quad(2), white(0.5), moved_by({0, 0, 0.5})},
                                 {3, quad(2), white(0.5), moved_by({0, 0, -0.5})}};
    check_cap(picked(both, down(0.3, 0.2), {kTop}), {0, 0, 1}, 5);
}

TEST_CASE("of caps at one point the higher id is hit") {
    for (const scene::Id box_id : {1, 3}) {
        const auto scene = scene_of({{box_id, box({1, 1, 1}), white()}, {2, torus(16, 10), white()}});
        const std::vector<scene::ClipPlane> planes{kTop};
        const auto hit = mesh::pick(*scene, down(0.9, 0.1), {.clip_planes = planes, .is_solid = all_solid});
        REQUIRE(hit);
        CHECK(scene->scene->nodes()[static_cast<std::size_t>(hit->node)].id ==
              std::max<scene::Id>(box_id, 2));
        CHECK(hit->distance == 5);
    }
}

TEST_CASE("a ray exactly along edges and corners comes into a solid once") {
    const scene::Geometry globe = welded(sphere(1, 8));
    const auto scene = scene_of({{1, globe, white()}});
    const std::vector<scene::ClipPlane> planes{{{0, 0, 1}, 0.25}};
    int caps = 0, rays = 0;
    for (const glm::dvec3& corner : globe.positions) {
        const double radius = glm::length(glm::dvec2(corner));
        if (std::abs(radius - std::sqrt(1 - 0.25 * 0.25)) < 0.02) continue;  // near the section's outline
        const auto hit =
            mesh::pick(*scene, down(corner.x, corner.y), {.clip_planes = planes, .is_solid = all_solid});
        ++rays;
        if (radius < 0.95) {
            REQUIRE(hit);
            CHECK(hit->distance == 4.75);
            ++caps;
        } else if (hit) {
            CHECK(hit->distance > 4.75);
        }
    }
    CHECK(caps > 50);
    CHECK(rays > caps);
}

TEST_CASE("far from the origin a cap is hit as near it") {
    const glm::dvec3 far(1e7, -2e7, 3e7);
    for (const double sign : {1.0, -1.0}) {
        const std::vector<Part> parts{{1, box({1, 1, 1}), white(), moved_by(far) * scaled_by({sign, 2, 1})}};
        const mesh::Ray ray{far + glm::dvec3(0.25, 1.5, 5), {0, 0, -1}};
        check_cap(picked(parts, ray, {{{0, 0, 1}, 3e7 + 0.25}}), {0, 0, 1}, 4.75);
        CHECK_FALSE(picked(parts, {far + glm::dvec3(1.25, 1.5, 5), {0, 0, -1}}, {{{0, 0, 1}, 3e7 + 0.25}}));
    }
}

TEST_CASE("picks of sections are those of windings by solid angles, with trees and without") {
    Dice dice(7);
    const int rounds = test::repetitions(60);
    int caps = 0, faces = 0, misses = 0, close_calls = 0;
    for (int round = 0; round < rounds; ++round) {
        const std::vector<Part> parts = random_solids(dice);
        const auto scene = scene_of(parts);
        const mesh::PickingTrees trees(scene->scene);
        trees.wait();
        std::set<scene::Id> solids;
        const auto is_solid = [&](scene::Index geometry) {
            const std::atomic<bool> go_on{false};
            return mesh::is_watertight(scene->scene->geometries()[static_cast<std::size_t>(geometry)], go_on);
        };
        for (const Part& part : parts)
            if (is_solid(static_cast<scene::Index>(&part - parts.data()))) solids.insert(part.id);
        REQUIRE(solids.size() == 9);
        const std::vector<scene::ClipPlane> planes = random_planes(dice);
        const auto known_solid = [&](scene::Index geometry) { return solids.contains(geometry + 1); };
        for (int i = 0; i < 100; ++i) {
            CAPTURE(round);
            CAPTURE(i);
            const glm::dvec3 from = dice.vector(i % 3 ? 8 : 2);
            const mesh::Ray ray{from, glm::normalize(dice.vector(2) - from)};
            const auto hit = mesh::pick(*scene, ray, {.clip_planes = planes, .is_solid = known_solid});
            CHECK(same_bits(
                hit,
                mesh::pick(*scene, ray, {.trees = &trees, .clip_planes = planes, .is_solid = known_solid})));
            const Expected expected = expected_pick(parts, solids, planes, ray);
            if (expected.close_call) {
                ++close_calls;
                continue;
            }
            REQUIRE(hit.has_value() == (expected.id >= 0));
            ++(!hit ? misses : expected.cap ? caps : faces);
            if (!hit) continue;
            CHECK(scene->scene->nodes()[static_cast<std::size_t>(hit->node)].id == expected.id);
            CHECK(std::abs(hit->distance - expected.distance) < 1e-9 * (1 + expected.distance));
        }
    }
    CHECK(caps > 5 * rounds);
    CHECK(faces > 15 * rounds);
    CHECK(misses > 8 * rounds);
    CHECK(close_calls < 20);
}
