// Images are drawn in steps: they may take turns, and no step does more than so much.
#include "plan/cut_cache.hpp"
#include "plan/draw_budget.hpp"
#include "plan/frame_plan.hpp"
#include "plan/transparency_cache.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

scene::Material glass(double red, double alpha) {
    scene::Material material = material_of({red, 0.5, 0.9});
    material.diffuse.a = alpha;
    material.two_sided = true;
    return material;
}

/// So many that a sample takes several steps, for each way in which glass is drawn: sorted, layered, and both
/// in a mirror.
std::shared_ptr<const scene::PlacedScene> much_glass(double red) {
    scene::Material mirror = material_of({0.2, 0.2, 0.2});
    mirror.reflectivity = 0.8;
    std::vector<Part> parts{{1, quad(3), mirror, moved_by({0, 0, -3})}};
    for (int i = 0; i < 2000; ++i)
        parts.push_back({2 + i, quad(1), glass(red, 0.05), moved_by({0, 0, 0.0003 * i})});
    for (int i = 0; i < 40; ++i)
        parts.push_back({3000 + i, quad(1), glass(i % 2, 0.5),
                         moved_by({0, 0, -1.5}) * turned_by(4.5 * i, {0, 1, 0}) * moved_by({0, 0.01, 0})});
    return scene_of(parts);
}

plan::View view_of(const std::shared_ptr<const scene::PlacedScene>& scene, const glm::dvec3& eye) {
    plan::View view = view_from(eye);
    view.scene = scene;
    view.samples = 2;
    view.width = 160;
    view.height = 120;
    return view;
}

}  // namespace

TEST_CASE("an ordinary image takes a step for each sample") {
    RendererFixture studio;
    plan::View view = view_from({1, 2, 5});
    view.scene = scene_of({{1, sphere(1, 12), material_of({0.7, 0.5, 0.3}), glm::dmat4(1)}});
    view.samples = 4;
    const scene::Image expected = studio.draw(view.scene, view);
    plan::RenderJob rendering(view);
    for (int sample = 1; sample <= 4; ++sample) {
        CHECK(studio.renderer().step(rendering) == (sample == 4));
        CHECK(rendering.samples == sample);
        CHECK(rendering.stats.draws == sample);
        CHECK(rendering.stats.readbacks == sample);
    }
    CHECK(rendering.image.rgba == expected.rgba);
}

TEST_CASE(
    "an image goes on to more samples from those that are drawn, and is the one that is drawn at once") {
    RendererFixture studio;
    plan::View view = view_of(much_glass(0.1), {1, 2, 5});
    view.samples = 1;
    plan::RenderJob job(view, {}, plan::RenderJob::Keep::samples);
    for (const int samples : {1, 1, 4, 16}) {
        CAPTURE(samples);
        const int before = job.samples;
        if (before > 0) job.refine(samples, {});
        while (!studio.renderer().step(job)) CHECK(job.samples < samples);
        CHECK(job.stats.samples == samples - before);
        view.samples = samples;
        CHECK(job.image.rgba == studio.draw(view.scene, view).rgba);
        job.image = {};  // handed on
    }
}

TEST_CASE("images that are drawn in turns are those that are drawn alone, and no sample is drawn twice") {
    RendererFixture studio;
    const auto scene = much_glass(0.1), other = much_glass(0.8);
    plan::View selected = view_of(scene, {2, 1, 4});
    selected.selected = 1;
    selected.markers = markers_at({{0, 0, 1}});
    plan::View lines = view_of(other, {-2, 1, 4});
    lines.mode = plan::DrawMode::stylized;
    lines.width = 100;
    const std::vector<plan::View> views{view_of(scene, {1, 2, 5}), selected, view_of(other, {1, 2, 5}),
                                        lines};
    std::vector<plan::RenderJob> renderings;
    std::vector<scene::Image> expected;
    std::vector<plan::FrameStats> alone;
    for (const plan::View& view : views) {
        expected.push_back(studio.draw(view.scene, view));
        alone.push_back(studio.stats);
        renderings.emplace_back(view);
    }
    int steps = 0, between = 0;
    for (bool all = false; !all; ++steps) {
        all = true;
        for (plan::RenderJob& rendering : renderings) {
            if (rendering.samples == 2) continue;
            const int before = rendering.samples;
            const bool whole = studio.renderer().step(rendering);
            CHECK(whole == (rendering.samples == 2));
            between += rendering.samples == before;
            all = all && whole;
        }
    }
    CHECK(between > 10);  // steps that end in the midst of a sample
    for (std::size_t i = 0; i < views.size(); ++i) {
        CAPTURE(i);
        CHECK(renderings[i].image.rgba == expected[i].rgba);
        CHECK(renderings[i].stats.draws == alone[i].draws);
        CHECK(renderings[i].stats.triangles == alone[i].triangles);
        CHECK(renderings[i].stats.passes == alone[i].passes);
        CHECK(renderings[i].stats.samples == 2);
    }
}

TEST_CASE("what is given up in the midst of a sample leaves nothing behind") {
    RendererFixture studio;
    const plan::View view = view_of(much_glass(0.1), {1, 2, 5});
    const scene::Image expected = studio.draw(view.scene, view);
    const long objects = gl::live_gl_objects();
    for (int i = 0; i < 5; ++i) {
        plan::RenderJob rendering(view);
        CHECK_FALSE(studio.renderer().step(rendering));
        CHECK(rendering.samples <= (studio.renderer().software() ? 0 : 1));  // a graphics card does more
    }
    CHECK(studio.draw(view.scene, view).rgba == expected.rgba);
    CHECK(gl::live_gl_objects() == objects);
}

TEST_CASE("no step of a scene of many panes in one place does more than so much") {
    RendererFixture studio;
    std::vector<Part> parts;
    constexpr int kPanes = 30'000;
    for (int i = 0; i < kPanes; ++i) parts.push_back({i + 1, quad(0.5), glass(0.3, 0.01), glm::dmat4(1)});
    plan::View view = view_from({0, 0, 5});
    view.scene = scene_of(parts);
    const scene::Image expected = studio.draw(view.scene, view);
    plan::RenderJob rendering(view);
    int steps = 0, draws = 0;
    for (bool whole = false; !whole; ++steps) {
        whole = studio.renderer().step(rendering);
        // Each covers more than 100 pixels, and takes at least that much.
        CHECK(rendering.stats.draws - draws <= plan::DrawBudget::kMost / 100);
        draws = rendering.stats.draws;
    }
    CHECK(draws == kPanes);
    CHECK(steps >= (studio.renderer().software() ? 3 : 2));  // a pixel costs a graphics card less
    CHECK(rendering.image.rgba == expected.rgba);
}

TEST_CASE("planning many panes takes steps, each of which looks at so many") {
    std::vector<Part> parts;
    constexpr int kPanes = 100'000;
    for (int i = 0; i < kPanes; ++i) parts.push_back({i + 1, quad(0.5), glass(0.3, 0.01), glm::dmat4(1)});
    plan::View view = view_from({0, 0, 5});
    view.scene = scene_of(parts);
    plan::TransparencyCache shapes(*view.scene->scene);
    plan::CutCache cuts;
    const auto steps = [&] {
        plan::FramePlanner planner;
        int count = 1;
        for (plan::DrawBudget work(true); !planner.step(view, {shapes, cuts}, work); ++count)
            work = plan::DrawBudget(true);
        REQUIRE(planner.plan().scene.transparent.size() == 1);
        CHECK(planner.plan().scene.transparent[0].items.size() == kPanes);
        return count;
    };
    const int first = steps();
    CHECK(first >= 2);
    CHECK(steps() <= first);  // what was found of their shapes is kept
}
