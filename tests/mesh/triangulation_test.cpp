#include "mesh/triangulation.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

using namespace vrut;

namespace {

using Polygon = std::vector<glm::dvec3>;

glm::dvec3 area_vector(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::cross(b - a, c - a) / 2.0;
}

glm::dvec3 area_vector(const Polygon& polygon) {
    glm::dvec3 sum(0);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        sum += area_vector(polygon[0], polygon[i], polygon[i + 1]);
    return sum;
}

/// Triangles that are wound as the polygon and have its area together cover it and nothing else.
void check_cover(const Polygon& polygon) {
    const auto triangles = mesh::triangulate(polygon);
    REQUIRE(triangles.size() == polygon.size() - 2);
    const glm::dvec3 whole = area_vector(polygon);
    const double area = glm::length(whole), slack = 1e-12 * area;
    double sum = 0;
    std::vector<bool> used(polygon.size());
    for (const glm::uvec3& t : triangles) {
        const double part = glm::dot(area_vector(polygon[t.x], polygon[t.y], polygon[t.z]), whole) / area;
        CHECK(part >= -slack);
        sum += std::abs(part);
        used[t.x] = used[t.y] = used[t.z] = true;
    }
    CHECK(std::abs(sum - area) < 1e-9 * area);
    CHECK(std::count(used.begin(), used.end(), false) == 0);
}

/// The polygon, and the same the other way round, upright, and tilted.
void check_all_ways(Polygon polygon) {
    check_cover(polygon);
    Polygon turned;
    for (const glm::dvec3& p : polygon)
        turned.emplace_back(0.6 * p.x, 0.8 * p.x + 3, p.y);  // in the plane through z and (3, 4)
    check_cover(turned);
    std::reverse(polygon.begin(), polygon.end());
    check_cover(polygon);
}

glm::dvec3 at_angle(double turns, double radius) {
    const double angle = glm::two_pi<double>() * turns;
    return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

/// Seen whole from the origin: its radius is random.
Polygon random_star(unsigned corners, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> radius(0.1, 1);
    Polygon star;
    for (unsigned i = 0; i < corners; ++i) star.push_back(at_angle(double(i) / corners, radius(random)));
    return star;
}

Polygon comb(unsigned teeth) {
    Polygon polygon;
    for (unsigned i = 0; i < teeth; ++i)
        for (const glm::dvec2 step : {glm::dvec2(0, 0), glm::dvec2(0, 9), glm::dvec2(1, 9), glm::dvec2(1, 0)})
            polygon.emplace_back(2 * i + step.x, step.y, 0);
    polygon.emplace_back(2 * teeth - 1, -1, 0);
    polygon.emplace_back(0, -1, 0);
    std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

/// A band that winds around the origin some times.
Polygon spiral(unsigned corners) {
    Polygon polygon;
    for (unsigned i = 0; i < corners; ++i) polygon.push_back(at_angle(i / 40.0, 1 + i / 40.0));
    for (unsigned i = corners; i-- > 0;) polygon.push_back(at_angle(i / 40.0, 1.5 + i / 40.0));
    return polygon;
}

/// A disc with a hole, to which a cut leads: its two corners stand there twice.
Polygon keyhole(unsigned corners) {
    Polygon polygon;
    for (unsigned i = 0; i <= corners; ++i) polygon.push_back(at_angle(double(i % corners) / corners, 2));
    for (unsigned i = corners + 1; i-- > 0;) polygon.push_back(at_angle(double(i % corners) / corners, 1));
    return polygon;
}

/// Corners on straight sides.
Polygon square(unsigned corners_a_side) {
    Polygon polygon;
    for (const auto& [from, to] : {std::pair(glm::dvec3(0), glm::dvec3(1, 0, 0)),
                                   {glm::dvec3(1, 0, 0), glm::dvec3(1, 1, 0)},
                                   {glm::dvec3(1, 1, 0), glm::dvec3(0, 1, 0)},
                                   {glm::dvec3(0, 1, 0), glm::dvec3(0)}})
        for (unsigned i = 0; i < corners_a_side; ++i)
            polygon.push_back(from + (to - from) * (double(i) / corners_a_side));
    return polygon;
}

/// A polygon with holes in the plane z = 0: the outer loop, then the holes, which are wound the other way.
struct Perforated {
    std::vector<glm::dvec2> corners;
    std::vector<unsigned> hole_starts;

    void add_hole(const Polygon& counter_clockwise) {
        hole_starts.push_back(static_cast<unsigned>(corners.size()));
        for (std::size_t i = counter_clockwise.size(); i-- > 0;) corners.emplace_back(counter_clockwise[i]);
    }
};

Perforated perforated(const Polygon& outer) {
    Perforated made;
    for (const glm::dvec3& corner : outer) made.corners.emplace_back(corner);
    return made;
}

Polygon moved(Polygon polygon, const glm::dvec2& offset, double scale) {
    for (glm::dvec3& corner : polygon) corner = corner * scale + glm::dvec3(offset, 0);
    return polygon;
}

double area_of(const Perforated& polygon) {
    double sum = 0;
    for (std::size_t i = 0; i <= polygon.hole_starts.size(); ++i) {
        const unsigned first = i > 0 ? polygon.hole_starts[i - 1] : 0;
        const std::size_t end =
            i < polygon.hole_starts.size() ? polygon.hole_starts[i] : polygon.corners.size();
        Polygon loop;
        for (std::size_t k = first; k < end; ++k) loop.emplace_back(polygon.corners[k], 0);
        sum += area_vector(loop).z;
    }
    return sum;
}

void check_cover(const Perforated& polygon) {
    const auto triangles = mesh::triangulate(polygon.corners, polygon.hole_starts);
    CHECK(triangles.size() == polygon.corners.size() + 2 * polygon.hole_starts.size() - 2);
    const double area = area_of(polygon);
    double sum = 0;
    for (const glm::uvec3& t : triangles) {
        const double part =
            area_vector(glm::dvec3(polygon.corners[t.x], 0), glm::dvec3(polygon.corners[t.y], 0),
                        glm::dvec3(polygon.corners[t.z], 0))
                .z;
        CHECK(part >= -1e-12 * area);
        sum += std::abs(part);
    }
    CHECK(std::abs(sum - area) < 1e-9 * area);
}

Perforated sieve(unsigned columns, unsigned rows, unsigned corners, bool squares) {
    Perforated made = perforated({{0, 0, 0}, {columns, 0, 0}, {columns, rows, 0}, {0, rows, 0}});
    for (unsigned y = 0; y < rows; ++y)
        for (unsigned x = 0; x < columns; ++x) {
            const Polygon hole = squares ? Polygon{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}
                                         : random_star(corners, y * columns + x);
            made.add_hole(moved(hole, {x + 0.5, y + 0.5}, 0.4));
        }
    return made;
}

}  // namespace

TEST_CASE("triangles cover a polygon and nothing else") {
    check_all_ways({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    check_all_ways({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}});
    for (unsigned corners : {5U, 60U, 1000U}) {
        CAPTURE(corners);
        for (unsigned seed = 0; seed < 20; ++seed) check_all_ways(random_star(corners, seed));
        check_all_ways(comb(corners));
        check_all_ways(spiral(corners));
        check_all_ways(keyhole(corners));
        check_all_ways(square(corners));
    }
}

TEST_CASE("a polygon that is not simple has triangles, too") {
    for (unsigned corners : {3U, 4U, 5U, 100U}) {
        CHECK(mesh::triangulate(Polygon(corners, glm::dvec3(7))).size() == corners - 2);
        Polygon line, crossing;
        for (unsigned i = 0; i < corners; ++i) {
            line.emplace_back(i, 0, 0);
            crossing.push_back(at_angle(2.0 * i / corners, 1 + i % 3));
        }
        CHECK(mesh::triangulate(line).size() == corners - 2);
        CHECK(mesh::triangulate(crossing).size() == corners - 2);
    }
}

TEST_CASE("a hundred thousand corners take no minutes") {
    const Polygon star = random_star(100'000, 1);
    CHECK(mesh::triangulate(star).size() == star.size() - 2);
}

TEST_CASE("triangles cover a polygon around its holes") {
    Perforated ring = perforated(square(5));
    ring.add_hole(moved(random_star(30, 1), {0.5, 0.5}, 0.4));
    check_cover(ring);
    check_cover(sieve(1, 9, 0, true));
    check_cover(sieve(9, 1, 0, true));
    check_cover(sieve(8, 8, 0, true));
    check_cover(sieve(8, 8, 20, false));
    check_cover(sieve(30, 33, 20, false));
    Perforated toothed = perforated(comb(40));
    for (unsigned i = 0; i < 40; ++i) toothed.add_hole(moved(square(2), {2 * i + 0.25, 4}, 0.5));
    check_cover(toothed);
    for (unsigned seed = 0; seed < 200; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        Perforated star = perforated(random_star(40, seed));
        for (glm::dvec2& corner : star.corners) corner += glm::normalize(corner);
        for (const double x : {-0.5, 0.0, 0.5})
            for (const double y : {-0.5, 0.0, 0.5})
                star.add_hole(
                    moved(random_star(unsigned(3 + random() % 9), unsigned(random())), {x, y}, 0.24));
        check_cover(star);
    }
}

TEST_CASE("holes may touch the outer loop and each other") {
    const Polygon diamond{{-1, 0, 0}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}};
    Perforated chain = perforated({{-1, -2, 0}, {9, -2, 0}, {9, 2, 0}, {-1, 2, 0}});
    for (unsigned i = 0; i < 5; ++i) chain.add_hole(moved(diamond, {2.0 * i, 0}, 1));
    check_cover(chain);  // it is cut in two
    Perforated column = perforated({{-2, -1, 0}, {2, -1, 0}, {2, 9, 0}, {-2, 9, 0}});
    for (unsigned i = 0; i < 5; ++i) column.add_hole(moved(diamond, {0, 2.0 * i}, 1));
    check_cover(column);
    Perforated at_corner = perforated({{-1, 0, 0}, {3, -8, 0}, {3, 8, 0}});
    at_corner.add_hole(diamond);
    check_cover(at_corner);
}

TEST_CASE("holes of no area, outside, or of no corners do no harm") {
    Perforated points = perforated(square(2));
    points.add_hole({{0.5, 0.5, 0}});
    points.add_hole({{0.2, 0.2, 0}, {0.3, 0.8, 0}});
    points.add_hole({{0.7, 0.7, 0}, {0.7, 0.7, 0}, {0.7, 0.7, 0}});
    check_cover(points);
    Perforated outside = perforated(square(2));
    outside.add_hole(moved(square(1), {-3, 0}, 1));
    outside.add_hole({});
    CHECK(mesh::triangulate(outside.corners, outside.hole_starts).size() == 6);
    CHECK(mesh::triangulate(std::vector<glm::dvec2>(2), {}).empty());
    CHECK(mesh::triangulate(std::vector<glm::dvec2>(9), std::vector<unsigned>{3, 6}).size() <= 11);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(0, 1);
    for (int i = 0; i < 200; ++i) {  // they cross
        std::vector<glm::dvec2> soup(40);
        for (glm::dvec2& corner : soup) corner = {place(random), place(random)};
        CHECK(mesh::triangulate(soup, std::vector<unsigned>{10, 20, 30}).size() <= 44);
    }
}
