#include "mesh/cut.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <random>

#include "grid_surfaces.hpp"
#include "mesh/watertight.hpp"

using namespace vrut;

namespace {

const double kNaN = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

scene::Geometry together(scene::Geometry a, const scene::Geometry& b) {
    const auto first = static_cast<unsigned>(a.positions.size());
    for (const glm::dvec3& position : b.positions) a.positions.push_back(position);
    for (const glm::uvec3& triangle : b.triangles) a.triangles.push_back(triangle + first);
    a.bounds.add(b.bounds);
    return a;
}

/// As is_watertight() wants it, whichever way the grid runs.
scene::Geometry solid(const scene::Geometry& geometry) {
    const std::atomic<bool> go_on{false};
    if (mesh::is_watertight(geometry, go_on)) return geometry;
    scene::Geometry turned = turned_inside_out(geometry);
    REQUIRE(mesh::is_watertight(turned, go_on));
    return turned;
}

scene::Geometry hollow_box() { return together(box({2, 2, 2}), turned_inside_out(box({1, 1, 1}))); }

mesh::Cut cut(const scene::Geometry& geometry, const scene::ClipPlane& plane) {
    return mesh::cut_of(geometry, scene::clip_equation(plane, glm::dmat4(1)), true);
}

double signed_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& normal) {
    return glm::dot(glm::cross(b - a, c - a), normal) / 2;
}

double cap_area(const mesh::Cut& cut, const glm::dvec3& normal) {
    double sum = 0;
    for (const glm::uvec3& t : cut.triangles)
        sum += std::abs(signed_area(cut.points[t.x], cut.points[t.y], cut.points[t.z], normal));
    return sum;
}

/// By Green's theorem.
double contour_area(const mesh::Cut& cut, const glm::dvec3& normal) {
    double sum = 0;
    for (const glm::uvec2& line : cut.contours)
        sum += signed_area(cut.points[0], cut.points[line.x], cut.points[line.y], normal);
    return sum;
}

double length_of(const mesh::Cut& cut, const std::vector<glm::uvec2>& lines, const glm::dmat4& matrix) {
    double sum = 0;
    for (const glm::uvec2& line : lines)
        sum += glm::length(glm::dmat3(matrix) * (cut.points[line.y] - cut.points[line.x]));
    return sum;
}

using Edges = std::map<std::pair<unsigned, unsigned>, int>;

void add_edge(Edges& edges, unsigned a, unsigned b) {
    if (--edges[{b, a}] >= 0) return;
    ++edges[{b, a}];
    ++edges[{a, b}];
}

Edges without_pairs(const Edges& edges) {
    Edges left;
    for (const auto& [edge, count] : edges)
        if (count != 0) left[edge] = count;
    return left;
}

/// Points that both have lines, none of no length; as many come to each as leave it.
void check_contours(const mesh::Cut& cut) {
    std::vector<int> balance(cut.points.size());
    for (const glm::uvec2& line : cut.contours) {
        CHECK(cut.points[line.x] != cut.points[line.y]);
        ++balance[line.x];
        --balance[line.y];
    }
    CHECK(std::count(balance.begin(), balance.end(), 0) == std::ptrdiff_t(balance.size()));
}

/// The cap of a solid: its edges are the contours, and its triangles cover the area within them once.
void check_cap(const mesh::Cut& cut, const glm::dvec3& normal, double slack = 1e-12) {
    check_contours(cut);
    const double area = contour_area(cut, normal);
    CHECK(area >= -slack);
    double least = 0;
    Edges edges, contours;
    for (const glm::uvec3& t : cut.triangles) {
        least = std::min(least, signed_area(cut.points[t.x], cut.points[t.y], cut.points[t.z], normal));
        for (int k = 0; k < 3; ++k) add_edge(edges, t[k], t[(k + 1) % 3]);
    }
    for (const glm::uvec2& line : cut.contours) add_edge(contours, line.x, line.y);
    CHECK(least >= -slack * area);
    CHECK(std::abs(cap_area(cut, normal) - area) <= slack * area);
    CHECK(without_pairs(edges) == without_pairs(contours));
}

double polygon_area(unsigned corners, double radius) {
    return corners * radius * radius * std::sin(2 * std::numbers::pi / corners) / 2;
}

glm::dvec3 random_direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

/// A ball with dents and bumps, seen whole from the origin.
scene::Geometry potato(unsigned seed) {
    scene::Geometry made = solid(ball(24, 16));
    std::mt19937 random(seed);
    const glm::dvec3 a = 4.0 * random_direction(random), b = 9.0 * random_direction(random);
    for (glm::dvec3& p : made.positions)
        p *= 1 + 0.3 * std::sin(glm::dot(a, p)) + 0.3 * std::sin(glm::dot(b, p));
    made.bounds = {};
    for (const glm::dvec3& p : made.positions) made.bounds.add(p);
    return made;
}

}  // namespace

TEST_CASE("caps have the areas of sections in closed form") {
    const glm::dvec3 up(0, 0, 1), x(1, 0, 0);
    const mesh::Cut square = cut(box({1, 2, 3}), {up, 0.5});
    check_cap(square, up);
    CHECK(cap_area(square, up) == doctest::Approx(8));
    CHECK(std::all_of(square.points.begin(), square.points.end(), [](auto& p) { return p.z == 0.5; }));
    const mesh::Cut other_side = cut(box({1, 2, 3}), {-up, 0.5});
    check_cap(other_side, -up);
    CHECK(other_side.points[0].z == -0.5);

    const glm::dvec3 diagonal = glm::normalize(glm::dvec3(1, 1, 1));
    const mesh::Cut hexagon = cut(box({1, 1, 1}), {diagonal, 0.0});
    check_cap(hexagon, diagonal);
    CHECK(cap_area(hexagon, diagonal) == doctest::Approx(polygon_area(6, std::sqrt(2.0))));

    const mesh::Cut disc = cut(solid(ball(40, 20)), {up, 0.0});  // through a ring of its corners
    check_cap(disc, up);
    CHECK(cap_area(disc, up) == doctest::Approx(polygon_area(40, 1)));

    const scene::Geometry ring = solid(torus(40, 20));
    const mesh::Cut annulus = cut(ring, {up, 0.0});
    check_cap(annulus, up);
    CHECK(cap_area(annulus, up) == doctest::Approx(polygon_area(40, 1.3) - polygon_area(40, 0.7)));
    const mesh::Cut discs = cut(ring, {x, 0.0});
    check_cap(discs, x);
    CHECK(cap_area(discs, x) == doctest::Approx(2 * polygon_area(20, 0.3)));

    const mesh::Cut frame = cut(hollow_box(), {up, 0.25});
    check_cap(frame, up);
    CHECK(cap_area(frame, up) == doctest::Approx(12));
}

TEST_CASE("islands in a hole have caps") {
    scene::Geometry islands = hollow_box();
    for (const double x : {-0.6, 0.0, 0.6})
        for (const double y : {-0.6, 0.0, 0.6})
            islands = together(islands, mapped(hollow_box(), 0.1, {x, y, 0.02 * x + 0.01 * y}));
    const glm::dvec3 up(0, 0, 1);
    const mesh::Cut found = cut(islands, {up, 0.05});
    check_cap(found, up);
    CHECK(cap_area(found, up) == doctest::Approx(12 + 9 * 0.12));
}

TEST_CASE("planes through corners, edges and faces leave closed contours") {
    const glm::dvec3 up(0, 0, 1);
    for (const double sign : {1.0, -1.0}) {
        const mesh::Cut face = cut(box({1, 1, 1}), {sign * up, 1.0});  // all is kept, but the face itself
        check_cap(face, sign * up);
        CHECK(cap_area(face, up) == doctest::Approx(4));
    }
    CHECK(cut(box({1, 1, 1}), {up, -1.0}).contours.empty());
    CHECK(cut(box({1, 1, 1}), {up, 2.0}).contours.empty());
    CHECK(cut(box({1, 1, 1}), {up, -2.0}).contours.empty());
    const glm::dvec3 aside = glm::normalize(glm::dvec3(1, 1, 0));
    for (const double distance : {0.0, std::sqrt(2.0), -std::sqrt(2.0)})
        check_cap(cut(box({1, 1, 1}), {aside, distance}), aside);
    CHECK(cap_area(cut(box({1, 1, 1}), {aside, 0.0}), aside) == doctest::Approx(4 * std::sqrt(2.0)));
    // Corners at whole places, planes through many of them.
    const scene::Geometry dice = together(mapped(box({1, 1, 1}), 1, {3, 0, 0}), hollow_box());
    for (int i = 0; i < 5 * 5 * 5 * 9; ++i) {
        const glm::dvec3 normal(i % 5 - 2, i / 5 % 5 - 2, i / 25 % 5 - 2);
        if (normal == glm::dvec3(0)) continue;
        CAPTURE(i);
        const mesh::Cut found = mesh::cut_of(dice, glm::dvec4(-normal, i / 125 - 4), true);
        check_cap(found, glm::normalize(normal));
    }
}

TEST_CASE("random planes through random solids") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> distance(-1, 1);
    for (unsigned i = 0; i < 300; ++i) {
        CAPTURE(i);
        const glm::dvec3 normal = random_direction(random);
        scene::Geometry geometry = potato(i);
        geometry = together(geometry, turned_inside_out(mapped(geometry, 0.5, {0, 0, 0})));
        geometry = together(geometry, mapped(solid(torus(20, 12)), 0.15, glm::dvec3(0)));
        check_cap(cut(geometry, {normal, distance(random)}), normal);
    }
}

TEST_CASE("solids that overlap have caps of their own") {
    const glm::dvec3 up(0, 0, 1);
    // The second is around the middle of one of the hole's sides, and smaller than the first.
    const scene::Geometry both = together(hollow_box(), mapped(box({1.5, 1.75, 3}), 1, {0.75, 0.5, 0}));
    const mesh::Cut found = cut(both, {up, 0.3});
    check_cap(found, up);
    CHECK(cap_area(found, up) == doctest::Approx(12 + 10.5));
}

TEST_CASE("far from the origin the digits of the positions are left") {
    std::mt19937 random(3);
    for (unsigned i = 0; i < 50; ++i) {
        CAPTURE(i);
        const glm::dvec3 normal = random_direction(random), far(1e7, -2e7, 1.5e7);
        const scene::ClipPlane here{normal, 0.1}, there{normal, 0.1 + glm::dot(normal, far)};
        const scene::Geometry geometry = potato(i);
        const mesh::Cut found = cut(mapped(geometry, 1, far), there);
        check_cap(found, normal, 1e-7);
        CHECK(cap_area(found, normal) ==
              doctest::Approx(cap_area(cut(geometry, here), normal)).epsilon(1e-6));
    }
}

TEST_CASE("without a cap there are the same contours") {
    const glm::dvec4 equation(0, 0, -2, 0.4);
    const mesh::Cut with = mesh::cut_of(hollow_box(), equation, true);
    const mesh::Cut without = mesh::cut_of(hollow_box(), equation, false);
    CHECK(with.points == without.points);
    CHECK(with.contours == without.contours);
    CHECK_FALSE(with.triangles.empty());
    CHECK(without.triangles.empty());
}

TEST_CASE("open surfaces have contours, and caps where these close") {
    const glm::dvec3 up(0, 0, 1);
    scene::Geometry sheet = box({1, 1, 1});
    sheet.triangles.erase(std::remove_if(sheet.triangles.begin(), sheet.triangles.end(),
                                         [&](const glm::uvec3& t) {
                                             return sheet.positions[t.x].x == 1 &&
                                                    sheet.positions[t.y].x == 1 &&
                                                    sheet.positions[t.z].x == 1;
                                         }),
                          sheet.triangles.end());
    CHECK(cut(sheet, {up, 0.5}).triangles.empty());
    CHECK(length_of(cut(sheet, {up, 0.5}), cut(sheet, {up, 0.5}).contours, glm::dmat4(1)) ==
          doctest::Approx(6));
    const mesh::Cut both = cut(together(sheet, mapped(box({1, 1, 1}), 1, {5, 0, 0})), {up, 0.5});
    CHECK(cap_area(both, up) == doctest::Approx(4));
    CHECK(cut(turned_inside_out(box({1, 1, 1})), {up, 0.5}).triangles.empty());  // a hole in nothing
}

TEST_CASE("hatching covers the cap's area with its spacing") {
    std::vector<glm::dmat4> matrices{
        glm::dmat4(1), scaled_by({-1, 1, 1}), scaled_by({3, 0.5, -2}),
        moved_by({1e7, 2e7, -1e7}) * turned_by(30, {1, 2, 3}) * scaled_by({1, 2, 1})};
    std::mt19937 random(5);
    const scene::Geometry geometry =
        together(potato(1), turned_inside_out(mapped(potato(1), 0.5, glm::dvec3(0))));
    for (const glm::dmat4& matrix : matrices)
        for (int i = 0; i < 10; ++i) {
            const glm::dvec3 normal = random_direction(random);
            const scene::ClipPlane plane{normal, glm::dot(normal, glm::dvec3(matrix[3])) + 0.05};
            const glm::dvec4 equation = scene::clip_equation(plane, matrix);
            mesh::Cut found = mesh::cut_of(geometry, equation, true);
            const mesh::Cut before = found;
            double area = 0;
            for (const glm::uvec3& t : found.triangles) {
                const glm::dmat3 linear(matrix);
                area += std::abs(signed_area(linear * found.points[t.x], linear * found.points[t.y],
                                             linear * found.points[t.z], normal));
            }
            const double spacing = 0.01;
            mesh::add_hatching(found, matrix, plane, spacing, i % 2 == 0);
            CHECK(found.contours == before.contours);
            CHECK(found.triangles == before.triangles);
            CHECK(length_of(found, found.hatching, matrix) * spacing == doctest::Approx(area).epsilon(0.01));
        }
}

TEST_CASE("hatching lies at multiples of its spacing in the world, at 45 degrees") {
    const scene::ClipPlane plane{{0, 0, 1}, 0.5};
    const scene::Geometry bar = box({2, 1, 1});
    for (const bool other_way : {false, true})
        for (const glm::dmat4& matrix :
             {glm::dmat4(1), moved_by({0.123, 0.456, 0}), scaled_by({-1.5, 1, 1})}) {
            mesh::Cut found = mesh::cut_of(bar, scene::clip_equation(plane, matrix), true);
            mesh::add_hatching(found, matrix, plane, 0.25, other_way);
            REQUIRE(found.hatching.size() > 10);
            for (const glm::uvec2& line : found.hatching) {
                const glm::dvec3 a(matrix * glm::dvec4(found.points[line.x], 1));
                const glm::dvec3 b(matrix * glm::dvec4(found.points[line.y], 1));
                const double sign = other_way ? -1 : 1;
                CHECK((b.y - a.y) * sign == doctest::Approx(b.x - a.x));
                const double level = (a.y * sign - a.x) * std::sqrt(0.5) / 0.25;
                CHECK(std::abs(level - std::round(level)) < 1e-9);
            }
        }
}

TEST_CASE("hatching has no more lines than it may") {
    const scene::ClipPlane plane{{0, 0, 1}, 0.5};
    for (const double spacing : {1e-5, 1e-300, 5e-324}) {
        mesh::Cut found = cut(box({1, 1, 1}), plane);
        mesh::add_hatching(found, glm::dmat4(1), plane, spacing, false);
        CHECK(found.hatching.size() > mesh::kMostHatchingLines / 2 - 2);
        CHECK(found.hatching.size() <= mesh::kMostHatchingLines + 1);
    }
    for (const double spacing : {0.0, -1.0, kNaN, kInfinity, 1e300}) {
        mesh::Cut found = cut(box({1, 1, 1}), plane);
        mesh::add_hatching(found, glm::dmat4(1), plane, spacing, false);
        CHECK(found.hatching.size() <= 1);
    }
    mesh::Cut found = cut(box({1, 1, 1}), plane), empty;
    mesh::add_hatching(found, glm::dmat4(kNaN), plane, 0.1, false);
    mesh::add_hatching(found, glm::dmat4(kInfinity), plane, 0.1, false);
    mesh::add_hatching(found, glm::dmat4(0), plane, 0.1, false);
    CHECK(found.hatching.empty());
    mesh::add_hatching(empty, glm::dmat4(1), plane, 0.1, false);
}

TEST_CASE("what is no plane cuts nothing") {
    for (const glm::dvec4& equation :
         {glm::dvec4(0), glm::dvec4(0, 0, 0, 1), glm::dvec4(kNaN), glm::dvec4(kInfinity),
          glm::dvec4(0, 0, 1, kNaN), glm::dvec4(0, 0, 1, kInfinity), glm::dvec4(1e-300, 0, 0, 1e300)})
        CHECK(mesh::cut_of(box({1, 1, 1}), equation, true).contours.empty());
    CHECK(mesh::cut_of({}, glm::dvec4(0, 0, 1, 0), true).contours.empty());
    for (const double scale : {5e-324, 1e-300, 1e300})  // of any length
        CHECK(mesh::cut_of(box({1, 1, 1}), glm::dvec4(0, 0, scale, 0), true).contours.size() == 8);
}

TEST_CASE("triangles without order, and positions that are not finite, do no harm") {
    std::mt19937 random(11);
    const std::vector<double> odd{kNaN,   kInfinity, -kInfinity, 1e308, -1e308, 1e149,
                                  5e-324, 0.0,       -0.0,       1,     1e-17,  -1e-17};
    for (unsigned round = 0; round < 400; ++round) {
        scene::Geometry soup;
        const auto count = unsigned(4 + random() % 40);
        for (unsigned i = 0; i < count; ++i) {
            glm::dvec3 position = random_direction(random);
            if (round % 2 == 1) position = glm::round(2.0 * position);
            for (int k = 0; k < 3; ++k)
                if (round % 4 == 3 && random() % 8 == 0) position[k] = odd[random() % odd.size()];
            soup.positions.push_back(position);
            soup.bounds.add(position);
        }
        for (unsigned i = 0; i < 200; ++i)
            soup.triangles.emplace_back(random() % count, random() % count, random() % count);
        const scene::ClipPlane plane{round % 2 == 1 ? glm::dvec3(0, 0, 1) : random_direction(random), 0.0};
        mesh::Cut found = cut(soup, plane);
        mesh::add_hatching(found, glm::dmat4(1), plane, 0.05, false);
        for (const glm::dvec3& point : found.points) CHECK(glm::length(point) < kInfinity);
        for (const glm::uvec3& t : found.triangles) CHECK(std::max({t.x, t.y, t.z}) < found.points.size());
    }
    scene::Geometry holed = box({1, 1, 1});
    holed.positions.push_back(glm::dvec3(kNaN));
    holed.triangles.emplace_back(0, 1, unsigned(holed.positions.size() - 1));
    CHECK(cap_area(cut(holed, {{0, 0, 1}, 0.5}), {0, 0, 1}) == doctest::Approx(4));
}
