#include "measurement/chain_shapes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "near.hpp"
#include "random_parts.hpp"
#include "solids.hpp"

using namespace vrut;

namespace {

/// Points of an arc in the plane of x and y, at equal steps.
std::vector<glm::dvec3> arc(double degrees, unsigned steps, double radius = 1) {
    std::vector<glm::dvec3> points;
    for (unsigned i = 0; i <= steps; ++i) {
        const double angle = degrees * std::numbers::pi / 180 * i / steps;
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    if (degrees == 360) points.back() = points.front();
    return points;
}

std::vector<glm::dvec3> mapped(std::vector<glm::dvec3> points, const glm::dmat4& matrix) {
    for (glm::dvec3& point : points) point = glm::dvec3(matrix * glm::dvec4(point, 1));
    return points;
}

bool is_circle(const std::vector<glm::dvec3>& points) { return measurement::fit_circle(points).has_value(); }

}  // namespace

TEST_CASE("an exact circle is found exactly, wherever it lies") {
    Dice dice(1);
    for (const double degrees : {360.0, 300.0, 90.0, 31.0})
        for (int round = 0; round < 20; ++round) {
            const double radius = std::pow(10, dice.between(-3, 3));
            const glm::dvec3 center = dice.vector(radius);
            const glm::dmat4 matrix =
                moved_by(center) * turned_by(dice.between(0, 360), glm::normalize(dice.vector(1)));
            const auto points = mapped(arc(degrees, 24, radius), matrix);
            const auto circle = measurement::fit_circle(points);
            CAPTURE(degrees);
            REQUIRE(circle);
            const double rounding = radius * (degrees < 90 ? 1e-10 : 1e-12);
            CHECK(near((*circle)[0], center, rounding));
            CHECK(near((*circle)[1], points[0], rounding));
            CHECK(near((*circle)[2], glm::dvec3(matrix * glm::dvec4(0, radius, 0, 1)), rounding));
        }
}

TEST_CASE("a circle has at least 5 points, more than 30 degrees, and one sense") {
    CHECK(is_circle(arc(60, 4)));
    CHECK_FALSE(is_circle(arc(60, 3)));
    CHECK(is_circle(arc(30.1, 8)));
    CHECK_FALSE(is_circle(arc(29.9, 8)));
    CHECK(is_circle(arc(360, 10)));
    CHECK_FALSE(is_circle(arc(360, 5)));
    CHECK_FALSE(is_circle({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}}));
    CHECK_FALSE(is_circle(std::vector<glm::dvec3>(9, glm::dvec3(3))));
    std::vector<glm::dvec3> back = arc(180, 12);
    std::swap(back[4], back[5]);
    CHECK_FALSE(is_circle(back));
}

TEST_CASE("points are on the circle within 1e-4 of its radius") {
    for (const int axis : {0, 2})
        for (const auto& [offset, found] : {std::pair(5e-5, true), std::pair(5e-4, false)}) {
            std::vector<glm::dvec3> points = arc(360, 32);
            points[0][axis] += offset;
            points.back() = points[0];
            CHECK(is_circle(points) == found);
        }
    CHECK_FALSE(is_circle(mapped(arc(360, 32), scaled_by({1, 1.001, 1}))));
}

TEST_CASE("an arc in a chain is found from each of its edges, whole") {
    for (const double degrees : {40.0, 90.0, 270.0})
        for (const unsigned steps : {4U, 9U, 100U}) {
            if (degrees > 90 && steps == 4) continue;
            std::vector<glm::dvec3> chain = arc(degrees, steps);
            const glm::dvec3 out = glm::cross(chain.back(), glm::dvec3(0, 0, -1));
            chain.insert(chain.begin(), {{1, -5, 0}, {1, -2, 0}});
            for (const double length : {2, 5}) chain.push_back(chain[steps + 2] + out * length);
            for (std::size_t edge = 0; edge + 1 < chain.size(); ++edge) {
                CAPTURE(degrees);
                CAPTURE(steps);
                CAPTURE(edge);
                const auto run = measurement::arc_around_edge(chain, edge);
                REQUIRE(run.has_value() == (edge >= 2 && edge < steps + 2));
                if (run) CHECK((run->first == 2 && run->last == steps + 2));
            }
        }
}

TEST_CASE("an arc in a chain has 5 points, more than 30 degrees, and one radius") {
    std::vector<glm::dvec3> chain = arc(90, 9);
    chain.pop_back();
    for (const glm::dvec3& point : arc(90, 9, 2)) chain.emplace_back(-point.y, point.x - 1, 0);
    for (const std::size_t edge : {0U, 8U}) CHECK(measurement::arc_around_edge(chain, edge)->last == 9);
    for (const std::size_t edge : {9U, 17U}) CHECK(measurement::arc_around_edge(chain, edge)->first >= 9);
    CHECK_FALSE(measurement::arc_around_edge(arc(60, 3), 1));
    CHECK_FALSE(measurement::arc_around_edge(arc(29.9, 8), 4));
    CHECK(measurement::arc_around_edge(arc(30.1, 8), 4));
}

TEST_CASE("straight runs are as long as they can be") {
    const std::vector<glm::dvec3> chain{{0, 0, 0}, {1, 0, 0}, {3, 0, 0},    {3.5, 0, 0},
                                        {4, 1, 0}, {5, 2, 0}, {6.5, 3.5, 0}};
    const auto runs = measurement::straight_runs(chain, 0);
    REQUIRE(runs.size() == 3);
    CHECK((runs[0].first == 0 && runs[0].last == 3));
    CHECK((runs[1].first == 3 && runs[1].last == 4));
    CHECK((runs[2].first == 4 && runs[2].last == 6));
}

TEST_CASE("no point of a run is off by more than is allowed, however fine the curve") {
    std::vector<glm::dvec3> curve;
    for (int i = 0; i <= 200; ++i) {
        const double angle = 5e-4 * i;
        curve.emplace_back(1e4 * std::sin(angle), 1e4 * (1 - std::cos(angle)), 0);
    }
    constexpr double kRounding = 0.12;
    for (const auto& run : measurement::straight_runs(curve, kRounding)) {
        const glm::dvec3 along = glm::normalize(curve[run.last] - curve[run.first]);
        for (std::size_t i = run.first; i <= run.last; ++i)
            CHECK(glm::length(glm::cross(along, curve[i] - curve[run.first])) < 1.05 * kRounding);
    }
}

TEST_CASE("a run does not turn back, nor around a circle") {
    const std::vector<glm::dvec3> back{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}};
    CHECK(measurement::straight_runs(back, 0).size() == 2);
    CHECK(measurement::straight_runs(arc(360, 100), 0).size() == 100);
    std::vector<glm::dvec3> rounded{{0, 0, 0}, {1, 1e-5, 0}, {2, 0, 0}};
    CHECK(measurement::straight_runs(rounded, 0).size() == 2);
    CHECK(measurement::straight_runs(rounded, 2e-5).size() == 1);
}
