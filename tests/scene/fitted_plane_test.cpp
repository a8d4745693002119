#include "scene/fitted_plane.hpp"

#include <doctest/doctest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "scene/scene.hpp"

using namespace vrut;

namespace {

scene::Geometry geometry_of(std::vector<glm::dvec3> positions, std::vector<glm::uvec3> triangles) {
    scene::Geometry geometry;
    geometry.positions = std::move(positions);
    geometry.triangles = std::move(triangles);
    for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
    return geometry;
}

/// A square of side 2 around `center`, turned about the x axis; its last corner is lifted off its plane.
scene::Geometry sheet(double degrees, const glm::dvec3& center, double lifted = 0) {
    const double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
    std::vector<glm::dvec3> positions{{-1, -c, -s}, {1, -c, -s}, {1, c, s}, {-1, c, s}};
    positions[3] += lifted * glm::dvec3(0, -s, c);
    for (glm::dvec3& position : positions) position += center;
    return geometry_of(positions, {{0, 1, 2}, {0, 2, 3}});
}

bool same(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
    return glm::distance(a, b) <= tolerance;
}

}  // namespace

TEST_CASE("a flat sheet has its plane, wherever it lies and however it is tilted") {
    for (const double degrees : {0.0, 30.0, 89.0, 135.0})
        for (const glm::dvec3& center : {glm::dvec3(0), glm::dvec3(1e7, -1e7, 3e6)}) {
            const auto plane = scene::fitted_plane(sheet(degrees, center));
            REQUIRE(plane);
            const double angle = glm::radians(degrees);
            CHECK(same(plane->normal, {0, -std::sin(angle), std::cos(angle)}, 1e-7));
            CHECK(std::abs(plane->distance(center)) < 1e-7);
        }
}

TEST_CASE("the limit is 1e-4 of the radius, from the fitted plane") {
    // Lifted by h, the corner is h / 2 off the plane that fits best, more off one of equal weights.
    const double radius = std::sqrt(2.0);
    CHECK(scene::fitted_plane(sheet(0, {0, 0, 0}, 1e-4 * radius)));
    CHECK_FALSE(scene::fitted_plane(sheet(0, {0, 0, 0}, 4e-4 * radius)));
}

TEST_CASE(
    "what spans any space has no plane, and a sheet within the limit has one, however its corners lie") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> across(-1, 1);
    for (int round = 0; round < 200; ++round) {
        // Heights of both signs, so that they do not tilt the plane.
        const double height = round % 2 == 0 ? 0.5e-4 : 0.2;
        std::vector<glm::dvec3> positions;
        std::vector<glm::uvec3> triangles;
        for (unsigned i = 0; i < 300; ++i) {
            positions.emplace_back(across(random), across(random), i % 2 == 0 ? height : -height);
            if (i >= 2) triangles.emplace_back(i - 2, i - 1, i);
        }
        const auto plane = scene::fitted_plane(geometry_of(positions, triangles));
        CHECK(plane.has_value() == (round % 2 == 0));
    }
}

TEST_CASE("triangles without area do not count, and a sheet with two faces has a plane") {
    const scene::Geometry point_first =
        geometry_of({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {0, 2, 3}});
    REQUIRE(scene::fitted_plane(point_first));
    CHECK(same(scene::fitted_plane(point_first)->normal, {0, 0, 1}));
    const scene::Geometry two_faces = geometry_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}});
    REQUIRE(scene::fitted_plane(two_faces));
    CHECK(std::abs(scene::fitted_plane(two_faces)->normal.z) == doctest::Approx(1));
}

TEST_CASE("vertices that no triangle uses do not count") {
    const scene::Geometry geometry =
        geometry_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 0.5}}, {{0, 1, 2}});
    REQUIRE(scene::fitted_plane(geometry));
    CHECK(same(scene::fitted_plane(geometry)->normal, {0, 0, 1}));
}

TEST_CASE("what is no sheet has no plane") {
    CHECK_FALSE(scene::fitted_plane(scene::Geometry()));
    CHECK_FALSE(scene::fitted_plane(geometry_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}})));
    // A corner: three faces at right angles.
    CHECK_FALSE(scene::fitted_plane(
        geometry_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}})));
}

TEST_CASE("a plane goes with its points through a matrix, and a matrix that collapses it leaves none") {
    const math::Plane plane{glm::normalize(glm::dvec3(1, 2, -1)), {3, 1, 0}};
    const glm::dvec3 u = glm::normalize(glm::cross(plane.normal, glm::dvec3(0, 0, 1)));
    const glm::dvec3 v = glm::cross(plane.normal, u);
    glm::dmat4 skewed(1);
    skewed[1] = {0.5, -2, 0.1, 0};
    skewed[3] = {10, 20, -5, 1};
    const auto moved = math::transformed(skewed, plane);
    REQUIRE(moved);
    CHECK(glm::length(moved->normal) == doctest::Approx(1));
    for (const glm::dvec3& point : {plane.point, plane.point + u, plane.point - 3.0 * v})
        CHECK(std::abs(moved->distance(glm::dvec3(skewed * glm::dvec4(point, 1)))) < 1e-12);

    const math::Plane floor{{0, 0, 1}, {0, 0, 0}};
    CHECK(math::transformed(glm::scale(glm::dmat4(1), {1, 1, 0}), floor));
    CHECK_FALSE(math::transformed(glm::scale(glm::dmat4(1), {1, 0, 1}), floor));
    CHECK_FALSE(math::transformed(glm::dmat4(0), floor));
}

TEST_CASE("a reflection keeps the plane, swaps its sides and undoes itself") {
    const math::Plane plane{glm::normalize(glm::dvec3(1, 2, -1)), {3, 1, 0}};
    const glm::dmat4 reflection = math::reflection_about(plane);
    const glm::dvec3 point(4, -2, 7);
    const glm::dvec3 image(reflection * glm::dvec4(point, 1));
    CHECK(same(image, point - 2 * plane.distance(point) * plane.normal));
    CHECK(plane.distance(image) == doctest::Approx(-plane.distance(point)));
    CHECK(same(glm::dvec3(reflection * glm::dvec4(image, 1)), point));
    CHECK(same(glm::dvec3(reflection * glm::dvec4(plane.point, 1)), plane.point));
    CHECK(glm::determinant(reflection) == doctest::Approx(-1));
}
