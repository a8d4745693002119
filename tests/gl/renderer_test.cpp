#include "renderer/renderer.hpp"

#include <algorithm>
#include <random>

#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

const scene::Material kPaint = material_of({0.8, 0.3, 0.1}, {0.3, 0.3, 0.3}, 20);

std::vector<Part> some_parts() {
    std::vector<Part> parts;
    for (int i = 0; i < 12; ++i) {
        const int column = i % 4, row = i / 4;
        parts.push_back(
            {10 + i * 7, i % 2 ? sphere(0.6, 6) : box({0.5, 0.4, 0.3}),
             material_of({0.1 * (i % 8), 0.5, 0.8 - 0.05 * i}, {0.2, 0.2, 0.2}, 5.0 * i),
             moved_by({column * 0.9 - 1.4, row * 0.9 - 0.9, 0.2 * i - 1}) * turned_by(17 * i, {0, 1, 0})});
    }
    return parts;
}

double average(const scene::Image& image) {
    double sum = 0;
    for (const std::uint8_t byte : image.rgba) sum += byte;
    return sum / static_cast<double>(image.rgba.size());
}

}  // namespace

TEST_CASE("pictures of any size") {
    RendererFixture studio;
    const auto scene =
        scene_of({{1, sphere(1.5, 8), kPaint, glm::dmat4(1)}, {2, quad(4), kPaint, moved_by({0, 0, -2})}});
    plan::View view = view_from({0.5, 0.4, 5});
    struct Size {
        int width, height;
    };
    for (const Size size : {Size{1, 1}, {1, 2048}, {2048, 1}, {2, 3}, {97, 61}, {1, 1}, {640, 480}}) {
        CAPTURE(size.width);
        CAPTURE(size.height);
        view.width = size.width;
        view.height = size.height;
        const scene::Image image = studio.draw(scene, view);
        CHECK(image.width == size.width);
        CHECK(image.height == size.height);
        CHECK(image.rgba.size() == static_cast<std::size_t>(size.width * size.height * 4));
        if (size.width * size.height > 10000) continue;
        studio.check(scene, view);
    }
    CHECK(studio.renderer().max_size() >= 2048);
    view.width = studio.renderer().max_size() + 1;
    scene::Image image;
    plan::FrameStats stats;
    CHECK_THROWS_AS(studio.renderer().render(view, image, stats), std::runtime_error);
    // And it draws on after that. What the driver said of it is no fault.
    studio.renderer().take_messages();
    studio.check(scene, view_from({0.5, 0.4, 5}));
}

TEST_CASE("one sample is the pixel's centre") {
    RendererFixture studio;
    const plan::View view = pixel_view(8, 6);
    const auto dark = [&](double left, double top, double right, double bottom) {
        const scene::Image image = studio.draw(
            scene_of({{1, rectangle(left, top, right, bottom, view), material_of({0, 0, 0}), glm::dmat4(1)}}),
            view);
        std::vector<std::pair<int, int>> pixels;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x)
                if (pixel_of(image, x, y) == glm::ivec3(0)) pixels.emplace_back(x, y);
        return pixels;
    };
    using ImageBytes = std::vector<std::pair<int, int>>;
    CHECK(dark(2.45, 1.45, 2.55, 1.55) == ImageBytes{{2, 1}});
    CHECK(dark(2.55, 1.45, 3.45, 1.55).empty());
    CHECK(dark(2.45, 1.55, 2.55, 2.45).empty());
    CHECK(dark(0.4, 4.4, 1.6, 5.6) == ImageBytes{{0, 4}, {1, 4}, {0, 5}, {1, 5}});
}

TEST_CASE("many samples: what an edge covers is told to one part in their number") {
    RendererFixture studio;
    plan::View view = pixel_view(8, 6);
    for (const int samples : {2, 3, 4, 5, 16, 64})
        for (int ninth = 0; ninth < 9; ++ninth) {
            const double edge = 0.03 + ninth * 0.11;
            CAPTURE(samples);
            CAPTURE(edge);
            view.samples = samples;
            const auto white = [&](const scene::Geometry& geometry, int x, int y) {
                const scene::Image image =
                    studio.draw(scene_of({{1, geometry, material_of({0, 0, 0}), glm::dmat4(1)}}), view);
                CHECK(pixel_of(image, 1, 1) == glm::ivec3(0));
                CHECK(pixel_of(image, 7, 5) == glm::ivec3(255));
                return pixel_of(image, x, y).g / 255.0;
            };
            // Numbers of samples that are no power of two are less even.
            const double allowed =
                (std::has_single_bit(static_cast<unsigned>(samples)) ? 1.0 : 2.0) / samples + 0.003;
            CHECK(std::abs(white(rectangle(-10, -10, 4 + edge, 20, view), 4, 3) - (1 - edge)) <= allowed);
            CHECK(std::abs(white(rectangle(-10, -10, 20, 3 + edge, view), 4, 3) - (1 - edge)) <= allowed);
        }
}

TEST_CASE("many samples: the average of a finer picture") {
    RendererFixture studio;
    const auto scene = scene_of(some_parts());
    plan::View view = view_from({1, 2, 5});
    plan::View fine = view;
    fine.width *= 8;
    fine.height *= 8;
    const scene::Image finer = studio.draw(scene, fine);
    const auto block = [&](int x, int y) {
        glm::dvec3 sum(0);
        for (int dy = 0; dy < 8; ++dy)
            for (int dx = 0; dx < 8; ++dx) sum += glm::dvec3(pixel_of(finer, x * 8 + dx, y * 8 + dy));
        return sum / 64.0;
    };
    double mean_of_16 = 0, mean_of_1 = 0;
    for (const int samples : {1, 4, 16}) {
        CAPTURE(samples);
        view.samples = samples;
        const scene::Image image = studio.draw(scene, view);
        double worst = 0, sum = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const glm::dvec3 off = glm::abs(glm::dvec3(pixel_of(image, x, y)) - block(x, y));
                worst = std::max({worst, off.r, off.g, off.b});
                sum += (off.r + off.g + off.b) / 3;
            }
        const double mean = sum / (view.width * view.height);
        if (samples == 1) mean_of_1 = mean;
        if (samples == 4) CHECK(worst < 255 * 0.4);
        if (samples == 16) {
            mean_of_16 = mean;
            CHECK(worst < 255 * 0.15);
            CHECK(mean < 0.5);
        }
    }
    CHECK(mean_of_16 < mean_of_1 / 4);
}

TEST_CASE("many samples of one colour are that colour") {
    RendererFixture studio;
    plan::View view = view_from({0, 0, 5});
    for (const int samples : {1, 2, 3, 7, 16, 61}) {
        view.samples = samples;
        for (const int level : {0, 1, 100, 254, 255}) {
            view.background.color = glm::dvec3(level / 255.0);
            const scene::Image image = studio.draw(scene_of({}), view);
            CHECK(pixel_of(image, 11, 13) == glm::ivec3(level));
            CHECK(average(image) == doctest::Approx((level * 3 + 255) / 4.0));
        }
    }
}

TEST_CASE("a view without a scene shows the background, with its samples or without") {
    RendererFixture studio;
    plan::View view = view_from({0, 0, 5});
    view.background.color = {1, 0.6, 0};
    for (const int samples : {1, 3}) {
        view.samples = samples;
        studio.draw(scene_of({{1, quad(9), kPaint, glm::dmat4(1)}}), view);
        const scene::Image image = studio.draw(nullptr, view);
        CHECK(pixel_of(image, 48, 32) == glm::ivec3(255, 153, 0));
        CHECK(studio.stats.draws == 0);
    }
}

TEST_CASE("other states of the same scene change the picture and upload nothing") {
    RendererFixture studio;
    const plan::View view = view_from({0, 0, 5});
    const auto first =
        scene_of({{1, quad(1), kPaint, glm::dmat4(1)}, {2, box({1, 1, 1}), kPaint, moved_by({0, 1.5, 0})}});
    const scene::Image before = studio.draw(first, view);
    CHECK(studio.stats.uploads == 2);
    const long objects = gl::live_gl_objects();
    std::vector<scene::NodeState> states = first->nodes;
    for (scene::NodeState& state : states) state.material = scene::kNone;
    const auto painted = std::make_shared<const scene::PlacedScene>(scene::place(first->scene, states));
    CHECK(studio.draw(painted, view).rgba != before.rgba);
    studio.check(painted, view);
    CHECK(studio.stats.uploads == 0);
    states[1].active = false;
    studio.draw(std::make_shared<const scene::PlacedScene>(scene::place(first->scene, states)), view);
    CHECK(studio.stats.draws == 1);
    CHECK(studio.stats.uploads == 0);
    states = first->nodes;
    states[1].matrix = moved_by({0.5, 0, 0.2});
    studio.check(std::make_shared<const scene::PlacedScene>(scene::place(first->scene, states)), view);
    CHECK(studio.stats.uploads == 0);
    CHECK(gl::live_gl_objects() == objects);
    CHECK(studio.draw(first, view).rgba == before.rgba);
    CHECK(studio.stats.uploads == 0);
    // Another scene, though it holds the same: its own copy, and nothing left of the first.
    studio.draw(std::make_shared<const scene::PlacedScene>(scene::place(*first->scene)), view);
    CHECK(studio.stats.uploads == 2);
    CHECK(gl::live_gl_objects() == objects);
}

TEST_CASE("what a picture took") {
    RendererFixture studio;
    plan::View view = view_from({1, 2, 5});
    studio.draw(scene_of({}), view);
    CHECK(studio.stats.passes == 0);
    CHECK(studio.stats.draws == 0);
    CHECK(studio.stats.triangles == 0);
    CHECK(studio.stats.render_ms > 0);
    CHECK(studio.stats.readback_ms > 0);

    std::vector<Part> parts{{1, box({1, 1, 1}), kPaint, glm::dmat4(1)},
                            {2, sphere(1, 4), kPaint, glm::dmat4(1)},
                            {3, quad(1), kPaint, scaled_by({1, 1, 0})},
                            {4, scene::Geometry{}, kPaint, glm::dmat4(1)},
                            {5, quad(1), kPaint, glm::dmat4(1)}};
    parts.back().geometry.triangles.clear();
    studio.draw(scene_of(parts), view);
    CHECK(studio.stats.passes == 1);
    CHECK(studio.stats.draws == 3);
    CHECK(studio.stats.triangles == 12 + (4 * 8 * 2 - 2 * 8) + 2);
}

TEST_CASE("what does not show is not drawn") {
    RendererFixture studio;
    const auto draws = [&](const std::shared_ptr<scene::PlacedScene>& placed, double distance) {
        studio.draw(placed, view_from({0, 0, distance}));
        return studio.stats.draws;
    };
    const auto scene_with = [](scene::NodeType type, decltype(scene::Node::data) data, bool active) {
        scene::SceneParts parts;
        parts.geometries = {sphere(1, 4)};
        parts.nodes.push_back(
            {scene::Node{1, {}, type, scene::kNone, {}, active, glm::dmat4(1), std::move(data)}, 0});
        for (scene::Id id = 2; id <= 4; ++id)
            parts.nodes.push_back({scene::Node{id,
                                               {},
                                               scene::NodeType::geometry,
                                               scene::kNone,
                                               {},
                                               true,
                                               glm::dmat4(1),
                                               scene::GeometryData{0, scene::kNone}},
                                   1});
        return std::make_shared<scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
    };
    CHECK(draws(scene_with(scene::NodeType::assembly, scene::GroupData{}, true), 5) == 3);
    CHECK(draws(scene_with(scene::NodeType::assembly, scene::GroupData{}, false), 5) == 0);
    CHECK(draws(scene_with(scene::NodeType::switch_, scene::SwitchData{1}, true), 5) == 1);
    CHECK(draws(scene_with(scene::NodeType::switch_, scene::SwitchData{7}, true), 5) == 0);
    CHECK(draws(scene_with(scene::NodeType::lod, scene::LodData{{10, 20, 30}}, true), 15) == 1);
    CHECK(draws(scene_with(scene::NodeType::lod, scene::LodData{{10, 20, 30}}, true), 35) == 0);
}

TEST_CASE("a part at no finite place is left out, and the others are drawn") {
    RendererFixture studio;
    const plan::View view = view_from({1, 2, 5});
    std::vector<Part> parts = some_parts();
    const scene::Image without = studio.draw(scene_of(parts), view);
    for (const glm::dmat4& matrix :
         {glm::dmat4(1e300), moved_by({std::nan(""), 0, 0}), moved_by({0, 1e30, 0}),
          scaled_by({1, std::numeric_limits<double>::infinity(), 1})}) {
        parts.push_back({900 + static_cast<scene::Id>(parts.size()), sphere(1, 4), kPaint, matrix});
        CHECK(studio.draw(scene_of(parts), view).rgba == without.rgba);
    }
}

TEST_CASE("a chain of a million nodes is drawn") {
    constexpr scene::Id kCount = 1'000'000;
    scene::SceneParts parts;
    parts.geometries = {quad(1)};
    for (scene::Id id = 1; id < kCount; ++id)
        parts.nodes.push_back(
            {scene::Node{id, {}, scene::NodeType::assembly, scene::kNone, {}, true, moved_by({1, 0, 0}), {}},
             id - 1});
    parts.nodes.push_back({scene::Node{kCount,
                                       {},
                                       scene::NodeType::geometry,
                                       scene::kNone,
                                       {},
                                       true,
                                       glm::dmat4(1),
                                       scene::GeometryData{0, scene::kNone}},
                           kCount - 1});
    const auto placed =
        std::make_shared<scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
    RendererFixture studio;
    const double x = static_cast<double>(kCount - 1);
    CHECK(studio.check(placed, view_from({x, 0, 4}, {x, 0, 0})).surfaces > 300);
    CHECK(studio.stats.draws == 1);
}

TEST_CASE("the order in the file does not change a byte") {
    RendererFixture studio;
    std::vector<Part> parts = some_parts();
    parts.push_back({500, parts[3].geometry, material_of({0, 0, 1}), parts[3].matrix});  // a tie
    parts.push_back({5, parts[4].geometry, material_of({0, 0, 1}), parts[4].matrix});
    plan::View view = view_from({1, 2, 5});
    view.samples = 2;
    const scene::Image first = studio.draw(scene_of(parts), view);
    std::mt19937 random(3);
    for (int round = 0; round < 10; ++round) {
        std::shuffle(parts.begin(), parts.end(), random);
        CHECK(studio.draw(scene_of(parts), view).rgba == first.rgba);
    }
}

TEST_CASE("the same view gives the same bytes, whatever was drawn before") {
    RendererFixture studio;
    const auto scene = scene_of(some_parts());
    const plan::View view = view_from({1, 2, 5});
    const scene::Image first = studio.draw(scene, view);
    plan::View other = view_from({5, 1, 0});
    other.width = 33;
    other.samples = 3;
    studio.draw(scene_of({{1, quad(1), kPaint, scaled_by({-1, 1, 1})}}), other);
    CHECK(studio.draw(scene, view).rgba == first.rgba);
}

TEST_CASE("scenes come and go without leaving anything on the GPU") {
    RendererFixture studio;
    const plan::View view = view_from({1, 2, 5});
    std::vector<Part> parts = some_parts();
    for (int i = 0; i < 4; ++i)  // too large to share buffers
        parts.push_back({100 + i, sphere(0.5, 40), kPaint, moved_by({i, 0, 0})});
    studio.draw(scene_of(parts), view);
    const long before = gl::live_gl_objects();
    CHECK(before > 12);
    for (int i = 0; i < 20; ++i) studio.draw(scene_of(parts), view);
    CHECK(gl::live_gl_objects() == before);
    studio.draw(scene_of({}), view);
    CHECK(gl::live_gl_objects() < before - 12);
}

TEST_CASE("what draws is told, and a device that is not there is refused with a sentence") {
    {
        const renderer::Renderer renderer;
        CHECK(renderer.description().find("OpenGL") != std::string::npos);
        CHECK(renderer.description().starts_with("EGL "));
        CHECK(renderer.max_size() >= 8192);
    }
    CHECK(gl::live_gl_objects() == 0);
    for (const int device : {999, -1}) {
        try {
            const renderer::Renderer none(device);
            FAIL_CHECK("no exception");
        } catch (const std::runtime_error& error) {
            CHECK(std::string(error.what()).find("no EGL device " + std::to_string(device)) !=
                  std::string::npos);
        }
    }
    CHECK(gl::live_gl_objects() == 0);
}
