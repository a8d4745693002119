#include "random_parts.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

const scene::Material kPaint = material_of({0.7, 0.5, 0.3});

}  // namespace

TEST_CASE("edges and the selection are left out with their faces, and nothing is drawn for them") {
    RendererFixture studio;
    plan::View view = view_from({0, 0, 5});
    view.selected = 1;
    const auto scene =
        scene_of({{1, quad(1), kPaint, moved_by({30, 0, 0})}, {2, quad(1), kPaint, glm::dmat4(1)}});
    view.mode = plan::DrawMode::stylized;
    studio.draw(scene, view);
    CHECK(studio.stats.draws == 2);
    CHECK(studio.stats.passes == 2);
    CHECK(studio.stats.uploads == 2);
    view.wireframe = true;
    studio.draw(scene, view);
    CHECK(studio.stats.draws == 1);
    CHECK(studio.stats.passes == 1);
}

TEST_CASE("the picture is the same from within a crowd, at the sizes that a scene can have") {
    RendererFixture studio;
    Dice dice(11);
    for (const double scale : {1e-6, 1.0, 1e6}) {
        CAPTURE(scale);
        std::vector<Part> parts = random_parts(dice, kPaint);
        for (Part& part : parts) part.matrix = scaled_by(glm::dvec3(scale)) * part.matrix;
        plan::View view = view_from(dice.vector(2) * scale, dice.vector(5) * scale);
        CHECK(studio.check(scene_of(parts), view).surfaces > 300);
        CHECK(studio.stats.draws < 30);
    }
}
