// Triangles that show their backs are culled together, and no byte of an image changes.
#include <algorithm>
#include <random>

#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

const scene::Material kPaint = material_of({0.7, 0.5, 0.3});

/// A ball with triangles that face the same way one after the other: each eighth of it has its own.
scene::Geometry ball(double radius, int rings) {
    scene::Geometry geometry = sphere(radius, rings);
    const auto eighth = [&](const glm::uvec3& triangle) {
        const glm::dvec3 middle =
            geometry.positions[triangle.x] + geometry.positions[triangle.y] + geometry.positions[triangle.z];
        return (middle.x > 0 ? 1 : 0) + (middle.y > 0 ? 2 : 0) + (middle.z > 0 ? 4 : 0);
    };
    std::ranges::stable_sort(geometry.triangles, {}, eighth);
    return geometry;
}

/// Two plates of 64 triangles each, with their fronts outside.
scene::Geometry plates() {
    scene::Geometry geometry = surface(8, 4, [](double u, double v) { return glm::dvec3(u, v, 0.5); });
    const auto count = static_cast<unsigned>(geometry.positions.size());
    for (std::size_t i = 0, end = geometry.triangles.size(); i < end; ++i) {
        const glm::uvec3 triangle = count + geometry.triangles[i];
        geometry.triangles.emplace_back(triangle.y, triangle.x, triangle.z);
    }
    for (unsigned i = 0; i < count; ++i)
        geometry.positions.push_back(geometry.positions[i] - glm::dvec3(0, 0, 1));
    for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
    return geometry;
}

/// In an order in which no triangles can be culled together.
scene::Geometry shuffled(scene::Geometry geometry) {
    std::mt19937 random(5);
    std::shuffle(geometry.triangles.begin(), geometry.triangles.end(), random);
    return geometry;
}

/// Of the parts with their triangles in order, of those drawn if nothing is culled together. The images must
/// be the same.
double share_drawn(std::vector<Part> parts, const plan::View& view) {
    RendererFixture studio;
    const scene::Image image = studio.draw(scene_of(parts), view);
    const auto drawn = static_cast<double>(studio.stats.triangles);
    for (Part& part : parts) part.geometry = shuffled(part.geometry);
    CHECK(studio.draw(scene_of(parts), view).rgba == image.rgba);
    return drawn / static_cast<double>(studio.stats.triangles);
}

}  // namespace

TEST_CASE("what shows its back is not drawn") {
    const plan::View view = view_from({1, 2, 5});
    // In buffers of its own, and in those that small geometries share.
    for (const scene::Geometry& geometry : {ball(1, 40), plates()}) {
        CAPTURE(geometry.triangles.size());
        for (const glm::dmat4& matrix :
             {glm::dmat4(1), scaled_by({-1, 1, 1}), scaled_by({1, 0.2, 1.5}), moved_by({0.4, -0.3, 1})})
            CHECK(share_drawn({{1, geometry, kPaint, matrix}}, view) < 0.9);
    }
}

TEST_CASE("what shows its back from both sides is drawn") {
    scene::Material material = kPaint;
    material.two_sided = true;
    const plan::View view = view_from({0, 0, -5});
    RendererFixture studio;
    studio.draw(scene_of({{1, quad(1), material, glm::dmat4(1)}}), view);
    CHECK(studio.stats.triangles == 2);
    studio.draw(scene_of({{1, quad(1), kPaint, glm::dmat4(1)}}), view);
    CHECK(studio.stats.triangles == 0);
}

TEST_CASE("a mirror shows the fronts that only it sees") {
    scene::Material mirror = material_of({0.1, 0.1, 0.1});
    mirror.reflectivity = 1;
    const std::vector<Part> parts{{1, quad(3), mirror, moved_by({0, 0, -2})},
                                  {2, ball(0.8, 40), kPaint, glm::dmat4(1)}};
    CHECK(share_drawn(parts, view_from({1, 2, 5})) < 0.9);
}
