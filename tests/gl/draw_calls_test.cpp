// Opaque parts that differ in nothing but attributes of an instance are drawn together, and look as ever.
#include <random>

#include "gl_faults.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

/// Turned boxes with normals, in materials that take turns; some mirrored by their matrices. `padding`:
/// triangles without area that each has besides.
std::vector<Part> boxes(int count, std::size_t padding) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> anywhere(-8, 8), any(0, 1);
    std::vector<Part> parts;
    for (int i = 0; i < count; ++i) {
        scene::Geometry geometry = sphere(0.3 + 0.2 * any(random), 3);
        geometry.triangles.resize(geometry.triangles.size() + padding, glm::uvec3(0));
        scene::Material material = material_of({any(random), any(random), any(random)},
                                               glm::dvec3(0.5 * any(random)), 20 * any(random));
        material.emission = {0.1 * any(random), 0, 0, 1};
        const glm::dvec3 place(anywhere(random), anywhere(random), anywhere(random) - 8);
        const glm::dvec3 scale(i < count / 20 ? -1 : 1, 1 + any(random), 1);
        parts.push_back({i + 1, std::move(geometry), material,
                         moved_by(place) * turned_by(360 * any(random), {1, 2, 3}) * scaled_by(scale)});
    }
    return parts;
}

/// Calls that draw it.
int draw_calls(RendererFixture& studio, const std::shared_ptr<const scene::PlacedScene>& scene,
               const plan::View& view, scene::Image& image) {
    const int before = gl_faults::draw_calls();
    image = studio.draw(scene, view);
    return gl_faults::draw_calls() - before;
}

}  // namespace

TEST_CASE("thousands of small parts are drawn in few calls, as they are drawn one by one") {
    constexpr int kParts = 3000;
    RendererFixture studio;
    // Geometries of so many triangles share no buffers.
    const auto together = scene_of(boxes(kParts, 0)), alone = scene_of(boxes(kParts, 300));
    plan::View view = view_from({0, 2, 9});
    view.width = view.height = 300;
    plan::View lit_at_vertices = view, from_a_point = view;
    lit_at_vertices.methods.light = plan::Methods::Lighting::vertex;
    from_a_point.light.headlight = false;
    from_a_point.light.position = {3, 4, 5};
    for (const plan::View& shown : {view, lit_at_vertices, from_a_point}) {
        scene::Image image, expected;
        CHECK(draw_calls(studio, together, shown, image) < 60);
        const int draws = studio.stats.draws;
        CHECK(draws > kParts / 2);
        CHECK(draw_calls(studio, alone, shown, expected) == studio.stats.draws);
        CHECK(studio.stats.draws == draws);
        CHECK(image.rgba == expected.rgba);
    }
}
