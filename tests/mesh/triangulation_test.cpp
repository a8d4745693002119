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
