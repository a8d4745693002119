#include "measurement/measure.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "near.hpp"
#include "random_parts.hpp"
#include "repetitions.hpp"
#include "solids.hpp"

using namespace vrut;
using measurement::Feature;
using measurement::Kind;
using measurement::Measured;
using measurement::Snap;

namespace {

Feature point(scene::Id node, const glm::dvec3& at) { return {node, Snap::point, {at}}; }
Feature edge(scene::Id node, const glm::dvec3& from, const glm::dvec3& to) {
    return {node, Snap::edge, {0.25 * from + 0.75 * to, from, to}};
}
Feature plane(scene::Id node, const glm::dvec3& at, const glm::dvec3& a, const glm::dvec3& b) {
    return {node, Snap::plane, {at, at + a, at + b}};
}
/// Around an axis that is z, in the node's space.
Feature circle(scene::Id node, const glm::dvec3& center, double radius) {
    return {
        node, Snap::center, {center, center + glm::dvec3(radius, 0, 0), center + glm::dvec3(0, radius, 0)}};
}

Measured measured(const scene::PlacedScene& placed, Kind kind, const std::vector<Feature>& picks) {
    measurement::MeshEdgesMemo memo;
    return measurement::measure(placed, kind, picks, memo);
}

void check_value(const Measured& measured, double expected, double size = 1) {
    CAPTURE(measured.problem);
    REQUIRE(measured.value);
    CHECK(std::abs(*measured.value - expected) <= 1e-9 * size);
    CHECK(measured.problem.empty());
}

void check_problem(const Measured& measured, const std::string& problem) {
    CHECK(measured.problem == problem);
    CHECK_FALSE(measured.value);
    CHECK_FALSE(measured.components);
    CHECK(measured.line.empty());
}

/// Two doors, 4 apart along x but for a gap, each with its own matrix, and a turned part 3.
std::vector<Part> doors() {
    return {{1, box({1, 1, 0.1}), {}, moved_by({-1.005, 0, 0})},
            {2, box({1, 1, 0.1}), {}, moved_by({1.005, 0, 0}) * turned_by(180, {0, 0, 1})},
            {3, box({1, 1, 1}), {}, moved_by({0, 5, 0}) * turned_by(30, {0, 0, 1})}};
}

}  // namespace

TEST_CASE("a distance is between the first points, wherever the scene is") {
    for (const Variant& variant : variants()) {
        CAPTURE(variant.name);
        const auto scene = scene_under(variant.matrix, doors());
        const Measured gap =
            measured(*scene, Kind::distance, {point(1, {1, 0.5, 0}), point(2, {1, -0.5, 0})});
        check_value(gap, 0.01 * variant.scale, variant.scale);
        REQUIRE(gap.components);
        CHECK(
            near(*gap.components, glm::dmat3(variant.matrix) * glm::dvec3(0.01, 0, 0), 1e-9 * variant.scale));
        REQUIRE(gap.line.size() == 2);
        CHECK(near(gap.line[0], glm::dvec3(variant.matrix * glm::dvec4(-0.005, 0.5, 0, 1)),
                   1e-8 * variant.scale));
        CHECK(near(gap.line[1], glm::dvec3(variant.matrix * glm::dvec4(0.005, 0.5, 0, 1)),
                   1e-8 * variant.scale));
        const Measured within = measured(*scene, Kind::distance, {point(3, {1, 1, 1}), point(3, {-1, 1, 1})});
        check_value(within, 2 * variant.scale, variant.scale);
        check_value(
            measured(*scene, Kind::distance, {edge(3, {1, 1, 1}, {1, 1, -1}), circle(3, {1, 1, 1}, 3)}),
            1.5 * variant.scale, variant.scale);
    }
}

TEST_CASE("parts that are far from the origin are as exact as near it") {
    const glm::dvec3 far(1e7, 3e7, -2e7);
    std::vector<Part> parts = doors();
    for (Part& part : parts) part.matrix = moved_by(far) * part.matrix;
    const auto scene = scene_of(parts);
    check_value(measured(*scene, Kind::distance, {point(1, {1, 0.25, 0.1}), point(1, {-1, 0.25, 0.1})}), 2);
    for (Part& part : parts) part.matrix = moved_by(far);
    const auto exact = scene_of(parts);
    const Measured tenth = measured(*exact, Kind::distance, {point(1, {0.1, 0, 0}), point(2, {0.2, 0, 0})});
    REQUIRE(tenth.value);
    CHECK(*tenth.value == 0.1);
    const glm::dvec3 farther = far * 1e3;
    const auto turned = scene_under(turned_by(77, glm::normalize(glm::dvec3(1, 2, -3))), doors());
    check_value(measured(*turned, Kind::length,
                         {edge(1, farther + glm::dvec3(1, 2, 2), farther - glm::dvec3(1, 2, 2))}),
                6);
}

TEST_CASE("a measure moves with its parts") {
    const auto scene = scene_of(doors());
    const std::vector<Feature> picks{point(1, {1, 1, 0}), point(2, {1, -1, 0})};
    check_value(measured(*scene, Kind::distance, picks), 0.01);
    std::vector<scene::NodeState> states = scene->nodes;
    const auto door = static_cast<std::size_t>(scene->scene->find_node(2));
    states[door].matrix = moved_by({0, 0, 3}) * states[door].matrix;
    check_value(measured(scene::place(scene->scene, states), Kind::distance, picks), std::hypot(0.01, 3));
}

TEST_CASE("a parallel distance is from a line or plane") {
    for (const Variant& variant : variants()) {
        CAPTURE(variant.name);
        const auto scene = scene_under(variant.matrix, doors());
        const double unit = variant.scale;
        const Feature side = plane(1, {1, 0.3, 0}, {0, 1, 0}, {0, 0, 1}),
                      rim = edge(1, {1, -1, 0.1}, {1, 1, 0.1});
        const Feature other_rim = edge(2, {1, -1, 0.1}, {1, 1, 0.1});
        const Feature other_side = plane(2, {1, -0.9, 0}, {0, 1, 0}, {0, 0, 1});
        for (const Feature& first : {side, rim})
            for (const Feature& second : {other_rim, other_side})
                check_value(measured(*scene, Kind::parallel, {first, second}), 0.01 * unit, unit);
        const Measured to_point = measured(*scene, Kind::parallel, {side, point(2, {-1, 0.7, 0.05})});
        check_value(to_point, 2.01 * unit, unit);
        REQUIRE(to_point.line.size() == 2);
        CHECK(near(to_point.line[0], glm::dvec3(variant.matrix * glm::dvec4(-0.005, -0.7, 0.05, 1)),
                   1e-7 * unit));
        check_value(measured(*scene, Kind::parallel, {circle(1, {0, 0, 0}, 1), circle(2, {0, 0, 5}, 2)}),
                    2.01 * unit, unit);
    }
}

TEST_CASE("what is not parallel has no distance") {
    const auto scene = scene_of(doors());
    const Feature rim = edge(1, {-1, 0, 0}, {1, 0, 0});
    const auto tilted = [](double degrees) {
        const double angle = degrees * std::numbers::pi / 180;
        return edge(1, {0, 1, 0}, {std::cos(angle), 1 + std::sin(angle), 0});
    };
    check_problem(measured(*scene, Kind::parallel, {rim, tilted(3.2)}),
                  "the two are not parallel: they are at 3.2 degrees");
    check_problem(measured(*scene, Kind::parallel, {rim, tilted(0.0102)}),
                  "the two are not parallel: they are at 0.0102 degrees");
    check_value(measured(*scene, Kind::parallel, {rim, tilted(0.0098)}), 1, 1e6);
    check_problem(measured(*scene, Kind::parallel,
                           {plane(1, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}), circle(1, {0, 0, 3}, 1)}),
                  "the two are not parallel: they are at 90 degrees");
}

TEST_CASE("an angle is between two directions") {
    for (const Variant& variant : variants()) {
        CAPTURE(variant.name);
        const auto scene = scene_under(variant.matrix, doors());
        const Feature line = edge(1, {-1, 0, 0}, {1, 0, 0}), turned = edge(3, {1, 0, 0}, {-1, 0, 0});
        const Feature upright = plane(1, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), axis = circle(3, {0, 0, 0}, 0.5);
        const Feature turned_plane = plane(3, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
        check_value(measured(*scene, Kind::angle, {line, turned}), 30);
        check_value(measured(*scene, Kind::angle, {line, line}), 0);
        check_value(measured(*scene, Kind::angle, {upright, turned_plane}), 30);
        check_value(measured(*scene, Kind::angle, {upright, turned}), 60);
        check_value(measured(*scene, Kind::angle, {turned, upright}), 60);
        check_value(measured(*scene, Kind::angle, {axis, line}), 90);
        check_value(measured(*scene, Kind::angle, {axis, upright}), 0);
    }
}

TEST_CASE("an angle of three points is at the second") {
    for (const Variant& variant : variants()) {
        CAPTURE(variant.name);
        const auto scene = scene_under(variant.matrix, doors());
        for (const double degrees : {0.0, 1e-3, 45.0, 135.0, 179.999, 180.0}) {
            const double angle = degrees * std::numbers::pi / 180;
            const Measured found = measured(*scene, Kind::angle,
                                            {point(3, {1, 0, 0}), point(3, {0, 0, 0}),
                                             point(3, {2 * std::cos(angle), 2 * std::sin(angle), 0})});
            check_value(found, degrees);
            CHECK(found.line.size() == 3);
        }
        check_problem(
            measured(*scene, Kind::angle, {point(3, {0, 0, 0}), point(3, {0, 0, 0}), point(3, {1, 0, 0})}),
            "two of its points are one: there is no angle");
    }
}

TEST_CASE("a radius is a circle's, or that through three points") {
    for (const Variant& variant : variants()) {
        CAPTURE(variant.name);
        const auto scene = scene_under(variant.matrix, doors());
        const double unit = variant.scale;
        check_value(measured(*scene, Kind::radius, {circle(3, {0.5, 1, 2}, 0.125)}), 0.125 * unit, unit);
        const Measured through =
            measured(*scene, Kind::radius,
                     {point(1, {3.005, 0, 0}), point(2, {3.005, 0, 0}), point(1, {1.005, 0, 2})});
        check_value(through, 2 * unit, unit);
        REQUIRE(through.line.size() == 2);
        check_problem(
            measured(*scene, Kind::radius, {point(3, {0, 0, 0}), point(3, {1, 1, 1}), point(3, {2, 2, 2})}),
            "its points lie on one line: there is no circle through them");
    }
}

TEST_CASE("a length is an edge's") {
    for (const Variant& variant : variants()) {
        CAPTURE(variant.name);
        const auto scene = scene_under(variant.matrix, doors());
        const Measured found = measured(*scene, Kind::length, {edge(3, {1, 1, 1}, {1, -1, 1})});
        check_value(found, 2 * variant.scale, variant.scale);
        CHECK(found.line.size() == 2);
    }
}

TEST_CASE("uneven scaling makes an ellipse of a circle, but for one in a plane that is scaled evenly") {
    const std::string broken = "its part is scaled unevenly: it is no circle any more";
    for (const double scale : {1e-3, 0.5, 1.001, 1e3}) {
        const auto flat = scene_under(scaled_by({1, 1, scale}), doors());
        check_value(measured(*flat, Kind::radius, {circle(1, {0, 0, 0}, 0.5)}), 0.5);
        const auto uneven = scene_under(scaled_by({1, scale, 1}), doors());
        check_problem(measured(*uneven, Kind::radius, {circle(1, {0, 0, 0}, 0.5)}), broken);
        check_problem(measured(*uneven, Kind::parallel, {circle(1, {0, 0, 0}, 0.5), point(1, {1, 1, 1})}),
                      broken);
        check_value(measured(*uneven, Kind::distance, {circle(1, {0, 0, 0}, 0.5), point(1, {0, 1, 0})}),
                    scale, 1e3);
        check_value(
            measured(*uneven, Kind::angle, {edge(1, {0, 0, 0}, {1, 1, 0}), edge(1, {0, 0, 0}, {1, 0, 0})}),
            std::atan(scale) * 180 / std::numbers::pi);
    }
    const auto sheared = scene_under(turned_by(30, {0, 0, 1}) * scaled_by({1, 2, 1}), doors());
    check_problem(measured(*sheared, Kind::radius, {circle(3, {0, 0, 0}, 0.5)}), broken);
}

TEST_CASE("what cannot be measured has a problem") {
    const auto scene = scene_of(doors());
    check_problem(measured(*scene, Kind::distance, {point(1, {0, 0, 0}), point(12, {0, 0, 0})}),
                  "there is no node 12");
    check_problem(measured(*scene, Kind::distance, {point(1, {0, 0, 0})}), "a distance needs 2 picks, not 1");
    check_problem(
        measured(*scene, Kind::length, {Feature{1, Snap::loop, {{0, 0, 0}, {0.5, 0, 0}, {0.7, 0, 0}}}}),
        "its edge is not in the part any more");
    check_problem(
        measured(*scene, Kind::length, {Feature{0, Snap::loop, {{0, 0, 0}, {0.5, 0, 0}, {0.7, 0, 0}}}}),
        "its edge is not in the part any more");
    check_problem(measured(*scene, Kind::distance, {point(1, {-1.5e308, 0, 0}), point(1, {1.5e308, 0, 0})}),
                  "its value lies beyond the range of numbers");
    const auto infinite =
        scene_under(scaled_by(glm::dvec3(std::numeric_limits<double>::infinity())), doors());
    check_problem(measured(*infinite, Kind::distance, {point(1, {0, 0, 0}), point(2, {0, 0, 0})}),
                  "node 1 lies beyond the range of numbers");
    const auto flat = scene_under(scaled_by({0, 1, 1}), doors());
    check_problem(
        measured(*flat, Kind::angle, {edge(1, {0, 0, 0}, {1, 0, 0}), edge(1, {0, 0, 0}, {0, 1, 0})}),
        "its part is flattened: it has no direction");
}

TEST_CASE("a measure of a hidden part has a value and no line") {
    const auto scene = scene_of(doors());
    const std::vector<Feature> picks{point(1, {1, 1, 0}), point(2, {1, -1, 0})};
    for (const scene::Id hidden : {1, 2, 3}) {
        std::vector<scene::NodeState> states = scene->nodes;
        states[static_cast<std::size_t>(scene->scene->find_node(hidden))].active = false;
        const Measured found = measured(scene::place(scene->scene, states), Kind::distance, picks);
        check_value(found, 0.01);
        CHECK(found.line.empty() == (hidden != 3));
    }
}

TEST_CASE("distances and angles are those of the points in the world") {
    Dice dice(11);
    for (int round = 0; round < test::repetitions(300); ++round) {
        std::vector<Part> parts = doors();
        for (Part& part : parts) part.matrix = dice.matrix();
        const auto scene = scene_under(dice.matrix(), parts);
        std::vector<Feature> picks;
        std::vector<glm::dvec3> at;
        for (const scene::Id id : {1, 2, 3}) {
            picks.push_back(point(id, dice.vector(2)));
            const auto node = static_cast<std::size_t>(scene->scene->find_node(id));
            at.emplace_back(scene->world[node] * glm::dvec4(picks.back().points[0], 1));
        }
        check_value(measured(*scene, Kind::distance, {picks[0], picks[1]}), glm::distance(at[0], at[1]));
        const glm::dvec3 a = glm::normalize(at[0] - at[1]), b = glm::normalize(at[2] - at[1]);
        check_value(measured(*scene, Kind::angle, picks), std::acos(glm::dot(a, b)) * 180 / std::numbers::pi,
                    1e3);
        const double area = glm::length(glm::cross(at[1] - at[0], at[2] - at[0])) / 2;
        const double radius = glm::distance(at[0], at[1]) * glm::distance(at[1], at[2]) *
                              glm::distance(at[2], at[0]) / (4 * area);
        check_value(measured(*scene, Kind::radius, picks), radius, radius * radius);
    }
}
