// Whether a mirror is seen, the GPU tells late.
#include "gl_faults.hpp"
#include "mirror_scenes.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;
using namespace vrut::mirror_scenes;

namespace {

struct HealedQueries {
    ~HealedQueries() { gl_faults::heal(); }
};

/// A mirror that is seen, one behind a wall, and before both a ball and panes that cross.
std::shared_ptr<const scene::PlacedScene> seen_and_hidden_mirrors() {
    return scene_of(
        {{1, quad(1), mirror_of(0.8), moved_by({1.2, 0, -1})},
         {2, quad(0.8), mirror_of(0.8), moved_by({-1.2, 0, -1})},
         {3, quad(1), paint({0.1, 0.7, 0.2}), moved_by({-1.2, 0, -0.8})},
         {4, sphere(0.4, 8), kRed, moved_by({0, 0, 1})},
         {5, quad(0.5), paint({0.9, 0.1, 0}, 0.5), moved_by({0.6, 0, 1}) * turned_by(30, {0, 1, 0})},
         {6, quad(0.5), paint({0, 0.1, 0.9}, 0.5), moved_by({0.6, 0, 1}) * turned_by(-30, {0, 1, 0})}});
}

plan::View mirror_view() {
    plan::View view = view_from({0.3, 0.5, 5});
    view.scene = seen_and_hidden_mirrors();
    view.selected = 6;
    return view;
}

}  // namespace

TEST_CASE("mirrors are drawn without waiting for the answer whether they are seen") {
    const HealedQueries healed;
    const plan::View view = mirror_view();
    REQUIRE(plan::plan_frame(view).scene.mirrors.size() == 2);
    scene::Image expected, image;
    plan::FrameStats stats, late;
    renderer::Renderer renderer;
    renderer.render(view, expected, stats);
    CHECK(gl_faults::query_stalls() == 0);
    gl_faults::withhold_queries();
    renderer.render(view, image, late);
    CHECK(gl_faults::query_stalls() == 0);
    CHECK(image.rgba == expected.rgba);
    // What the GPU discards later is counted only where that is not known in time.
    CHECK(late.draws > stats.draws);
}

TEST_CASE("what is drawn of a hidden mirror before the answer is not counted") {
    plan::View view = mirror_view();
    view.selected = scene::kNone;
    renderer::Renderer renderer;
    scene::Image image;
    plan::FrameStats stats;
    for (int i = 0; i < 20; ++i) {
        renderer.render(view, image, stats);
        // Opaque and glass of the picture and of one mirror, both queries, that mirror's surface.
        CHECK(stats.passes == 6);
    }
}
