// The driver's memory is short: what fits is drawn as ever, and what does not is told.
#include "gl/gl.hpp"
#include "gl_faults.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

struct HealedMemory {
    ~HealedMemory() { gl_faults::heal(); }
};

scene::Material glass() {
    scene::Material material = material_of({0.2, 0.5, 0.9});
    material.diffuse.a = 0.5;
    return material;
}

scene::Material mirror() {
    scene::Material material = material_of({0.2, 0.2, 0.2});
    material.reflectivity = 0.8;
    return material;
}

/// Something for every pass.
std::shared_ptr<const scene::PlacedScene> everything() {
    return scene_of({{1, sphere(1, 12), material_of({0.7, 0.5, 0.3}), moved_by({-1, 0, 0})},
                     {2, sphere(0.6, 12), glass(), moved_by({0.4, 0, 1})},
                     {3, box({0.5, 0.5, 0.5}), glass(), moved_by({0.6, 0, 1.2})},
                     {4, quad(3), mirror(), moved_by({0, 0, -2})}});
}

plan::View view_of(const std::shared_ptr<const scene::PlacedScene>& scene) {
    plan::View view = view_from({0, 1, 5});
    view.scene = scene;
    view.selected = 1;
    view.markers = markers_at({{0, 0, 1}});
    return view;
}

/// Glass hidden by an opaque node of the same geometry: their depths are compared exactly.
std::shared_ptr<const scene::PlacedScene> hidden_glass() {
    scene::SceneParts parts;
    parts.geometries = {quad(2)};
    parts.materials = {glass(), material_of({0.7, 0.5, 0.3})};
    for (const scene::Index i : {0, 1})
        parts.nodes.push_back({scene::Node{i + 1,
                                           {},
                                           scene::NodeType::geometry,
                                           scene::kNone,
                                           {},
                                           true,
                                           glm::dmat4(1),
                                           scene::GeometryData{0, i}},
                               0});
    return std::make_shared<const scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
}

}  // namespace

TEST_CASE("whatever does not fit, a picture is whole or told not to be, and the next one is whole") {
    const HealedMemory healed;
    plan::View view = view_of(everything());
    renderer::ResolveOn resolve_on{};
    SUBCASE("samples are averaged on the CPU") { resolve_on = renderer::ResolveOn::cpu; }
    SUBCASE("samples are averaged on the GPU") {
        resolve_on = renderer::ResolveOn::gpu;
        view.samples = 2;
    }
    scene::Image expected, image;
    plan::FrameStats stats;
    std::size_t most = 0;
    {
        renderer::Renderer renderer;
        renderer.use_resolver(resolve_on);
        const std::size_t before = gl_faults::memory_used();
        renderer.render(view, expected, stats);
        REQUIRE(stats.passes >= 5);
        most = gl_faults::memory_used() - before;
    }
    CHECK(gl_faults::memory_used() == 0);
    int refused = 0;
    for (std::size_t k = 0; k <= 24; ++k) {
        CAPTURE(k);
        renderer::Renderer renderer;
        renderer.use_resolver(resolve_on);
        gl_faults::limit_memory(gl_faults::memory_used() + most * k / 24);
        try {
            renderer.render(view, image, stats);
            CHECK(image.rgba == expected.rgba);
        } catch (const base::OutOfMemory& error) {
            ++refused;
            CHECK(std::string(error.what()).find("has no memory for") != std::string::npos);
        }
        gl_faults::heal();
        renderer.render(view, image, stats);
        CHECK(image.rgba == expected.rgba);
    }
    CHECK(refused > 5);
    CHECK(refused <= 24);  // with all that it needs it is drawn
    CHECK(gl::live_gl_objects() == 0);
}

TEST_CASE(
    "a scene that does not fit beside the one shown is refused, and that one is drawn from what is there") {
    const HealedMemory healed;
    const plan::View shown = view_of(everything());
    plan::View large = view_from({0, 0, 5});
    large.scene = scene_of({{1, sphere(1, 200), material_of({1, 0, 0}), glm::dmat4(1)}});
    scene::Image expected, image;
    plan::FrameStats stats;
    renderer::Renderer renderer;
    renderer.upload(shown);
    renderer.render(shown, expected, stats);
    const long objects = gl::live_gl_objects();
    gl_faults::limit_memory(gl_faults::memory_used() + 500'000);
    CHECK_THROWS_WITH_AS(renderer.upload(large),
                         doctest::Contains("the graphics driver has no memory for 1.8 MiB of vertices"),
                         base::OutOfMemory);
    CHECK(gl::live_gl_objects() == objects);
    renderer.render(shown, image, stats);
    CHECK(stats.uploads == 0);
    CHECK(image.rgba == expected.rgba);
    gl_faults::heal();
    renderer.upload(large);
    renderer.render(shown, image, stats);
    CHECK(stats.uploads == 0);
    renderer.render(large, image, stats);
    CHECK(stats.uploads == 0);  // all was there
}

TEST_CASE("what earlier pictures left on the GPU makes room for the next") {
    const HealedMemory healed;
    plan::View view = view_of(everything());
    scene::Image expected, image;
    plan::FrameStats stats;
    renderer::Renderer renderer;
    renderer.render(view, expected, stats);
    plan::View lines = view;
    lines.wireframe = true;
    lines.width = lines.height = 300;
    renderer.render(lines, image, stats);
    gl_faults::limit_memory(gl_faults::memory_used());
    view.mode = plan::DrawMode::stylized;
    renderer.render(view, image, stats);
    view.mode = plan::DrawMode::realistic;
    renderer.render(view, image, stats);
    CHECK(image.rgba == expected.rgba);
}

TEST_CASE("a picture larger than the driver holds is refused in a sentence") {
    const HealedMemory healed;
    plan::View view = view_of(everything());
    scene::Image image;
    plan::FrameStats stats;
    renderer::Renderer renderer;
    gl_faults::limit_memory(gl_faults::memory_used() + 1'000'000);
    view.width = 2000;
    view.height = 1000;
    CHECK_THROWS_WITH_AS(renderer.render(view, image, stats),
                         "the graphics driver has no memory for a picture of 2000x1000 pixels",
                         base::OutOfMemory);
    view.width = view.height = 64;
    renderer.render(view, image, stats);
}

TEST_CASE("an error that is no lack of memory is reported by its name, and the next picture is whole") {
    const HealedMemory healed;
    const plan::View view = view_of(everything());
    scene::Image expected, image;
    plan::FrameStats stats;
    {
        renderer::Renderer renderer;
        renderer.render(view, expected, stats);
        gl_faults::fail_draw(GL_INVALID_OPERATION);
        CHECK_THROWS_WITH_AS(renderer.render(view, image, stats),
                             "OpenGL reports GL_INVALID_OPERATION where it was asked to draw", base::GlError);
        renderer.render(view, image, stats);
        CHECK(image.rgba == expected.rgba);
        // Lack of memory: what was drawn before makes room, and the picture is drawn again.
        gl_faults::fail_draw(GL_OUT_OF_MEMORY);
        renderer.render(view, image, stats);
        CHECK(image.rgba == expected.rgba);
    }
    renderer::Renderer renderer;
    gl_faults::fail_allocations(GL_INVALID_VALUE);
    CHECK_THROWS_WITH_AS(
        renderer.upload(view),
        doctest::Contains("OpenGL reports GL_INVALID_VALUE where it was asked for 0.0 MiB of"),
        base::GlError);
    CHECK_THROWS_WITH_AS(
        renderer.render(view, image, stats),
        doctest::Contains("OpenGL reports GL_INVALID_VALUE where it was asked for a picture of"),
        base::GlError);
    gl_faults::heal();
    renderer.render(view, image, stats);
    CHECK(image.rgba == expected.rgba);
}

TEST_CASE("a frame that fails in its midst leaves the next one as a new renderer draws it") {
    const HealedMemory healed;
    const auto plain = hidden_glass();
    // A mirror whose plane cuts a part, and a part that does not fit.
    const auto failing =
        scene_of({{1, quad(6), mirror(), moved_by({0, 0, -1})},
                  {2, sphere(1, 12), material_of({0.7, 0.5, 0.3}), moved_by({0, 0, -1})},
                  {3, sphere(0.5, 200), material_of({0.2, 0.7, 0.3}), moved_by({0, 0.5, 0.2})}});
    plan::View view = view_from({0.5, 1, 5});
    view.scene = plain;
    scene::Image expected, image;
    plan::FrameStats stats;
    renderer::Renderer().render(view, expected, stats);
    for (const plan::DrawMode mode : {plan::DrawMode::realistic, plan::DrawMode::stylized})
        for (const bool wireframe : {false, true}) {
            CAPTURE(static_cast<int>(mode));
            CAPTURE(wireframe);
            plan::View broken = view;
            broken.scene = failing;
            broken.mode = mode;
            broken.wireframe = wireframe;
            renderer::Renderer renderer;
            renderer.render(view, image, stats);
            CHECK(image.rgba == expected.rgba);
            gl_faults::limit_memory(gl_faults::memory_used() + 600'000);
            CHECK_THROWS_AS(renderer.render(broken, image, stats), base::OutOfMemory);
            gl_faults::heal();
            renderer.render(view, image, stats);
            CHECK(image.rgba == expected.rgba);
        }
}
