// The driver resets itself: what was drawn is lost, and what draws is made anew.
#include "gl_faults.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

struct Healed {
    ~Healed() { gl_faults::heal(); }
};

/// Of which one is two-sided, so that no draw call draws both.
std::shared_ptr<const scene::PlacedScene> two_parts() {
    scene::Material paint = material_of({0.7, 0.5, 0.3}), two_sided = paint;
    two_sided.two_sided = true;
    return scene_of(
        {{1, sphere(1, 8), paint, moved_by({-1, 0, 0})}, {2, quad(1), two_sided, moved_by({1, 0, 0})}});
}

plan::View view_of(const std::shared_ptr<const scene::PlacedScene>& scene) {
    plan::View view = view_from({0, 1, 5});
    view.scene = scene;
    view.samples = 4;
    return view;
}

}  // namespace

TEST_CASE("a picture in whose midst the driver resets itself is not had, and a new renderer draws it") {
    const Healed healed;
    const plan::View view = view_of(two_parts());
    scene::Image expected, image;
    plan::FrameStats stats;
    {
        renderer::Renderer renderer;
        renderer.render(view, expected, stats);
        const int draws = stats.draws;
        REQUIRE(draws >= 8);
        for (const int before : {0, 1, draws / 2, draws - 1}) {
            CAPTURE(before);
            gl_faults::heal();
            renderer::Renderer other;
            other.render(view, image, stats);
            gl_faults::reset_after(before);
            CHECK_THROWS_AS(other.render(view, image, stats), base::ContextLost);
        }
    }
    CHECK(gl::live_gl_objects() == 0);
    gl_faults::heal();
    renderer::Renderer renderer;
    renderer.render(view, image, stats);
    CHECK(image.rgba == expected.rgba);
}

TEST_CASE("what was begun before the driver reset itself goes on in a new renderer, or is begun anew") {
    const Healed healed;
    const plan::View view = view_of(two_parts());
    scene::Image expected;
    plan::FrameStats stats;
    plan::RenderJob rendering(view);
    {
        renderer::Renderer renderer;
        renderer.render(view, expected, stats);
        CHECK_FALSE(renderer.step(rendering));
        CHECK_FALSE(renderer.step(rendering));
        gl_faults::reset_after(1);
        CHECK_THROWS_AS(renderer.step(rendering), base::ContextLost);
        CHECK(rendering.samples == 2);
    }
    CHECK(gl::live_gl_objects() == 0);
    gl_faults::heal();
    renderer::Renderer renderer;
    plan::RenderJob anew(view, std::move(rendering.image));
    rendering.image.resize(view.width, view.height);
    while (!renderer.step(anew)) CHECK(anew.samples < view.samples);
    CHECK(anew.image.rgba == expected.rgba);
    CHECK_FALSE(renderer.step(rendering));
    CHECK(renderer.step(rendering));
    CHECK(rendering.image.rgba == expected.rgba);
}

TEST_CASE("a sample of which a part is drawn is lost with the driver, and drawn again whole") {
    const Healed healed;
    constexpr int kParts = 40'000;  // more than one step draws, on a graphics card, too
    std::vector<Part> parts;
    for (int i = 0; i < kParts; ++i)
        parts.push_back({i + 1, quad(2), material_of({0.7, 0.5, 0.3}), moved_by({0, 0, -0.0001 * i})});
    plan::View view = view_of(scene_of(parts));
    view.width = view.height = 16;
    view.samples = 2;
    scene::Image expected;
    plan::FrameStats stats;
    plan::RenderJob rendering(view);
    {
        renderer::Renderer renderer;
        renderer.render(view, expected, stats);
        while (rendering.stats.draws <= kParts) CHECK_FALSE(renderer.step(rendering));
        REQUIRE(rendering.stats.draws < 2 * kParts);  // in the midst of the second
        gl_faults::reset_after(1);
        CHECK_THROWS_AS(renderer.step(rendering), base::ContextLost);
    }
    gl_faults::heal();
    CHECK(rendering.samples == 1);
    renderer::Renderer renderer;
    while (!renderer.step(rendering)) CHECK(rendering.samples == 1);
    CHECK(rendering.image.rgba == expected.rgba);
}

TEST_CASE("shaders that a lost context does not compile are no fault of ours") {
    const Healed healed;
    plan::View view = view_of(two_parts());
    scene::Image image;
    plan::FrameStats stats;
    renderer::Renderer renderer;
    renderer.render(view, image, stats);
    gl_faults::reset_after(0);
    view.wireframe = true;  // with programs of its own
    CHECK_THROWS_AS(renderer.render(view, image, stats), base::ContextLost);
}

TEST_CASE("the numbers of nodes that a lost context has drawn are not had") {
    const Healed healed;
    const plan::View view = view_of(two_parts());
    renderer::Renderer renderer;
    REQUIRE_FALSE(renderer.node_ids(view).empty());
    gl_faults::reset_after(1);
    CHECK_THROWS_AS(renderer.node_ids(view), base::ContextLost);
}

TEST_CASE("samples that lay on the GPU when the driver reset itself are drawn again") {
    const Healed healed;
    const plan::View view = view_of(two_parts());
    scene::Image expected;
    plan::FrameStats stats;
    plan::RenderJob job(view);
    {
        renderer::Renderer renderer;
        renderer.render(view, expected, stats);
        renderer.use_resolver(renderer::ResolveOn::gpu);
        while (job.samples < 2) CHECK_FALSE(renderer.step(job));
        gl_faults::reset_after(1);
        CHECK_THROWS_AS(renderer.step(job), base::ContextLost);
    }
    CHECK(gl::live_gl_objects() == 0);
    for (const renderer::ResolveOn resolve_on : {renderer::ResolveOn::gpu, renderer::ResolveOn::cpu}) {
        gl_faults::heal();
        renderer::Renderer renderer;
        renderer.use_resolver(resolve_on);
        while (!renderer.step(job)) {
        }
        CHECK(job.image.rgba == expected.rgba);
    }
}
