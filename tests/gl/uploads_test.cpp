// Uploads are done in steps, and what moves does not wait for levels of detail and edges.
#include "gl_faults.hpp"
#include "mesh/detail_levels.hpp"
#include "plan/draw_budget.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

struct HealedMemory {
    ~HealedMemory() { gl_faults::heal(); }
};

/// Bytes: a step's budget at 32 a unit, a piece, and what drawing itself writes.
constexpr std::size_t kMostCopied = 32 * plan::DrawBudget::kMostUpload + (std::size_t{1} << 20);

/// The most that a call of it copied.
class Copies {
public:
    template <class Call>
    auto of(Call call) {
        const std::size_t before = gl_faults::bytes_copied();
        const auto result = call();
        most = std::max(most, gl_faults::bytes_copied() - before);
        ++calls;
        return result;
    }
    std::size_t most = 0;
    int calls = 0;
};

plan::View view_of(std::vector<Part> parts) {
    plan::View view = view_from({0, 1, 5});
    view.scene = scene_of(parts);
    return view;
}

/// A geometry of many steps beside a small one: without normals each triangle has vertices of its own.
plan::View large_view() {
    const scene::Material paint = material_of({0.7, 0.5, 0.3});
    return view_of(
        {{1, sphere(1, 300, false), paint, glm::dmat4(1)}, {2, quad(1), paint, moved_by({0, 0, -2})}});
}

/// Not while another renderer lives, whose context it would take the place of.
scene::Image drawn_at_once(const plan::View& view) {
    renderer::Renderer renderer;
    scene::Image image;
    plan::FrameStats stats;
    renderer.render(view, image, stats);
    return image;
}

/// Draws interactive images until one shows what the view asks for; none waits for that.
scene::Image draw_interactively(renderer::Renderer& renderer, const plan::View& view, Copies& copies,
                                const std::function<bool(const plan::FrameStats&)>& is_complete) {
    for (int images = 0; images < 100'000; ++images) {
        plan::RenderJob job(view);
        job.interactive = true;
        int steps = 1;
        while (!copies.of([&] { return renderer.step(job); })) ++steps;
        CHECK(steps <= 2);
        if (is_complete(job.stats)) return std::move(job.image);
    }
    FAIL("no image was complete");
    return {};
}

}  // namespace

TEST_CASE("a scene is uploaded in steps of bounded size, between which the scene before is drawn") {
    const plan::View shown = view_of({{1, box({1, 1, 1}), material_of({0, 0.5, 0}), glm::dmat4(1)}});
    const plan::View large = large_view();
    const scene::Image expected = drawn_at_once(shown), expected_large = drawn_at_once(large);
    renderer::Renderer renderer;
    scene::Image image;
    plan::FrameStats stats;
    renderer.render(shown, image, stats);
    const std::size_t before = gl_faults::bytes_copied();
    Copies copies;
    while (!copies.of([&] { return renderer.upload_step(large); })) {
        renderer.render(shown, image, stats);
        REQUIRE(image.rgba == expected.rgba);
        REQUIRE(stats.uploads == 0);
    }
    CHECK(gl_faults::bytes_copied() - before > 2 * kMostCopied);
    CHECK(copies.most <= kMostCopied);
    CHECK(copies.calls >= 4);
    renderer.render(large, image, stats);
    CHECK(stats.uploads == 0);
    CHECK(image.rgba == expected_large.rgba);
}

TEST_CASE("programs are compiled one a step") {
    const plan::View view = large_view();
    renderer::Renderer renderer;
    const auto objects = [&] { return gl::live_gl_objects(); };
    int steps = 0;
    for (long before = objects(); !renderer.upload_step(view); ++steps) {
        // A program, and with it at most a geometry's two buffers and vertex array.
        CHECK(objects() - before <= 4);
        before = objects();
    }
    CHECK(steps > 8);
    scene::Image image;
    plan::FrameStats stats;
    renderer.render(view, image, stats);
    CHECK(stats.programs == 0);
}

TEST_CASE("an image of what was not uploaded before takes steps of bounded size, too") {
    const plan::View large = large_view();
    const scene::Image expected = drawn_at_once(large);
    renderer::Renderer renderer;
    plan::RenderJob job(large);
    Copies copies;
    while (!copies.of([&] { return renderer.step(job); })) CHECK(job.samples == 0);
    CHECK(copies.most <= kMostCopied);
    CHECK(copies.calls >= 4);
    CHECK(job.image.rgba == expected.rgba);
}

TEST_CASE("a texture and a cube map are uploaded in steps of bounded size") {
    scene::SceneParts parts;
    scene::Image checks;
    checks.resize(2048, 2048);
    for (std::size_t i = 0; i < checks.rgba.size(); ++i)
        checks.rgba[i] = static_cast<std::uint8_t>(i * 2654435761U >> 24);
    parts.textures = {{"a.png", checks, false}};
    const auto scene =
        std::make_shared<const scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
    plan::View image_view = view_from({0, 0, 5}), cube_view = image_view;
    image_view.background.texture = 0;
    cube_view.background.cube_map = {0, 0, 0, 0, 0, 0};
    for (plan::View* view : {&image_view, &cube_view}) {
        view->scene = scene;
        const scene::Image expected = drawn_at_once(*view);
        renderer::Renderer renderer;
        Copies copies;
        while (!copies.of([&] { return renderer.upload_step(*view); })) {
        }
        CHECK(copies.most <= kMostCopied);
        CHECK(copies.calls >= 3);
        scene::Image image;
        plan::FrameStats stats;
        renderer.render(*view, image, stats);
        CHECK(stats.uploads == 0);
        CHECK(image.rgba == expected.rgba);
    }
}

TEST_CASE("an upload that finds no memory midway leaves the scene before, and nothing of the new one") {
    const HealedMemory healed;
    const plan::View shown = view_of({{1, box({1, 1, 1}), material_of({0, 0.5, 0}), glm::dmat4(1)}});
    const scene::Material paint = material_of({0.7, 0.5, 0.3});
    const plan::View large = view_of(
        {{1, sphere(1, 300, false), paint, glm::dmat4(1)}, {2, sphere(1, 299, false), paint, glm::dmat4(1)}});
    renderer::Renderer renderer;
    scene::Image expected, image;
    plan::FrameStats stats;
    renderer.render(shown, expected, stats);
    renderer.upload(shown);  // compiles the programs of both
    const long objects = gl::live_gl_objects();
    while (gl::live_gl_objects() == objects) REQUIRE_FALSE(renderer.upload_step(large));
    gl_faults::limit_memory(gl_faults::memory_used());
    CHECK_THROWS_AS(renderer.upload(large), base::OutOfMemory);
    CHECK(gl::live_gl_objects() == objects);
    renderer.render(shown, image, stats);
    CHECK(stats.uploads == 0);
    CHECK(image.rgba == expected.rgba);
}

TEST_CASE("a wireframe is drawn at once, with faces until there are edges") {
    plan::View view = large_view();
    plan::View wireframe = view;
    wireframe.wireframe = true;
    plan::View stylized = view;
    stylized.mode = plan::DrawMode::stylized;
    plan::View overlay = wireframe;
    overlay.selected = 1;
    for (const plan::View& lines : {wireframe, stylized, overlay}) {
        const scene::Image expected = drawn_at_once(lines);
        renderer::Renderer renderer;
        renderer.upload(view);
        int substitutes = 0;
        Copies copies;
        const scene::Image image =
            draw_interactively(renderer, lines, copies, [&](const plan::FrameStats& stats) {
                substitutes += stats.substitutes;
                return stats.substitutes == 0;
            });
        CHECK(substitutes >= 1);
        CHECK(copies.most <= kMostCopied);
        CHECK(image.rgba == expected.rgba);
        CHECK(renderer.take_messages().empty());
    }
}

TEST_CASE("a level of detail is drawn once it is uploaded; until then, what is there") {
    plan::View view = view_of({{1, sphere(1, 300), material_of({0.7, 0.5, 0.3}), glm::dmat4(1)}});
    const auto levels = std::make_shared<const mesh::DetailLevels>(view.scene->scene);
    levels->wait();
    plan::View coarse = view;
    coarse.levels = levels;
    coarse.detail = 0.5;
    plan::View lines = coarse;
    lines.wireframe = true;
    const scene::Image expected = drawn_at_once(coarse), expected_lines = drawn_at_once(lines);
    renderer::Renderer renderer;
    renderer.upload(view);
    scene::Image whole;
    plan::FrameStats of_whole;
    renderer.render(view, whole, of_whole);
    const std::uint64_t all = of_whole.triangles;
    std::uint64_t most = 0;
    Copies copies;
    const scene::Image image =
        draw_interactively(renderer, coarse, copies, [&](const plan::FrameStats& stats) {
            most = std::max(most, stats.triangles);
            return stats.triangles < all;
        });
    CHECK(most == all);
    CHECK(copies.most <= kMostCopied);
    CHECK(image.rgba == expected.rgba);
    // A wireframe draws every triangle, from whichever order of them is there.
    coarse.detail = 0;
    scene::Image drawn;
    plan::FrameStats stats;
    renderer.render(coarse, drawn, stats);
    CHECK(draw_interactively(renderer, lines, copies, [](const plan::FrameStats& s) {
              return s.substitutes == 0;
          }).rgba == expected_lines.rgba);
}

TEST_CASE("what moves is drawn without the edges and levels for which there is no memory") {
    const HealedMemory healed;
    plan::View view = view_of({{1, sphere(1, 100), material_of({0.7, 0.5, 0.3}), glm::dmat4(1)}});
    plan::View lines = view;
    lines.wireframe = true;
    const scene::Image expected = drawn_at_once(lines);
    renderer::Renderer renderer;
    scene::Image image;
    plan::FrameStats stats;
    renderer.render(view, image, stats);
    const auto levels = std::make_shared<const mesh::DetailLevels>(view.scene->scene);
    levels->wait();
    view.levels = levels;
    view.detail = 10;
    gl_faults::limit_memory(gl_faults::memory_used() + 1000);
    for (int i = 0; i < 200; ++i)
        for (const plan::View& shown : {lines, view}) {
            plan::RenderJob job(shown);
            job.interactive = true;
            while (!renderer.step(job)) {
            }
            REQUIRE(job.stats.uploads == 0);
        }
    CHECK_THROWS_AS(renderer.render(lines, image, stats), base::OutOfMemory);
    gl_faults::heal();
    renderer.render(lines, image, stats);
    CHECK(image.rgba == expected.rgba);
}
