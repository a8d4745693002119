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
