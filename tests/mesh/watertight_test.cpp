#include "mesh/watertight.hpp"

#include <doctest/doctest.h>

#include "grid_surfaces.hpp"

using namespace vrut;

namespace {

const std::atomic<bool> kGoOn{false};

scene::Geometry together(scene::Geometry a, const scene::Geometry& b, const glm::dvec3& offset) {
    const auto first = static_cast<unsigned>(a.positions.size());
    for (const glm::dvec3& position : b.positions) a.positions.push_back(position + offset);
    for (const glm::uvec3& triangle : b.triangles) a.triangles.push_back(triangle + first);
    return a;
}

scene::Geometry inside_out(scene::Geometry geometry) {
    for (glm::uvec3& triangle : geometry.triangles) std::swap(triangle.y, triangle.z);
    return geometry;
}

bool closed(const scene::Geometry& geometry) { return mesh::is_watertight(geometry, kGoOn); }

/// As seen from outside, whichever way the grid runs.
scene::Geometry solid_ball() {
    const scene::Geometry made = ball(12, 8);
    return closed(made) ? made : inside_out(made);
}

}  // namespace

TEST_CASE("a surface is closed where it has an inside and all triangles face away from it") {
    const scene::Geometry whole = solid_ball();  // its seam and poles have several vertices in one place
    CHECK(closed(whole));
    CHECK_FALSE(closed(inside_out(whole)));
    CHECK(closed(torus(12, 8)) != closed(inside_out(torus(12, 8))));
    CHECK_FALSE(closed(scene::Geometry{}));
    CHECK(closed(welded(sphere(1, 8))));
    CHECK_FALSE(closed(corrugated(8, 8)));
    scene::Geometry open = whole, turned = whole, doubled = whole;
    open.triangles.erase(open.triangles.begin() + 50);
    CHECK_FALSE(closed(open));
    std::swap(turned.triangles[50].x, turned.triangles[50].y);
    CHECK_FALSE(closed(turned));
    doubled.triangles.push_back(doubled.triangles[50]);
    CHECK_FALSE(closed(doubled));
    scene::Geometry sheet = open;
    sheet.triangles = {whole.triangles[50], whole.triangles[50]};
    std::swap(sheet.triangles[1].x, sheet.triangles[1].y);
    CHECK_FALSE(closed(sheet));  // no volume
    const std::atomic<bool> stop{true};
    CHECK_FALSE(mesh::is_watertight(whole, stop));
}

TEST_CASE("a surface that crosses itself is not closed: its backs can be seen from outside") {
    // A tube in the shape of an 8: its two halves are wound against each other where it is flat.
    const auto tube = [](double crossing) {
        return surface(48, 12, [=](double u, double v) {
            const double a = 2 * std::numbers::pi * u, b = 2 * std::numbers::pi * v;
            const glm::dvec3 center(2 * std::sin(a), std::sin(2 * a), crossing * std::cos(a));
            const glm::dvec3 along =
                glm::normalize(glm::dvec3(2 * std::cos(a), 2 * std::cos(2 * a), -crossing * std::sin(a)));
            const glm::dvec3 up(0, 0, 1), aside = glm::normalize(glm::cross(along, up));
            return center + 0.3 * (std::cos(b) * aside + std::sin(b) * glm::cross(aside, along));
        });
    };
    const auto either = [](const scene::Geometry& geometry) {
        return closed(welded(geometry)) || closed(inside_out(welded(geometry)));
    };
    CHECK(either(tube(1)));        // it passes over itself
    CHECK_FALSE(either(tube(0)));  // and through itself
    // A ball of which one corner is pushed out through the other side, so that it is inside out there.
    scene::Geometry pushed = welded(sphere(1, 12));
    CHECK(closed(pushed));
    const glm::dvec3 corner = pushed.positions[pushed.positions.size() / 2];
    for (glm::dvec3& position : pushed.positions)
        if (position == corner) position = -1.5 * corner;
    CHECK_FALSE(closed(pushed));
    // Two that cross each other are closed: behind each back is a front of its own.
    CHECK(closed(together(solid_ball(), solid_ball(), {0.5, 0.3, 0.1})));
    // Flat faces of many triangles do not cross.
    scene::Geometry bar = box({1, 0.5, 0.25});
    CHECK(closed(bar));
}

TEST_CASE("every piece of a closed surface is") {
    const scene::Geometry whole = solid_ball();
    CHECK(closed(together(whole, whole, {3, 0, 0})));
    CHECK_FALSE(closed(together(whole, inside_out(whole), {3, 0, 0})));
    CHECK_FALSE(closed(together(whole, whole, {0, 0, 0})));  // four triangles at each edge
    // They touch in a point.
    scene::Geometry tip;
    tip.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    tip.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    scene::Geometry other = inside_out(tip);
    for (glm::dvec3& position : other.positions) position *= -0.5;  // turns it once more
    CHECK(closed(tip));
    CHECK(closed(together(tip, other, {0, 0, 0})));
    CHECK_FALSE(closed(together(tip, inside_out(other), {0, 0, 0})));
}
