#include "mesh/picking.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "io/read_scene.hpp"
#include "navigation/camera_moves.hpp"
#include "repetitions.hpp"
#include "scene/camera.hpp"

using namespace vrut;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Given as it is written in a book: row by row, the last row left out.
glm::dmat4 rows(const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& z) {
    return glm::transpose(glm::dmat4(x, y, z, {0, 0, 0, 1}));
}

glm::dmat4 moved_by(const glm::dvec3& by) { return rows({1, 0, 0, by.x}, {0, 1, 0, by.y}, {0, 0, 1, by.z}); }

glm::dmat4 scaled_by(const glm::dvec3& by) { return rows({by.x, 0, 0, 0}, {0, by.y, 0, 0}, {0, 0, by.z, 0}); }

/// About x, then about z.
glm::dmat4 turned_by(double x, double z) {
    return rows({std::cos(z), -std::sin(z), 0, 0}, {std::sin(z), std::cos(z), 0, 0}, {0, 0, 1, 0}) *
           rows({1, 0, 0, 0}, {0, std::cos(x), -std::sin(x), 0}, {0, std::sin(x), std::cos(x), 0});
}

scene::Geometry geometry_of(std::vector<glm::dvec3> positions, std::vector<glm::uvec3> triangles) {
    scene::Geometry geometry;
    geometry.positions = std::move(positions);
    geometry.triangles = std::move(triangles);
    for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
    return geometry;
}

/// In the plane z = 0, its front towards +z, the right angle at the origin.
scene::Geometry corner_triangle() { return geometry_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}); }

/// From −half to half, front outwards.
scene::Geometry box_of(const glm::dvec3& half) {
    const math::Bounds bounds{-half, half};
    const auto points = math::corners(bounds);
    return geometry_of({points.begin(), points.end()}, {{0, 4, 6},
                                                        {0, 6, 2},
                                                        {1, 3, 7},
                                                        {1, 7, 5},
                                                        {0, 1, 5},
                                                        {0, 5, 4},
                                                        {2, 6, 7},
                                                        {2, 7, 3},
                                                        {0, 2, 3},
                                                        {0, 3, 1},
                                                        {4, 5, 7},
                                                        {4, 7, 6}});
}

/// The unit sphere as a globe of meridians and parallels that share their corners; front outwards.
scene::Geometry sphere(unsigned meridians, unsigned parallels) {
    std::vector<glm::dvec3> positions{{0, 1, 0}};
    for (unsigned ring = 1; ring < parallels; ++ring) {
        for (unsigned i = 0; i < meridians; ++i) {
            const double down = std::numbers::pi * ring / parallels;
            const double around = 2 * std::numbers::pi * i / meridians;
            positions.emplace_back(std::sin(down) * std::sin(around), std::cos(down),
                                   std::sin(down) * std::cos(around));
        }
    }
    positions.emplace_back(0, -1, 0);
    const auto last = static_cast<unsigned>(positions.size() - 1);
    const auto at = [&](unsigned ring, unsigned i) {
        return ring == 0 ? 0 : ring == parallels ? last : 1 + (ring - 1) * meridians + i % meridians;
    };
    std::vector<glm::uvec3> triangles;
    for (unsigned ring = 0; ring < parallels; ++ring) {
        for (unsigned i = 0; i < meridians; ++i) {
            if (ring > 0) triangles.emplace_back(at(ring, i), at(ring + 1, i), at(ring, i + 1));
            if (ring + 1 < parallels)
                triangles.emplace_back(at(ring, i + 1), at(ring + 1, i), at(ring + 1, i + 1));
        }
    }
    return geometry_of(std::move(positions), std::move(triangles));
}

enum MaterialPlace : scene::Index { kPlain, kTwoSided, kGlass, kTwoSidedGlass, kClearGlass, kMirror };

/// Scenes of a few nodes: materials as above, nodes hang under the root unless told otherwise.
struct Builder {
    scene::SceneParts parts;

    Builder() {
        parts.materials.resize(6);
        parts.materials[kTwoSided].two_sided = parts.materials[kTwoSidedGlass].two_sided = true;
        parts.materials[kGlass].diffuse.a = parts.materials[kTwoSidedGlass].diffuse.a = 0.99;
        parts.materials[kClearGlass].diffuse.a = 0;
        parts.materials[kMirror].reflectivity = 0.01;
    }

    scene::Node& add(scene::Id id, scene::NodeType type, scene::Id parent) {
        parts.nodes.push_back({scene::Node{id, {}, type, scene::kNone, {}, true, glm::dmat4(1), {}}, parent});
        return parts.nodes.back().node;
    }
    /// Instances are made by naming the place of a geometry that is there already.
    scene::Node& add_instance(scene::Id id, scene::Index geometry, const glm::dmat4& matrix = glm::dmat4(1),
                              scene::Index material = scene::kNone, scene::Id parent = 0) {
        scene::Node& node = add(id, scene::NodeType::geometry, parent);
        node.matrix = matrix;
        node.data = scene::GeometryData{geometry, material};
        return node;
    }
    scene::Node& add(scene::Id id, scene::Geometry geometry, const glm::dmat4& matrix = glm::dmat4(1),
                     scene::Index material = scene::kNone, scene::Id parent = 0) {
        parts.geometries.push_back(std::move(geometry));
        return add_instance(id, static_cast<scene::Index>(parts.geometries.size() - 1), matrix, material,
                            parent);
    }
    scene::PlacedScene placed() const {
        auto scene = scene::Scene::build(parts);
        REQUIRE_MESSAGE(scene, scene.error().message);
        return place(*std::move(scene));
    }
};

scene::PlacedScene scene_of(scene::Geometry geometry, const glm::dmat4& matrix = glm::dmat4(1),
                            scene::Index material = kPlain) {
    Builder builder;
    builder.add(1, std::move(geometry), matrix, material);
    return builder.placed();
}

mesh::Ray ray_from(const glm::dvec3& origin, const glm::dvec3& direction) {
    return {origin, glm::normalize(direction)};
}

mesh::Ray down_z(double x, double y, double z = 5) { return {{x, y, z}, {0, 0, -1}}; }

/// The node's id; −1 where nothing is hit.
scene::Id picked_id(const scene::PlacedScene& placed, const mesh::Ray& ray,
                    bool through_transparent = false) {
    const auto hit = mesh::pick(placed, ray, {.through_transparent = through_transparent});
    return hit ? placed.scene->nodes()[static_cast<std::size_t>(hit->node)].id : -1;
}

void check_vector(const glm::dvec3& value, const glm::dvec3& expected, double tolerance) {
    for (int axis = 0; axis < 3; ++axis) {
        CAPTURE(axis);
        CHECK(std::abs(value[axis] - expected[axis]) <= tolerance);
    }
}

/// Evenly over the sphere.
glm::dvec3 random_direction(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-1, 1);
    for (;;) {
        const glm::dvec3 v(any(random), any(random), any(random));
        const double length = glm::length(v);
        if (length <= 1 && length > 0.01) return v / length;
    }
}

glm::dvec3 random_point(std::mt19937& random, const math::Bounds& box) {
    std::uniform_real_distribution<double> any(-1, 1);
    return box.center() + box.half_extent() * glm::dvec3(any(random), any(random), any(random));
}

const scene::PlacedScene& car() {
    static const scene::PlacedScene placed = [] {
        auto scene = io::read_scene(VRUT_CARS "/car-20k.vrut");
        REQUIRE_MESSAGE(scene, scene.error());
        // Without the floor around it, which few rays would miss.
        std::vector<scene::NodeState> states = scene::file_states(*scene);
        for (std::size_t i = 0; i < states.size(); ++i)
            if (scene->nodes()[i].name == "Floor shadow") states[i].active = false;
        return place(std::make_shared<const scene::Scene>(*std::move(scene)), std::move(states));
    }();
    return placed;
}

scene::PlacedScene seen_through(const glm::dmat4& matrix, scene::PlacedScene placed) {
    for (glm::dmat4& world : placed.world) world = matrix * world;
    placed.bounds = scene::subtree_bounds(placed, 0);
    return placed;
}

// The reference: Möller and Trumbore's test, in long double, over each triangle there is.

using Long = long double;
using LongVec = glm::vec<3, Long>;

/// One triangle along a ray from the origin.
struct Crossing {
    Long inside = -1;  ///< the least of the three weights: below 0 the triangle is missed
    Long distance = 0;
    bool front = false;
};

Crossing cross(const LongVec& direction, const LongVec& a, const LongVec& b, const LongVec& c) {
    const LongVec side = b - a, other = c - a;
    const LongVec p = glm::cross(direction, other);
    const Long determinant = glm::dot(side, p);
    if (determinant == 0) return {};
    const Long u = -glm::dot(a, p) / determinant;
    const LongVec q = glm::cross(-a, side);
    const Long v = glm::dot(direction, q) / determinant;
    return {std::min({u, v, 1 - u - v}), glm::dot(other, q) / determinant, determinant > 0};
}

struct Reference {
    static constexpr Long kCloseCall = 1e-9L;

    scene::Id node = -1;
    Long distance = std::numeric_limits<Long>::infinity();
    Long second = distance;  ///< of the nearest other node
    bool at_edge = false;

    /// More closely past an edge that counts, or a second node, than double can tell.
    bool close_call() const { return at_edge || (node >= 0 && second - distance < kCloseCall * distance); }

    void add(scene::Id id, const Crossing& crossing) {
        if (!(crossing.inside > -kCloseCall) || crossing.distance <= 0) return;
        if (crossing.distance <= distance && crossing.inside < kCloseCall) at_edge = true;
        if (crossing.inside < 0) return;
        if (crossing.distance < distance || (crossing.distance == distance && id > node)) {
            if (node != id) second = distance;
            distance = crossing.distance;
            node = id;
        } else if (id != node) {
            second = std::min(second, crossing.distance);
        }
    }
};

Reference reference_pick(const scene::PlacedScene& placed, const mesh::Ray& ray, bool through_transparent) {
    const std::vector<bool> shown = scene::shown_nodes(placed, ray.origin);
    Reference best;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const scene::Node& node = placed.scene->nodes()[i];
        const auto* data = std::get_if<scene::GeometryData>(&node.data);
        if (!shown[i] || !data) continue;
        const scene::Material& material = placed.scene->material(placed.nodes[i].material);
        if (through_transparent && placed.scene->is_transparent(material)) continue;
        const scene::Geometry& geometry =
            placed.scene->geometries()[static_cast<std::size_t>(data->geometry)];
        const glm::mat<4, 4, Long> world(placed.world[i]);
        const glm::mat<3, 3, Long> axes(world);
        const LongVec place = LongVec(world[3]) - LongVec(ray.origin);
        const bool mirrored = glm::determinant(axes) < 0;
        std::vector<LongVec> seen;
        for (const glm::dvec3& position : geometry.positions)
            seen.push_back(axes * LongVec(position) + place);
        for (const glm::uvec3& t : geometry.triangles) {
            const Crossing crossing = cross(LongVec(ray.direction), seen[t.x], seen[t.y], seen[t.z]);
            if (crossing.front != mirrored || material.two_sided) best.add(node.id, crossing);
        }
    }
    return best;
}

/// From outside towards somewhere in the scene, or from inside to anywhere.
mesh::Ray random_ray(std::mt19937& random, const math::Bounds& box, bool inside) {
    const glm::dvec3 point = random_point(random, box), direction = random_direction(random);
    if (inside) return {point, direction};
    const glm::dvec3 from = box.center() + direction * (1.5 * box.radius());
    return ray_from(from, point - from);
}

void check_hit(const scene::PlacedScene& placed, const mesh::Ray& ray, const mesh::Hit& hit,
               const Reference& expected) {
    const scene::Id id = placed.scene->nodes()[static_cast<std::size_t>(hit.node)].id;
    CHECK(id == expected.node);
    CHECK(std::abs(static_cast<Long>(hit.distance) - expected.distance) < 1e-9L * expected.distance);
    CHECK(hit.point == ray.origin + ray.direction * hit.distance);
    CHECK((glm::dot(hit.normal, ray.direction) <= 0 && std::abs(glm::length(hit.normal) - 1) < 1e-12));
}

/// Of the car without the floor around it.
math::Bounds aim(const scene::PlacedScene& placed) {
    const auto& nodes = placed.scene->nodes();
    const auto body =
        std::find_if(nodes.begin(), nodes.end(), [](const scene::Node& n) { return n.name == "Body"; });
    return scene::subtree_bounds(placed,
                                 body == nodes.end() ? 0 : static_cast<scene::Index>(body - nodes.begin()));
}

void compare_with_reference(const scene::PlacedScene& placed, int count, bool through_transparent) {
    std::mt19937 random(20);
    const math::Bounds box = aim(placed);
    int hits = 0, close_calls = 0;
    for (int i = 0; i < count; ++i) {
        CAPTURE(i);
        const mesh::Ray ray = random_ray(random, box, i % 3 == 0);
        const Reference expected = reference_pick(placed, ray, through_transparent);
        const auto hit = mesh::pick(placed, ray, {.through_transparent = through_transparent});
        if (expected.close_call()) {
            ++close_calls;
            continue;
        }
        REQUIRE(hit.has_value() == (expected.node >= 0));
        if (hit) check_hit(placed, ray, *hit, expected);
        hits += hit.has_value();
    }
    CHECK(hits > count / 3);
    CHECK(100 * close_calls < count);
}

mesh::Ray pixel_ray(const scene::Camera& camera, const glm::ivec2& size, const glm::ivec2& pixel) {
    const double half = std::tan(camera.fov / 2 * scene::kRadiansPerDegree);
    const double right = (2 * (pixel.x + 0.5) - size.x) / size.y * half;
    const double up = (1 - 2 * (pixel.y + 0.5) / size.y) * half;
    return ray_from(camera.eye,
                    scene::view_direction(camera) + scene::right_direction(camera) * right + camera.up * up);
}

}  // namespace

TEST_CASE("presentation is not hit, in any mode") {
    scene::SceneParts parts;
    parts.geometries = {corner_triangle()};
    for (const scene::Id id : {1, 2, 3}) {
        scene::SceneParts::PartNode part;
        part.node.id = id;
        part.node.presentation = id == 2;
        if (id != 2) part.node.data = scene::GeometryData{0, scene::kNone};
        if (id != 2) part.node.type = scene::NodeType::geometry;
        if (id == 3) part.node.matrix = moved_by({0, 0, 1});
        part.parent_id = id == 3 ? 2 : 0;
        parts.nodes.push_back(part);
    }
    auto scene = scene::Scene::build(std::move(parts));
    REQUIRE(scene);
    const scene::PlacedScene placed = scene::place(*std::move(scene));
    for (const scene::DrawMode mode : {scene::DrawMode::realistic, scene::DrawMode::stylized}) {
        const auto hit = mesh::pick(placed, {{0.2, 0.2, 5}, {0, 0, -1}}, {.mode = mode});
        REQUIRE(hit);
        CHECK(placed.scene->nodes()[static_cast<std::size_t>(hit->node)].id == 1);
        CHECK(hit->distance == 5);
    }
}

TEST_CASE("a triangle: point, normal and distance") {
    const scene::PlacedScene placed = scene_of(corner_triangle());
    const auto hit = mesh::pick(placed, down_z(0.25, 0.5));
    REQUIRE(hit);
    CHECK(placed.scene->nodes()[static_cast<std::size_t>(hit->node)].id == 1);
    CHECK(hit->distance == 5);
    CHECK(hit->point == glm::dvec3(0.25, 0.5, 0));
    CHECK(hit->normal == glm::dvec3(0, 0, 1));

    CHECK(picked_id(placed, down_z(0.51, 0.5)) == -1);
    CHECK(picked_id(placed, down_z(-0.01, 0.5)) == -1);
    CHECK(picked_id(placed, {{0.25, 0.25, 5}, {0, 0, 1}}) == -1);   // behind
    CHECK(picked_id(placed, {{0.25, 0.25, -5}, {0, 0, 1}}) == -1);  // from the back
    CHECK(picked_id(placed, {{0.25, 0.25, 0}, {0, 0, -1}}) == -1);  // on it: the distance is 0
    CHECK(picked_id(placed, {{-1, 0.25, 0}, {1, 0, 0}}) == -1);     // along its plane

    const mesh::Ray slanted = ray_from({3, 2, 7}, glm::dvec3(0.2, 0.3, 0) - glm::dvec3(3, 2, 7));
    const auto slanted_hit = mesh::pick(placed, slanted);
    REQUIRE(slanted_hit);
    check_vector(slanted_hit->point, {0.2, 0.3, 0}, 1e-14);
    CHECK(slanted_hit->distance == doctest::Approx(std::sqrt(2.8 * 2.8 + 1.7 * 1.7 + 49)).epsilon(1e-14));
}

TEST_CASE("a box from all sides, and from inside") {
    const glm::dvec3 half(1, 2, 3);
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) {
            CAPTURE(axis);
            CAPTURE(sign);
            glm::dvec3 out(0), aside(0.1, 0.2, 0.3);
            out[axis] = sign;
            aside[axis] = 0;
            const auto outside = mesh::pick(scene_of(box_of(half)), {out * 10.0 + aside, -out});
            REQUIRE(outside);
            CHECK(outside->distance == 10 - half[axis]);
            CHECK(outside->normal == out);
            CHECK(picked_id(scene_of(box_of(half)), {aside, out}) == -1);
            const auto inside = mesh::pick(scene_of(box_of(half), glm::dmat4(1), kTwoSided), {aside, out});
            REQUIRE(inside);
            CHECK(inside->distance == half[axis]);
            CHECK(inside->normal == -out);
        }
    }
}

TEST_CASE("a sphere is hit where its surface is") {
    const scene::PlacedScene placed = scene_of(sphere(128, 64), moved_by({1, 2, 3}));
    std::mt19937 random(3);
    // Between the sphere through the corners and the largest inside the facets.
    const double least = std::cos(std::numbers::pi / 128) * std::cos(std::numbers::pi / 128);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 out = random_direction(random);
        const auto hit = mesh::pick(placed, {glm::dvec3(1, 2, 3) + out * 4.0, -out});
        REQUIRE(hit);
        CHECK(4 - hit->distance <= 1 + 1e-12);
        CHECK(4 - hit->distance >= least - 1e-12);
        CHECK(glm::dot(hit->normal, out) > 0.998);
    }
}

TEST_CASE("edges and corners belong to the triangle") {
    for (const double far : {0.0, 1e7}) {
        CAPTURE(far);
        const scene::PlacedScene placed = scene_of(corner_triangle(), moved_by({far, 0, 0}));
        for (const glm::dvec2 at : {glm::dvec2(0, 0), {1, 0}, {0, 1}, {0.5, 0}, {0, 0.3}, {0.25, 0.75}}) {
            CAPTURE(at.x);
            CAPTURE(at.y);
            const auto hit = mesh::pick(placed, down_z(far + at.x, at.y));
            REQUIRE(hit);
            CHECK(hit->distance == 5);
        }
        CHECK(picked_id(placed, down_z(far + 1.0000001, 0)) == -1);
        CHECK(picked_id(placed, down_z(far, -1e-300)) == -1);
    }
    // Coordinates that double rounds: the very corner still counts, wherever the geometry has its origin.
    for (const glm::dvec3 at : {glm::dvec3(0.1, 0.7, 0.3), {1000.1, -3000.7, 0.3}, {1e7 + 0.1, 3.3, 1e7}}) {
        const scene::PlacedScene placed = scene_of(
            geometry_of({at, at + glm::dvec3(0.1, 0.03, 0), at + glm::dvec3(0.02, 0.17, 0)}, {{0, 1, 2}}));
        for (const glm::dvec3& corner : placed.scene->geometries()[0].positions)
            CHECK(picked_id(placed, {corner + glm::dvec3(0, 0, 5), {0, 0, -1}}) == 1);
    }
    // Past an edge by less than rounded products can tell: a × b is −2⁻¹⁰⁴.
    constexpr double kStep = std::numeric_limits<double>::epsilon();
    const glm::dvec3 a(1 + kStep, 1, 0), b(-1 - 2 * kStep, -1 - kStep, 0);
    CHECK(picked_id(scene_of(geometry_of({a, b, {1, -1, 0}}, {{0, 1, 2}})), down_z(0, 0)) == -1);
    CHECK(picked_id(scene_of(geometry_of({b, a, {-1, 1, 0}}, {{0, 1, 2}})), down_z(0, 0)) == 1);
    // Along a diagonal of the axes the shear is exact.
    const scene::PlacedScene box = scene_of(box_of(glm::dvec3(0.1)));
    for (const glm::dvec3& corner : math::corners(math::Bounds{glm::dvec3(-1), glm::dvec3(1)})) {
        const auto hit = mesh::pick(box, ray_from(corner * 7.0, -corner));
        REQUIRE(hit);
        CHECK(hit->distance == doctest::Approx(6.9 * std::sqrt(3)).epsilon(1e-14));
    }
}

TEST_CASE("closed bodies have no gaps") {
    std::mt19937 random(11);
    const glm::dmat4 turned = turned_by(0.7, 1.9);
    struct Case {
        scene::Geometry geometry;
        glm::dmat4 matrix;
    };
    const std::vector<Case> cases{{box_of({1, 2, 3}), glm::dmat4(1)},
                                  {sphere(24, 12), glm::dmat4(1)},
                                  {sphere(24, 12), moved_by({1e7, -2e7, 3e6}) * turned},
                                  {sphere(24, 12), scaled_by({1e-6, 2e-6, -1e-6}) * turned},
                                  {sphere(24, 12), turned * scaled_by({1e6, 1, 1e6})}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        CAPTURE(i);
        const scene::PlacedScene placed = scene_of(cases[i].geometry, cases[i].matrix, kTwoSided);
        const auto from_node = [&](const glm::dvec3& point) {
            return glm::dvec3(placed.world[1] * glm::dvec4(point, 1));
        };
        const glm::dvec3 middle = from_node({0.1, -0.2, 0.05});
        int missed = 0;
        for (int k = 0; k < 20000; ++k)
            if (!mesh::pick(placed, {middle, random_direction(random)})) ++missed;
        CHECK(missed == 0);
        // Straight at all corners, and at all edges, as closely as double can aim.
        const scene::Geometry& geometry = cases[i].geometry;
        for (const glm::uvec3& triangle : geometry.triangles) {
            const glm::dvec3 &a = geometry.positions[triangle.x], &b = geometry.positions[triangle.y];
            for (const double part : {0.0, 0.5, 0.3, 0.77})
                if (!mesh::pick(placed, ray_from(middle, from_node(a + (b - a) * part) - middle))) ++missed;
        }
        CHECK(missed == 0);
    }
}

TEST_CASE("whole numbers: an exact count of what lies under a grid of rays") {
    std::mt19937 random(5);
    std::uniform_int_distribution<int> place(0, 6);
    const auto area = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec2& p) {
        return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    };
    for (int round = 0; round < 200; ++round) {
        CAPTURE(round);
        Builder builder;
        std::vector<std::array<glm::dvec3, 3>> triangles;
        for (scene::Id id = 1; id <= 8; ++id) {
            // Levels repeat, so that higher ids win ties; some triangles have no area.
            const double height = place(random) % 4;
            const bool upright = id % 4 == 0;
            std::array<glm::dvec3, 3> points{};
            for (glm::dvec3& point : points)
                point = {place(random), place(random), upright ? place(random) : height};
            triangles.push_back(points);
            builder.add(id, geometry_of({points.begin(), points.end()}, {{0, 1, 2}}));
        }
        const scene::PlacedScene placed = builder.placed();
        for (int x = 0; x <= 12; ++x) {
            for (int y = 0; y <= 12; ++y) {
                const glm::dvec2 p(x / 2.0, y / 2.0);
                scene::Id expected = -1;
                double highest = -1;
                bool known = true;
                for (std::size_t i = 0; i < triangles.size(); ++i) {
                    const auto& [a, b, c] = triangles[i];
                    const double u = area(b, c, p), v = area(c, a, p), w = area(a, b, p);
                    if (u < 0 || v < 0 || w < 0 || u + v + w == 0) continue;
                    const double height = (a.z * u + b.z * v + c.z * w) / (u + v + w);
                    // Slanted ones are rounded: a near tie may go either way.
                    const bool slanted = a.z != b.z || a.z != c.z;
                    const double gap = std::abs(height - highest);
                    if (height >= highest) {
                        known = gap > 1e-12 || (gap == 0 && !slanted && known);
                        highest = height;
                        expected = static_cast<scene::Id>(i + 1);
                    } else if (gap <= 1e-12) {
                        known = false;
                    }
                }
                CAPTURE(x);
                CAPTURE(y);
                const auto hit = mesh::pick(placed, down_z(p.x, p.y, 10));
                REQUIRE(hit.has_value() == (expected >= 0));
                if (!hit) continue;
                CHECK(hit->distance == doctest::Approx(10 - highest).epsilon(1e-14));
                if (known) CHECK(placed.scene->nodes()[static_cast<std::size_t>(hit->node)].id == expected);
            }
        }
    }
}

TEST_CASE("the car, against the reference") {
    REQUIRE(car().scene->triangle_count() > 1000);
    compare_with_reference(car(), test::repetitions(2000), false);
    compare_with_reference(car(), test::repetitions(300), true);
    compare_with_reference(seen_through(turned_by(0.4, 2.2), car()), test::repetitions(300), false);
    compare_with_reference(seen_through(scaled_by({1, -1.5, 0.7}), car()), test::repetitions(300), false);
    compare_with_reference(seen_through(moved_by({1e7, -1e7, 3e7}), car()), test::repetitions(300), false);
    compare_with_reference(seen_through(scaled_by(glm::dvec3(1e-6)), car()), test::repetitions(300), false);
    compare_with_reference(seen_through(scaled_by(glm::dvec3(1e6)), car()), test::repetitions(300), false);
}

TEST_CASE("a picked point lies under its pixel") {
    const scene::Camera camera = navigation::home_camera(navigation::fit_target(car().bounds), 1.5);
    const glm::ivec2 size(60, 40);
    const scene::ClipRange range = scene::fit_clip_range(camera, car().bounds);
    const glm::dmat4 clip_from_world =
        math::clip_from_view(scene::projection_of(camera, 1.5), range.near, range.far) *
        scene::view_from_world(camera);
    int hits = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const auto hit = mesh::pick(car(), pixel_ray(camera, size, {x, y}));
            if (!hit) continue;
            ++hits;
            const glm::dvec4 clip = clip_from_world * glm::dvec4(hit->point, 1);
            CHECK((clip.x / clip.w + 1) / 2 * size.x == doctest::Approx(x + 0.5).epsilon(1e-9));
            CHECK((1 - clip.y / clip.w) / 2 * size.y == doctest::Approx(y + 0.5).epsilon(1e-9));
        }
    }
    CHECK(hits > 200);
}

TEST_CASE("sides are those that are drawn") {
    const mesh::Ray at_front = down_z(0.25, 0.25), at_back{{0.25, 0.25, -5}, {0, 0, 1}};
    // A mirrored matrix turns the picture, and the front stays the front.
    const std::vector<glm::dmat4> matrices{glm::dmat4(1), rows({0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}),
                                           scaled_by({1, 1, -1})};
    for (std::size_t i = 0; i < matrices.size(); ++i) {
        CAPTURE(i);
        const bool exchanged = i == 2;
        const scene::PlacedScene one = scene_of(corner_triangle(), matrices[i]);
        CHECK(picked_id(one, at_front) == (exchanged ? -1 : 1));
        CHECK(picked_id(one, at_back) == (exchanged ? 1 : -1));
        for (const scene::Index material : {kTwoSided, kTwoSidedGlass}) {
            const scene::PlacedScene both = scene_of(corner_triangle(), matrices[i], material);
            for (const mesh::Ray& ray : {at_front, at_back}) {
                const auto hit = mesh::pick(both, ray);
                REQUIRE(hit);
                CHECK(hit->distance == 5);
                CHECK(hit->normal == -ray.direction);
            }
        }
    }
    // The back of the nearer is passed.
    Builder builder;
    builder.add(1, corner_triangle(), scaled_by({1, 1, -1}));
    builder.add(2, corner_triangle(), moved_by({0, 0, -1}));
    CHECK(picked_id(builder.placed(), at_front) == 2);
}

TEST_CASE("mirrors are hit from both sides, as they are drawn, other reflective parts from the front") {
    const mesh::Ray at_front = down_z(0.25, 0.25), at_back{{0.25, 0.25, -5}, {0, 0, 1}};
    const auto id = [](const scene::PlacedScene& placed, const mesh::Ray& ray, scene::DrawMode mode) {
        const auto hit = mesh::pick(placed, ray, {.mode = mode});
        return hit ? placed.scene->nodes()[static_cast<std::size_t>(hit->node)].id : -1;
    };
    scene::Geometry curved =
        geometry_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}}, {{0, 1, 2}, {1, 3, 2}});
    const scene::PlacedScene mirror = scene_of(corner_triangle(), glm::dmat4(1), kMirror),
                             chrome = scene_of(curved, glm::dmat4(1), kMirror);
    for (const scene::DrawMode mode : {scene::DrawMode::realistic, scene::DrawMode::stylized}) {
        CHECK(id(mirror, at_front, mode) == 1);
        CHECK(id(mirror, at_back, mode) == (mode == scene::DrawMode::realistic ? 1 : -1));
        CHECK(id(chrome, at_front, mode) == 1);
        CHECK(id(chrome, at_back, mode) == -1);
    }
}

TEST_CASE("flattened parts are hit from both sides") {
    const scene::PlacedScene flat =
        scene_of(box_of({1, 2, 3}), turned_by(0.5, 0.2) * scaled_by({1, 0, 1}) * turned_by(0.1, 0));
    const glm::dvec3 normal(turned_by(0.5, 0.2)[1]);
    for (const double sign : {-1.0, 1.0}) {
        const auto hit = mesh::pick(flat, {normal * (4 * sign), normal * -sign});
        REQUIRE(hit);
        CHECK(hit->distance == doctest::Approx(4).epsilon(1e-14));
        check_vector(hit->normal, normal * sign, 1e-14);
    }
    CHECK(picked_id(scene_of(box_of({1, 2, 3}), scaled_by({1, 1, 0})), down_z(1, 2)) == 1);
    CHECK(picked_id(scene_of(box_of({1, 2, 3}), scaled_by({1, 0, 0})), down_z(0, 0)) == -1);
    CHECK(picked_id(scene_of(box_of({1, 2, 3}), scaled_by({0, 0, 0})), down_z(0, 0)) == -1);
    // As thin, but not flat: the back stays a back.
    const mesh::Ray from_below{{0.25, 0.25, -5}, {0, 0, 1}};
    CHECK(picked_id(scene_of(corner_triangle(), scaled_by({1, 1, 1e-9})), from_below) == -1);
    CHECK(picked_id(scene_of(corner_triangle(), scaled_by({1, 1, 0})), from_below) == 1);
    // A determinant of 1e-12 of the product of the axes' lengths is the limit.
    const auto skewed = [](double determinant) {
        return scene_of(corner_triangle(), rows({1, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, determinant, 0}));
    };
    CHECK(picked_id(skewed(0.99e-12), from_below) == 1);
    CHECK(picked_id(skewed(1.01e-12), from_below) == -1);
    // A sheared matrix without volume, of full-length axes.
    CHECK(picked_id(scene_of(corner_triangle(), rows({1, 0, 1, 0}, {0, 1, 1, 0}, {0, 0, 0, 0})),
                    from_below) == 1);
}

TEST_CASE("far from the origin, tiny and huge") {
    for (const double size : {1e-6, 1.0, 1e6}) {
        for (const glm::dvec3 place : {glm::dvec3(0), {1e7, -1e7, 1e7}}) {
            CAPTURE(size);
            CAPTURE(place.x);
            const glm::dmat4 matrix = moved_by(place) * scaled_by(glm::dvec3(size));
            const scene::PlacedScene placed = scene_of(corner_triangle(), matrix);
            const double above = 4 * size;
            const mesh::Ray ray = down_z(place.x + 0.25 * size, place.y + 0.25 * size, place.z + above);
            const auto hit = mesh::pick(placed, ray);
            REQUIRE(hit);
            // Seen from the ray's origin, which is rounded, nothing else is.
            CHECK(hit->distance == doctest::Approx(ray.origin.z - place.z).epsilon(1e-15));
            CHECK(hit->normal == glm::dvec3(0, 0, 1));
            CHECK(picked_id(placed, down_z(place.x - 0.25 * size, place.y + 0.25 * size, ray.origin.z)) ==
                  -1);
        }
    }
    // The geometry is far from its own origin, and its matrix brings it back.
    scene::Geometry far = corner_triangle();
    far.bounds = {};
    for (glm::dvec3& position : far.positions) {
        position += glm::dvec3(1e7);
        far.bounds.add(position);
    }
    const scene::PlacedScene back = scene_of(far, moved_by(glm::dvec3(-1e7)));
    CHECK(mesh::pick(back, down_z(0, 0, 0.001))->distance == 0.001);
    CHECK(picked_id(back, down_z(1e-9, 1e-9, 0.001)) == 1);
    CHECK(picked_id(back, down_z(-1e-9, 1e-9, 0.001)) == -1);
    // Both are far, and the geometry is not on the grid that double has there.
    scene::Geometry near_far = corner_triangle();
    near_far.bounds = {};
    for (glm::dvec3& position : near_far.positions) {
        position += glm::dvec3(5 + 1e-12);
        near_far.bounds.add(position);
    }
    const scene::PlacedScene moved = scene_of(near_far, moved_by(glm::dvec3(1e7)));
    const auto hit = mesh::pick(moved, down_z(1e7 + 5.25, 1e7 + 5.25, 1e7 + 6));
    REQUIRE(hit);
    CHECK(hit->distance == doctest::Approx(1 - 1e-12).epsilon(1e-15));
}

TEST_CASE("only what shows is hit") {
    Builder builder;
    builder.add(1, scene::NodeType::assembly, 0);
    builder.add(10, corner_triangle(), moved_by({0, 0, 2}), kPlain, 1);
    builder.add(2, scene::NodeType::switch_, 0).data = scene::SwitchData{1};
    builder.add_instance(20, 0, moved_by({0, 0, 1.5}), kPlain, 2);
    builder.add_instance(21, 0, moved_by({0, 0, 1}), kPlain, 2);
    builder.add(3, scene::NodeType::lod, 0).data = scene::LodData{{10, 20}};
    builder.add_instance(30, 0, moved_by({0, 0, 0.5}), kPlain, 3);
    builder.add_instance(31, 0, moved_by({0, 0, 0.25}), kPlain, 3);
    const auto node = [&](scene::Id id) -> scene::Node& {
        return std::find_if(builder.parts.nodes.begin(), builder.parts.nodes.end(),
                            [&](const auto& part) { return part.node.id == id; })
            ->node;
    };
    const mesh::Ray ray = down_z(0.25, 0.25);
    CHECK(picked_id(builder.placed(), ray) == 10);
    node(10).active = false;
    CHECK(picked_id(builder.placed(), ray) == 21);
    node(10).active = true;
    node(1).active = false;
    CHECK(picked_id(builder.placed(), ray) == 21);
    node(2).data = scene::SwitchData{scene::SwitchData::kAllChildren};
    CHECK(picked_id(builder.placed(), ray) == 20);
    node(2).data = scene::SwitchData{scene::SwitchData::kNoChild};
    // By the distance of the ray's origin, not of the hit.
    CHECK(picked_id(builder.placed(), down_z(0.25, 0.25, 9)) == 30);
    CHECK(picked_id(builder.placed(), down_z(0.25, 0.25, 10)) == 31);
    CHECK(picked_id(builder.placed(), down_z(0.25, 0.25, 20)) == -1);
}

TEST_CASE("of equal distances the higher id is hit") {
    for (const bool low_first : {true, false}) {
        CAPTURE(low_first);
        Builder builder;
        const glm::dmat4 matrix = moved_by({3, 1, 2}) * turned_by(0.3, 0.8);
        builder.add(low_first ? 4 : 9, sphere(16, 8), matrix, kGlass);
        builder.add_instance(low_first ? 9 : 4, 0, matrix, kPlain);
        builder.add_instance(6, 0, matrix, kPlain);
        builder.add(100, scene::NodeType::assembly, 0);
        builder.add_instance(2, 0, matrix, kTwoSided, 100);
        const scene::PlacedScene placed = builder.placed();
        std::mt19937 random(2);
        for (int i = 0; i < 500; ++i) {
            const glm::dvec3 out = random_direction(random);
            CHECK(picked_id(placed, {glm::dvec3(3, 1, 2) + out * 5.0, -out}) == 9);
            CHECK(picked_id(placed, {glm::dvec3(3, 1, 2) + out * 5.0, -out}, true) == (low_first ? 9 : 6));
            CHECK(picked_id(placed, {glm::dvec3(3, 1, 2), out}) == 2);
        }
    }
    // The higher id, but further by the least that there is.
    Builder builder;
    builder.add(1, corner_triangle(), moved_by({0, 0, 1}));
    builder.add_instance(2, 0, moved_by({0, 0, std::nextafter(1.0, 0.0)}));
    CHECK(picked_id(builder.placed(), {{0.25, 0.25, 1.5}, {0, 0, -1}}) == 1);
}

TEST_CASE("transparent parts are passed where that is asked for") {
    Builder builder;
    builder.add(1, corner_triangle(), moved_by({0, 0, 2}), kGlass);
    builder.add_instance(2, 0, moved_by({0, 0, 1}), kTwoSidedGlass);
    builder.add_instance(3, 0, glm::dmat4(1), kPlain);
    CHECK(picked_id(builder.placed(), down_z(0.25, 0.25), false) == 1);
    CHECK(picked_id(builder.placed(), down_z(0.25, 0.25), true) == 3);
    CHECK(picked_id(builder.placed(), {{0.25, 0.25, 0.5}, {0, 0, 1}}, false) == 2);
    CHECK(picked_id(builder.placed(), {{0.25, 0.25, 0.5}, {0, 0, 1}}, true) == -1);
}

TEST_CASE("clear glass, which shows nothing, is passed, but not where all faces are drawn alike") {
    Builder builder;
    builder.add(1, corner_triangle(), moved_by({0, 0, 1}), kClearGlass);
    builder.add_instance(2, 0, glm::dmat4(1), kGlass);
    const scene::PlacedScene placed = builder.placed();
    CHECK(picked_id(placed, down_z(0.25, 0.25)) == 2);
    CHECK(picked_id(placed, down_z(0.25, 0.25, 0.5)) == 2);
    CHECK(picked_id(placed, down_z(0.25, 0.25), true) == -1);
    const auto stylized = mesh::pick(placed, down_z(0.25, 0.25), {.mode = scene::DrawMode::stylized});
    REQUIRE(stylized);
    CHECK(stylized->distance == 4);
}

TEST_CASE("slivers, and triangles without area") {
    // Two slivers beside a shared edge of length 1000: what one misses the other has. Their distance is a
    // mean of the corners', whose weights are as uncertain as the sliver is thin.
    const glm::dmat4 turned = turned_by(0.4, 0.9);
    for (const double thin : {1e-4, 1e-7, 1e-10}) {
        CAPTURE(thin);
        const scene::PlacedScene slivers =
            scene_of(geometry_of({{-500, 0, 0}, {500, 0.1, 0}, {0, 0.05 + thin, 0}, {0, 0.05 - thin, 0}},
                                 {{0, 1, 2}, {1, 0, 3}}),
                     turned, kTwoSided);
        std::mt19937 random(8);
        std::uniform_real_distribution<double> any(-400, 400);
        for (int i = 0; i < 2000; ++i) {
            const double along = any(random);
            const glm::dvec3 target(turned * glm::dvec4(along, 0.05 + 0.0001 * along, 0, 1));
            const glm::dvec3 from(turned * glm::dvec4(along + any(random) * 0.001, 0.1, 3, 1));
            const auto hit = mesh::pick(slivers, ray_from(from, target - from));
            REQUIRE(hit);
            CHECK(hit->distance == doctest::Approx(glm::distance(from, target)).epsilon(1e-14 / thin));
        }
    }

    scene::Geometry none = geometry_of({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {0, 0, 0}},
                                       {{0, 0, 0}, {0, 1, 1}, {0, 1, 0}, {0, 1, 2}, {2, 0, 1}, {0, 3, 1}});
    for (const glm::dmat4& matrix : {glm::dmat4(1), turned_by(0.3, 0.1), moved_by({0.1, 0.1, 1e7})}) {
        const scene::PlacedScene placed = scene_of(none, matrix, kTwoSided);
        for (const double part : {0.0, 0.25, 0.5, 1.0}) {
            const glm::dvec3 at(placed.world[1] * glm::dvec4(2 * part, 2 * part, 0, 1));
            CHECK(picked_id(placed, {at + glm::dvec3(0, 0, 5), {0, 0, -1}}) == -1);
            CHECK(picked_id(placed, ray_from(at + glm::dvec3(1, 2, 3), {-1, -2, -3})) == -1);
        }
    }
}

TEST_CASE("nothing there, and numbers that are none") {
    CHECK_FALSE(mesh::pick(place(scene::Scene()), {}));
    CHECK(picked_id(scene_of(scene::Geometry{}), down_z(0, 0)) == -1);
    CHECK(picked_id(scene_of(geometry_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {})), down_z(0.1, 0.1)) == -1);
    Builder without;
    without.add_instance(1, scene::kNone);
    CHECK(picked_id(without.placed(), down_z(0, 0)) == -1);

    const scene::PlacedScene placed = scene_of(corner_triangle(), glm::dmat4(1), kTwoSided);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {nan, kInfinity, -kInfinity}) {
        CAPTURE(bad);
        for (int axis = 0; axis < 3; ++axis) {
            mesh::Ray ray = down_z(0.25, 0.25);
            ray.origin[axis] = bad;
            CHECK_FALSE(mesh::pick(placed, ray));
            ray = down_z(0.25, 0.25);
            ray.direction[axis] = bad;
            CHECK_FALSE(mesh::pick(placed, ray));
        }
        // A bad part hides nothing behind it.
        Builder builder;
        glm::dmat4 matrix(1);
        matrix[1][1] = bad;
        builder.add(7, corner_triangle(), matrix, kTwoSided);
        scene::Geometry broken = corner_triangle();
        broken.positions[1].x = bad;
        builder.add(8, broken, moved_by({0, 0, 1}), kTwoSided);
        broken = corner_triangle();
        broken.positions[0].z = bad;
        builder.add(9, broken, moved_by({0, 0, 1}), kTwoSided);
        builder.add(3, corner_triangle());
        CHECK(picked_id(builder.placed(), down_z(0.25, 0.25)) == 3);
    }
    CHECK_FALSE(mesh::pick(placed, {{0.25, 0.25, 5}, {0, 0, 0}}));
    // Beyond what is drawn.
    CHECK(picked_id(scene_of(corner_triangle(), moved_by({0, 0, -1e17})), down_z(0.25, 0.25)) == 1);
    CHECK(picked_id(scene_of(corner_triangle(), moved_by({0, 0, -1e19})), down_z(0.25, 0.25)) == -1);
    CHECK(picked_id(scene_of(corner_triangle(), moved_by({0, 0, -1.7e308})), down_z(0.25, 0.25, 1.7e308)) ==
          -1);
}

TEST_CASE("what is hit follows from the states of the nodes") {
    const scene::PlacedScene file = scene_of(corner_triangle(), glm::dmat4(1), kTwoSided);
    const mesh::Ray from_behind{{0.25, 0.25, -1}, {0, 0, 1}};
    const auto hit_with = [&](auto change) {
        std::vector<scene::NodeState> states = file.nodes;
        change(states[1]);
        return mesh::pick(place(file.scene, states), from_behind);
    };
    CHECK(hit_with([](scene::NodeState&) {}));
    CHECK_FALSE(hit_with([](scene::NodeState& state) { state.material = kPlain; }));
    CHECK_FALSE(hit_with([](scene::NodeState& state) { state.active = false; }));
    CHECK_FALSE(hit_with([](scene::NodeState& state) { state.matrix = moved_by({0, 0, -2}); }));
    CHECK(hit_with([](scene::NodeState& state) { state.matrix = moved_by({0, 0, 2}); })->distance == 3);
}
