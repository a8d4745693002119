#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "reference/reference.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

/// Glass that looks the same under any light.
scene::Material glass(const glm::dvec3& color, double alpha, bool two_sided = false) {
    scene::Material material;
    material.emission = {color, 1};
    material.diffuse = {0, 0, 0, alpha};
    material.two_sided = two_sided;
    return material;
}

scene::Material paint(const glm::dvec3& color) { return glass(color, 1); }

glm::dvec3 over(const glm::dvec3& behind, const scene::Material& material) {
    return glm::mix(behind, glm::dvec3(material.emission), material.diffuse.a);
}

int distance(const glm::ivec3& a, const glm::ivec3& b) {
    const glm::ivec3 off = glm::abs(a - b);
    return std::max({off.x, off.y, off.z});
}

scene::Geometry joined(scene::Geometry first, const scene::Geometry& second) {
    const auto offset = static_cast<unsigned>(first.positions.size());
    first.positions.insert(first.positions.end(), second.positions.begin(), second.positions.end());
    first.normals.insert(first.normals.end(), second.normals.begin(), second.normals.end());
    for (const glm::uvec3& triangle : second.triangles) first.triangles.push_back(triangle + offset);
    for (const glm::dvec3& position : second.positions) first.bounds.add(position);
    return first;
}

/// With a pixel whose centre lies on the axis.
plan::View odd_view(const glm::dvec3& eye, const glm::dvec3& focus = glm::dvec3(0)) {
    plan::View view = view_from(eye, focus);
    view.width = 97;
    view.height = 65;
    return view;
}

/// The pixel in the middle, which shows `expected` within `tolerance`.
void check_middle(const scene::Image& image, const glm::dvec3& expected, int tolerance = 1) {
    const glm::ivec3 seen = pixel_of(image, image.width / 2, image.height / 2);
    CHECK_MESSAGE(distance(seen, bytes_of(expected)) <= tolerance, seen.x, " ", seen.y, " ", seen.z,
                  " instead of ", bytes_of(expected).x, " ", bytes_of(expected).y, " ", bytes_of(expected).z);
}

}  // namespace

TEST_CASE("layers of glass are composited from far to near, in any order of nodes, from both sides") {
    RendererFixture studio;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    int worst = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const int count = 1 + trial % 16;
        std::vector<scene::Id> ids(static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<scene::Id>(i) + 1;
        std::shuffle(ids.begin(), ids.end(), random);
        const double thin = trial % 3 == 0 ? 0.1 : 1;
        std::vector<Part> parts;
        parts.reserve(static_cast<std::size_t>(count));
        for (int i = 0; i < count; ++i)
            parts.push_back({ids[static_cast<std::size_t>(i)], quad(2),
                             glass({unit(random), unit(random), unit(random)}, thin * unit(random), true),
                             moved_by({0, 0, 0.2 * i})});
        const auto scene = scene_of(parts);
        for (const bool front : {true, false}) {
            const plan::View view = view_from({0.1, 0.2, front ? 9.0 : -7.0});
            glm::dvec3 expected = view.background.color;
            for (int i = 0; i < count; ++i)
                expected =
                    over(expected, parts[static_cast<std::size_t>(front ? i : count - 1 - i)].material);
            const scene::Image image = studio.draw(scene, view);
            worst = std::max(worst, distance(pixel_of(image, 48, 32), bytes_of(expected)));
        }
    }
    CHECK(worst <= 1);
}

TEST_CASE("all of a surface's colour is multiplied by alpha, highlight and emission too") {
    RendererFixture studio;
    scene::Material material = material_of({0.5, 0.3, 0.2}, {0.6, 0.7, 0.8}, 20);
    material.emission = {0.1, 0.05, 0, 1};
    for (const double alpha : {0.0, 0.02, 0.5, 0.98, 0.9999}) {
        CAPTURE(alpha);
        plan::View view = odd_view({0, 0, 5});
        material.diffuse.a = 1;
        view.scene = scene_of({{1, quad(1), material}});
        const reference::ReferenceImage opaque = reference::trace(view);
        const glm::dvec3 own = opaque.color[opaque.color.size() / 2];
        material.diffuse.a = alpha;
        check_middle(studio.draw(scene_of({{1, quad(1), material}}), view),
                     glm::mix(view.background.color, own, alpha));
        CHECK(studio.stats.passes == 1);
    }
    // A sum above 1 is clamped before it is multiplied.
    material = glass({3, 0.5, 0}, 0.5);
    check_middle(studio.draw(scene_of({{1, quad(1), material}}), odd_view({0, 0, 5})),
                 glm::mix(plan::kDefaultBackground, glm::dvec3(1, 0.5, 0), 0.5));
    // And so is the background before glass is blended over it.
    plan::View bright = odd_view({0, 0, 5});
    bright.background.color = {4, 0.5, 0};
    check_middle(studio.draw(scene_of({{1, quad(1), glass({0, 0, 1}, 0.5)}}), bright), {0.5, 0.25, 0.5});
}

TEST_CASE("glass shows what is behind it and is hidden by what is before it") {
    RendererFixture studio;
    const glm::dvec3 red(0.8, 0.1, 0.1), green(0.1, 0.7, 0.2);
    const auto scene = scene_of({{1, quad(1), glass(green, 0.4, true), moved_by({0, 0, 1})},
                                 {2, quad(1), paint(red), glm::dmat4(1)},
                                 {3, turned_inside_out(quad(1)), paint(red), glm::dmat4(1)}});
    check_middle(studio.draw(scene, odd_view({0, 0, 5})), glm::mix(red, green, 0.4));
    CHECK(studio.stats.passes == 2);
    check_middle(studio.draw(scene, odd_view({0, 0, -5})), red);
    // The back of one-sided glass is not drawn.
    const auto one_sided = scene_of({{1, quad(1), glass(green, 0.4)}});
    check_middle(studio.draw(one_sided, odd_view({0, 0, 5})), glm::mix(plan::kDefaultBackground, green, 0.4));
    check_middle(studio.draw(one_sided, odd_view({0, 0, -5})), plan::kDefaultBackground);
    // Mirrored, its front is still its front.
    const auto mirrored = scene_of({{1, quad(1), glass(green, 0.4), scaled_by({-1, 1, 1})}});
    check_middle(studio.draw(mirrored, odd_view({0, 0, 5})), glm::mix(plan::kDefaultBackground, green, 0.4));
    check_middle(studio.draw(mirrored, odd_view({0, 0, -5})), plan::kDefaultBackground);
}

TEST_CASE("of the same geometry in the same place the higher id is in front, whichever is glass") {
    RendererFixture studio;
    const glm::dvec3 red(0.8, 0.1, 0.1), green(0.1, 0.7, 0.2);
    const scene::Material pane = glass(green, 0.4, true), other = glass(red, 0.3, true);
    scene::Material solid = paint(red);
    solid.two_sided = true;
    const glm::dmat4 matrix = turned_by(20, {0, 1, 0}) * moved_by({0.1, 0.2, 0.3});
    // One geometry of two nodes.
    const auto twins = [&](const scene::Material& first, const scene::Material& second,
                           bool first_is_higher) {
        scene::SceneParts parts;
        parts.geometries = {quad(1)};
        parts.materials = {first, second};
        for (const scene::Index i : {0, 1})
            parts.nodes.push_back({scene::Node{(i == 0) == first_is_higher ? 9 : 5,
                                               {},
                                               scene::NodeType::geometry,
                                               scene::kNone,
                                               {},
                                               true,
                                               matrix,
                                               scene::GeometryData{0, i}},
                                   0});
        return std::make_shared<const scene::PlacedScene>(
            scene::place(*scene::Scene::build(std::move(parts))));
    };
    for (const double side : {5.0, -5.0}) {
        const plan::View view = odd_view({0, 0, side});
        const glm::dvec3 back = view.background.color;
        check_middle(studio.draw(twins(pane, other, true), view), over(over(back, other), pane));
        check_middle(studio.draw(twins(pane, other, false), view), over(over(back, pane), other));
        check_middle(studio.draw(twins(pane, solid, true), view), over(red, pane));
        check_middle(studio.draw(twins(pane, solid, false), view), red);
    }
}

TEST_CASE("coincident glass that a ray meets twice is in true order, and by id where it is at equal depth") {
    RendererFixture studio;
    const scene::Geometry ball = sphere(1, 12), jug = joined(sphere(1, 10), sphere(0.5, 8));
    for (const bool two_sided : {true, false})
        for (const scene::Geometry& geometry : {ball, jug}) {
            CAPTURE(two_sided);
            const auto scene = coincident_scene(
                geometry, {glass({0.9, 0.1, 0.1}, 0.5, two_sided), glass({0.1, 0.1, 0.9}, 0.4, true)});
            for (const glm::dvec3& eye : {glm::dvec3(0.1, 0.2, 5), glm::dvec3(-4, 1, 2)}) {
                plan::View view = view_from(eye);
                CHECK(studio.check(scene, view).surfaces > 400);
                view.scene = scene;
                const scene::Image expected = reference::image_of(reference::trace(view)),
                                   drawn = studio.draw(scene, view);
                int wrong = 0;
                for (int y = 0; y < view.height; ++y)
                    for (int x = 0; x < view.width; ++x)
                        wrong += distance(pixel_of(drawn, x, y), pixel_of(expected, x, y)) > 1;
                CHECK(wrong <= 3);  // an edge passes within a hair's breadth of the pixel's centre
            }
        }
}

TEST_CASE("glass around the eye is in front of glass outside") {
    RendererFixture studio;
    const scene::Material around = glass({0.2, 0.3, 0.9}, 0.5, true),
                          outside = glass({0.9, 0.2, 0.1}, 0.5, true);
    for (const bool around_first : {true, false}) {
        const auto scene = scene_of({{around_first ? 1 : 2, sphere(1, 12), around},
                                     {around_first ? 2 : 1, quad(2), outside, moved_by({0, 0, -3})}});
        const plan::View view = odd_view({0, 0, 0.5}, {0, 0, -3});
        check_middle(studio.draw(scene, view), over(over(view.background.color, outside), around));
    }
}

TEST_CASE("a thousand panes") {
    RendererFixture studio;
    std::vector<Part> parts;
    glm::dvec3 expected = plan::kDefaultBackground;
    for (int i = 0; i < 1000; ++i) {
        // 617 is coprime to 1000: ids in no order.
        const scene::Id id = 1 + i * 617 % 1000;
        const scene::Material material = glass({i % 7 / 6.0, i % 5 / 4.0, i % 3 / 2.0}, 0.05, true);
        parts.push_back({id, quad(20), material, moved_by({0, 0, -0.01 * i})});
    }
    for (std::size_t i = 1000; i-- > 0;) expected = over(expected, parts[i].material);
    const auto scene = scene_of(parts);
    check_middle(studio.draw(scene, odd_view({0, 0, 5})), expected);
    CHECK(studio.stats.passes == 1);
    CHECK(studio.stats.draws == 1000);
}

namespace {

/// Three long panes, each of which passes before the next and behind the one before it.
std::vector<Part> ring_of_three() {
    const std::array<glm::dvec3, 3> colors{{{0.9, 0.1, 0.1}, {0.1, 0.8, 0.2}, {0.2, 0.2, 0.9}}};
    std::vector<Part> parts;
    parts.reserve(3);
    for (int i = 0; i < 3; ++i)
        parts.push_back({3 - i, quad(1), glass(colors[static_cast<std::size_t>(i)], 0.4 + 0.1 * i, true),
                         turned_by(120 * i, {0, 0, 1}) * moved_by({0, 0.8, 0}) * turned_by(15, {0, 1, 0}) *
                             scaled_by({2, 0.4, 1})});
    return parts;
}

const std::array<glm::dvec3, 6> kEyes{
    {{0, 0, 5}, {0, 0, -5}, {3, 2, 4}, {-4, 1, 2}, {1, -3, -4}, {-2, 4, -3}}};

}  // namespace

TEST_CASE("panes that cross are right on both sides of the line in which they do") {
    RendererFixture studio;
    const auto scene = scene_of({{1, quad(1), glass({0.9, 0.1, 0.1}, 0.5, true), turned_by(40, {0, 1, 0})},
                                 {2, quad(1), glass({0.1, 0.2, 0.9}, 0.6, true), turned_by(-30, {0, 1, 0})},
                                 {3, quad(2), paint({0.7, 0.8, 0.3}), moved_by({0, 0, -2})}});
    for (const glm::dvec3& eye : kEyes) {
        CAPTURE(eye.x);
        CHECK(studio.check(scene, view_from(eye)).surfaces > 300);
        CHECK(studio.stats.passes == 2);
    }
}

TEST_CASE("a ring of three panes") {
    RendererFixture studio;
    for (const glm::dvec3& eye : kEyes) {
        CAPTURE(eye.x);
        CHECK(studio.check(scene_of(ring_of_three()), view_from(eye)).surfaces > 400);
    }
    CHECK(studio.draw(scene_of(ring_of_three()), view_from({0, 0, 5})).width == 96);
    CHECK(studio.stats.passes == 1);
}

namespace {

/// Lit from one side, so that front and back of a body differ.
plan::View lit_from_the_side(const glm::dvec3& eye) {
    plan::View view = view_from(eye);
    view.light.headlight = false;
    view.light.type = scene::LightData::Type::directional;
    view.light.direction = glm::normalize(glm::dvec3(-3, -2, -1));
    return view;
}

scene::Material lit_glass(double alpha, bool two_sided) {
    scene::Material material = material_of({0.9, 0.5, 0.2}, {0.6, 0.7, 0.8}, 5);
    material.diffuse.a = alpha;
    material.two_sided = two_sided;
    return material;
}

const Part kBackdrop{1, quad(2), paint({0.7, 0.8, 0.3}), moved_by({0, 0, -3})};

}  // namespace

TEST_CASE("a closed glass ball, drawn from both sides, is sorted") {
    RendererFixture studio;
    for (const bool mirrored : {false, true}) {
        const glm::dmat4 matrix = scaled_by({mirrored ? -1 : 1, 1, 1});
        const auto scene = scene_of({{2, sphere(1, 16), lit_glass(0.5, true), matrix}, kBackdrop});
        for (const glm::dvec3& eye : kEyes) {
            CHECK(studio.check(scene, lit_from_the_side(eye)).surfaces > 400);
            CHECK(studio.stats.passes == 2);
            CHECK(studio.stats.draws == 2);
        }
        CHECK(studio.check(scene, view_from({0.3, 0.2, 0.1}, {0, 0, -1})).surfaces > 2000);
    }
}

TEST_CASE("glass of more triangles than can be ordered once for all eyes") {
    RendererFixture studio;
    for (const bool two_sided : {false, true}) {
        const auto scene =
            scene_of({{2, sphere(1, 40), lit_glass(0.3, two_sided), glm::dmat4(1)}, kBackdrop});
        const std::size_t triangles = scene->scene->geometries()[0].triangles.size();
        CHECK(triangles * (two_sided ? 2 : 1) > 2048);
        CHECK(studio.check(scene, lit_from_the_side(kEyes[0])).surfaces > 400);
    }
}

TEST_CASE("glass that is hollow, and glass with a bay, is right from all around") {
    RendererFixture studio;
    const scene::Geometry tank = joined(box({1, 0.6, 0.8}), turned_inside_out(box({0.9, 0.5, 0.7})));
    const scene::Geometry hooks = joined(mapped(box({1, 0.2, 0.2}), 1, {0, -0.5, 0}),
                                         joined(mapped(box({0.2, 0.2, 0.9}), 1, {0.8, 0.1, 0}),
                                                mapped(box({0.2, 0.2, 0.9}), 1, {-0.8, 0.1, 0.6})));
    for (const bool two_sided : {false, true})
        for (const scene::Geometry& geometry : {tank, hooks}) {
            const auto scene = scene_of({{2, geometry, lit_glass(0.5, two_sided), glm::dmat4(1)}, kBackdrop});
            for (const glm::dvec3& eye : kEyes) {
                CAPTURE(eye.x);
                CHECK(studio.check(scene, lit_from_the_side(eye)).surfaces > 200);
                CHECK(studio.stats.draws == 2);
            }
        }
}

TEST_CASE("glass with a film on it, whichever comes first in the file") {
    RendererFixture studio;
    for (const double gap : {1e-3, 1e-4, 1e-5})
        for (const scene::Id outer : {1, 3})
            for (const double side : {1.0, -1.0}) {
                CAPTURE(gap);
                const double size = 1 + gap;
                const auto balls =
                    scene_of({{outer, sphere(1, 10), glass({0.9, 0.1, 0.1}, 0.5),
                               scaled_by({side * size, size, size})},
                              {2, sphere(1, 10), glass({0.1, 0.1, 0.9}, 0.5), scaled_by({side, 1, 1})}});
                CHECK(studio.check(balls, view_from({0, 0, 4})).surfaces > 400);
            }
}

TEST_CASE("glass that crosses itself") {
    RendererFixture studio;
    scene::Geometry across = quad(1, false);
    for (glm::dvec3& position : across.positions) position = {position.z, position.y, -position.x};
    const auto scene = scene_of({{2, joined(quad(1, false), across), lit_glass(0.5, true), glm::dmat4(1)}});
    for (const glm::dvec3& eye : {glm::dvec3(3, 2, 4), glm::dvec3(-4, 1, 2), glm::dvec3(1, -3, -4)})
        CHECK(studio.check(scene, lit_from_the_side(eye)).surfaces > 300);
    // Where it looks the same from everywhere, it need not be told apart.
    CHECK(studio.stats.draws == 2);
    const auto plain = scene_of({{2, joined(quad(1, false), across), glass({0.2, 0.3, 0.4}, 0.5, true)}});
    CHECK(studio.check(plain, view_from({3, 2, 4})).surfaces > 300);
    CHECK(studio.stats.draws == 1);
}

TEST_CASE("layers that do not fit into the budget are made in parts of the picture") {
    RendererFixture studio;
    std::vector<Part> parts;
    parts.reserve(24);
    for (int i = 0; i < 24; ++i)
        parts.push_back({1 + i * 7 % 24, quad(20),
                         glass({i % 7 / 6.0, i % 5 / 4.0, i % 3 / 2.0}, 0.1 + 0.03 * (i % 11), true),
                         turned_by(-30 + 60 * i / 23.0, {0.2, 1, 0})});
    const auto scene = scene_of(parts);
    CHECK(studio.check(scene, view_from({0, 0, 5})).surfaces > 1000);
    CHECK(studio.stats.passes >= 24 / 8);
    // So long a row of them that it is cut across.
    plan::View row = view_from({0, 0, 5});
    row.width = 256;
    row.height = 1;
    CHECK(studio.check(scene, row).surfaces > 50);
}

TEST_CASE("room for layers stays while panes cross in some pictures and not in others, and is given back") {
    RendererFixture studio;
    const auto crossing = scene_of({{1, quad(2), glass({1, 0, 0}, 0.5, true), turned_by(20, {0, 1, 0})},
                                    {2, quad(2), glass({0, 0, 1}, 0.5, true), turned_by(-20, {0, 1, 0})}});
    const plan::View towards = odd_view({0, 0.3, 6}), away = odd_view({0, 0.3, 6}, {0, 0.3, 12});
    studio.draw(crossing, towards);
    studio.draw(crossing, away);
    const long objects = gl::live_gl_objects();
    for (int i = 0; i < 3; ++i) {
        studio.draw(crossing, towards);
        studio.draw(crossing, away);
        CHECK(gl::live_gl_objects() == objects);
    }
    studio.draw(crossing, towards);
    CHECK(gl::live_gl_objects() == objects);
    for (int i = 0; i <= 100; ++i) studio.draw(crossing, away);
    CHECK(gl::live_gl_objects() == objects - 3);
}

TEST_CASE("the reference sees the same in rings and bodies of glass") {
    RendererFixture studio;
    std::vector<Part> parts = ring_of_three();
    parts.push_back({7, sphere(0.7, 12), lit_glass(0.4, true), moved_by({0.3, 0.2, -0.4})});
    parts.push_back({8, box({0.5, 0.5, 0.5}), lit_glass(0.3, false), turned_by(30, {1, 1, 0})});
    const auto scene = scene_of(parts);
    for (const glm::dvec3& eye : kEyes) {
        CAPTURE(eye.x);
        // Beside the axes, so that no crease lies exactly on centres of pixels.
        plan::View view = lit_from_the_side(eye + glm::dvec3(0.013, 0.007, 0));
        view.scene = scene;
        view.width = 240;
        view.height = 160;
        const scene::Image drawn = studio.draw(scene, view),
                           expected = reference::image_of(reference::trace(view));
        int beside = 0, wrong = 0;
        for (int y = 1; y < view.height - 1; ++y)
            for (int x = 1; x < view.width - 1; ++x) {
                const glm::ivec3 seen = pixel_of(drawn, x, y);
                if (distance(seen, pixel_of(expected, x, y)) <= 1) continue;
                // An edge passes within a hair's breadth of the pixel's centre.
                ++beside;
                int nearest = 255;
                for (const int dx : {-1, 0, 1})
                    for (const int dy : {-1, 0, 1})
                        nearest = std::min(nearest, distance(seen, pixel_of(expected, x + dx, y + dy)));
                wrong += nearest > 2;
            }
        CHECK(beside <= view.width * view.height / 2000);
        CHECK(wrong == 0);
    }
}
