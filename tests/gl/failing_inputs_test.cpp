// Scenes and views at the limits of what can be asked, and what the tests themselves must find.
#include <cmath>
#include <limits>

#include "io/vrut/text_reader.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

const scene::Material kPaint = material_of({0.7, 0.5, 0.3}, {0.2, 0.3, 0.4}, 12);

std::shared_ptr<const scene::PlacedScene> read(const std::string& text) {
    auto scene = io::read_vrut_text(text, "test.vrut");
    REQUIRE_MESSAGE(scene.has_value(), scene.error());
    return std::make_shared<const scene::PlacedScene>(scene::place(*std::move(scene)));
}

/// In all ways in which a view can be drawn.
template <class Draw>
void in_all_modes(plan::View view, scene::Index selected, const Draw& draw) {
    for (const plan::DrawMode mode : {plan::DrawMode::realistic, plan::DrawMode::stylized})
        for (const bool wireframe : {false, true})
            for (const scene::Index node : {scene::kNone, selected}) {
                view.mode = mode;
                view.wireframe = wireframe;
                view.selected = node;
                CAPTURE(static_cast<int>(mode));
                CAPTURE(wireframe);
                CAPTURE(node);
                draw(view);
            }
}

glm::ivec3 middle(const scene::Image& image) { return pixel_of(image, image.width / 2, image.height / 2); }

}  // namespace

TEST_CASE("an empty scene is its background, in every mode and with anything selected") {
    RendererFixture studio;
    for (const bool only_groups : {false, true}) {
        scene::SceneParts parts;
        if (only_groups)
            parts.nodes.push_back(
                {scene::Node{1, {}, scene::NodeType::assembly, scene::kNone, {}, true, glm::dmat4(0), {}},
                 0});
        const auto scene =
            std::make_shared<const scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
        in_all_modes(view_from({0, 0, 5}), 0, [&](const plan::View& view) {
            const scene::Image image = studio.draw(scene, view);
            CHECK(middle(image) == bytes_of(plan::kDefaultBackground));
            CHECK(studio.stats.passes == 0);
        });
    }
}

TEST_CASE("a chain of a million nodes is read, drawn in every mode, selected and given back") {
    constexpr int kCount = 1'000'000;
    std::string text = "vrut-text 1\ngeometry 1 vertices 3 -1 -1 0 1 -1 0 0 1 0 triangles 1 0 1 2 end\n";
    const auto node = [&](int id, const std::string& rest) {
        text +=
            "node " + std::to_string(id) + " \"n\" " + rest + " parent " + std::to_string(id - 1) + " end\n";
    };
    for (int id = 1; id < kCount; ++id) node(id, "assembly");
    node(kCount, "geometry geometry 1");
    RendererFixture studio;
    auto scene = read(text);
    CHECK(scene->nodes.size() == std::size_t{kCount} + 1);
    in_all_modes(view_from({0, 0, 5}), scene->scene->find_node(1), [&](const plan::View& view) {
        const scene::Image image = studio.draw(scene, view);
        CHECK(studio.stats.draws >= 1);
        CHECK((middle(image) == bytes_of(plan::kDefaultBackground)) == view.wireframe);
    });
    plan::View view = view_from({0, 0, 5});
    view.markers = markers_at({{0, 0, 0}});
    CHECK(middle(studio.draw(scene, view)) == glm::ivec3(204, 10, 82));
    studio.draw(scene_of({}), view);  // another scene: the chain goes
    scene.reset();
}

TEST_CASE("views of 1 x 8192 and 8192 x 1, in every mode, are those columns and rows of wide ones") {
    RendererFixture studio;
    const auto scene =
        scene_of({{1, sphere(1.5, 8), kPaint, glm::dmat4(1)}, {2, quad(40), kPaint, moved_by({0, 0, -2})}});
    for (const int width : {1, 8192}) {
        const int height = 8192 / width;
        CAPTURE(width);
        plan::View view = view_from({0.5, 0.4, 5});
        view.width = width;
        view.height = height;
        view.markers = markers_at({{0, 0, 0}});
        in_all_modes(view, 1, [&](const plan::View& shown) {
            const scene::Image image = studio.draw(scene, shown);
            CHECK(image.rgba.size() == std::size_t{8192} * 4);
            CHECK(studio.stats.passes >= 2);
        });
        view.markers.reset();
        view.samples = 3;
        studio.draw(scene, view);
        view.samples = 1;
        CHECK(studio.check(scene, view).compared > 60 * 97);
    }
}

TEST_CASE("from inside a body its own faces do not show, and what is in it does") {
    RendererFixture studio;
    const Part within{2, sphere(0.3, 8), kPaint, moved_by({0, 0, -1})};
    const plan::View view = view_from({0, 0, 0.5}, {0, 0, -1});
    for (const scene::Geometry& body : {box({2, 2, 2}), sphere(2, 8)}) {
        const auto scene = scene_of({{1, body, material_of({1, 0, 0}), glm::dmat4(1)}, within});
        CHECK(studio.draw(scene, view).rgba == studio.draw(scene_of({within}), view).rgba);
        CHECK(studio.check(scene, view).surfaces > 100);
        // Turned inside out, it is a room around the same thing.
        const auto room =
            scene_of({{1, turned_inside_out(body), material_of({1, 0, 0}), glm::dmat4(1)}, within});
        const PictureMismatch result = studio.check(room, view);
        CHECK(result.surfaces == result.compared);
        plan::View marked = view;
        marked.selected = 1;
        CHECK(studio.draw(scene, marked).rgba.size() == 96 * 64 * 4);
    }
}

TEST_CASE("near and far a million apart: at every distance between, the nearer of two hides the other") {
    RendererFixture studio;
    const scene::Material red = material_of({1, 0, 0}), green = material_of({0, 1, 0});
    plan::View view = view_from({0, 0, 0}, {0, 0, -1});
    for (const double distance : {1.5, 10.0, 1e3, 1e5, 9e5}) {
        CAPTURE(distance);
        for (const bool red_first : {false, true}) {
            const double gap = distance * 1e-5;
            // A speck at 1 beside the view's middle, and a wall at 10^6 behind it all.
            const auto scene =
                scene_of({{1, quad(0.05), kPaint, moved_by({0.3, 0, -1})},
                          {red_first ? 2 : 3, quad(distance), red, moved_by({0, 0, -distance})},
                          {red_first ? 3 : 2, quad(distance), green, moved_by({0, 0, -distance - gap})},
                          {4, quad(1e6), kPaint, moved_by({0, 0, -1e6})}});
            CHECK(middle(studio.draw(scene, view)).g == 0);
            CHECK(studio.check(scene, view).surfaces > 5000);
        }
    }
}

TEST_CASE("the narrowest and the widest field of view") {
    RendererFixture studio;
    const auto scene = scene_of({{1, sphere(1.5, 8), kPaint, glm::dmat4(1)}});
    for (const double fov : {1.0, 170.0}) {
        CAPTURE(fov);
        plan::View view = view_from({0, 0, fov < 90 ? 200 : 1.7});
        view.camera.fov = fov;
        CHECK(studio.check(scene, view).surfaces > 20);
    }
}

TEST_CASE("positions beyond all that is drawn, and matrices that go there, harm nothing else") {
    RendererFixture studio;
    const std::string good = R"(vrut-text 1
geometry 1 vertices 3 -1 -1 0 1 -1 0 0 1 0 triangles 1 0 1 2 end
node 1 "Plain" geometry geometry 1 end
)";
    const plan::View view = view_from({0, 0, 5});
    const scene::Image plain = studio.draw(read(good), view);
    // Geometry of the largest coordinates, scaled; matrices whose product no double holds; and those that
    // leave nothing.
    const std::string far = "geometry 2 vertices 3 0 0 0 1e15 0 0 0 1e15 0 triangles 1 0 1 2 end\n",
                      scaled = "geometry geometry 2 matrix 1e4 0 0 0 0 1e4 0 0 0 0 1e4 0 0 0 0 1 end",
                      huge = "matrix 1e15 0 0 1e15 0 1e15 0 -1e15 0 0 1e15 0 0 0 0 1 end\n";
    std::string nested;
    for (int id = 2; id < 40; ++id)
        nested += "node " + std::to_string(id) + " \"Up\" assembly parent " +
                  std::to_string(id == 2 ? 0 : id - 1) + " " + huge;
    for (const std::string& odd :
         {far + "node 2 \"Odd\" " + scaled, nested + "node 40 \"Odd\" geometry parent 39 geometry 1 end",
          std::string("node 2 \"Odd\" geometry geometry 1 matrix 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1 end"),
          std::string(
              "node 2 \"Odd\" geometry geometry 1 matrix 1e-300 0 0 0 0 1e-300 0 0 0 0 1e-300 0 0 0 0 1 "
              "end")}) {
        CAPTURE(odd);
        in_all_modes(view, 2, [&](const plan::View& shown) { studio.draw(read(good + odd), shown); });
        CHECK(studio.draw(read(good + odd), view).rgba == plain.rgba);
    }
    for (const std::string number : {"nan", "inf", "-inf", "1e999", "1e16", "0x10"}) {
        CAPTURE(number);
        CHECK_FALSE(io::read_vrut_text("vrut-text 1\ngeometry 1 vertices 1 " + number + " 0 0 end\n", "t"));
        CHECK_FALSE(io::read_vrut_text(
            "vrut-text 1\nnode 1 \"N\" assembly matrix " + number + " 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 end\n",
            "t"));
    }
    // Numbers that no file can hold, from a host: not drawn either.
    for (const double number : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        scene::Geometry odd = quad(1);
        odd.positions[2].y = number;
        odd.bounds.max.y = number;
        const auto scene = scene_of({{1, odd, kPaint, glm::dmat4(1)}});
        CHECK(middle(studio.draw(scene, view)) == bytes_of(plan::kDefaultBackground));
        CHECK(studio.stats.draws == 0);
    }
}

TEST_CASE("what a driver complains of fails a test" * doctest::should_fail()) {
    RendererFixture studio;
    glEnable(GL_TEXTURE_WRAP_S);  // no capability
}

TEST_CASE("a GL object that is not given back fails a test" * doctest::should_fail()) {
    struct Leak {
        Leak() { gl::detail::count_gl_object(1); }
        ~Leak() { gl::detail::count_gl_object(-1); }
    } const leak;
    const RendererFixture studio;
}

TEST_CASE("GL objects of every kind are counted, moved and not copied") {
    const RendererFixture studio;
    const long before = gl::live_gl_objects();
    const auto lives_once = [&](auto handle) {
        using Handle = decltype(handle);
        CHECK_FALSE(std::is_copy_constructible_v<Handle>);
        CHECK_FALSE(std::is_copy_assignable_v<Handle>);
        CHECK(gl::live_gl_objects() == before + 1);
        Handle other = std::move(handle);
        CHECK(gl::live_gl_objects() == before + 1);
        CHECK(!handle);  // NOLINT(bugprone-use-after-move)
        other = Handle();
        CHECK(gl::live_gl_objects() == before);
    };
    lives_once(gl::make_buffer("numbers", &before, sizeof before));
    lives_once(gl::make_dynamic_buffer("numbers", 16));
    lives_once(gl::make_vertex_array());
    lives_once(gl::make_renderbuffer(GL_RGBA8, 2, 2));
    lives_once(gl::make_texture(GL_RGBA8, 2, 2));
    lives_once(gl::make_framebuffer());
    lives_once(gl::GlShader(glCreateShader(GL_VERTEX_SHADER)));
    lives_once(gl::GlProgram(glCreateProgram()));
}
