#include <algorithm>
#include <cmath>
#include <tuple>

#include "compare/difference.hpp"
#include "mirror_scenes.hpp"
#include "noise.hpp"
#include "reference/reference.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;
using namespace vrut::mirror_scenes;

namespace {

auto counts(const plan::FrameStats& stats) { return std::tuple(stats.passes, stats.draws, stats.triangles); }

/// One geometry under one matrix, once for each material; ids rise from 1. Before them, node 9, a plate that
/// the mirror shows.
std::shared_ptr<const scene::PlacedScene> twins(const scene::Geometry& geometry,
                                                const std::vector<scene::Material>& materials) {
    scene::SceneParts parts;
    parts.geometries = {geometry, quad(9)};
    parts.materials = materials;
    parts.materials.push_back(paint({0, 1, 0}));
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const scene::GeometryData data{0, static_cast<scene::Index>(i)};
        parts.nodes.push_back({scene::Node{static_cast<scene::Id>(i) + 1,
                                           {},
                                           scene::NodeType::geometry,
                                           scene::kNone,
                                           {},
                                           true,
                                           turned_by(20, {0, 1, 0}),
                                           data},
                               0});
    }
    const scene::GeometryData data{1, static_cast<scene::Index>(materials.size())};
    parts.nodes.push_back(
        {scene::Node{9, {}, scene::NodeType::geometry, scene::kNone, {}, true, moved_by({0, 0, 8}), data},
         0});
    return std::make_shared<const scene::PlacedScene>(place(*scene::Scene::build(std::move(parts))));
}

int farthest_apart(const scene::Image& a, const scene::Image& b) {
    int worst = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) worst = std::max(worst, std::abs(a.rgba[i] - b.rgba[i]));
    return worst;
}

void check_middle(const scene::Image& image, const glm::dvec3& color) {
    const glm::ivec3 off = pixel_of(image, image.width / 2, image.height / 2) - bytes_of(color);
    for (int channel = 0; channel < 3; ++channel) CHECK(std::abs(off[channel]) <= 1);
}

}  // namespace

TEST_CASE("glass before a mirror and in it, composited by hand") {
    RendererFixture studio;
    const glm::dvec3 wall{0.9, 0.5, 0}, inside{0, 0.4, 1}, before{0.2, 1, 0.6}, own{0.3, 0.2, 0.1};
    const std::vector<Part> parts{
        {1, quad(2), paint(wall), moved_by({3, 0, 0}) * turned_by(90, {0, 1, 0})},
        {2, quad(2), paint(inside, 0.4), moved_by({2, 0, 0}) * turned_by(90, {0, 1, 0})},
        {3, quad(1), mirror_of(0.7, own), turned_by(45, {0, 1, 0})},
        {4, quad(0.5), paint(before, 0.25), moved_by({0, 0, 2})}};
    const auto expected = [&](double alpha) {
        const glm::dvec3 reflection = glm::mix(wall, inside, 0.4);
        return glm::mix(glm::mix(own, reflection, 0.7), before, alpha);
    };
    const plan::View view = view_from({0, 0, 5});
    check_middle(studio.draw(scene_of(parts), view), expected(0.25));
    check_middle(studio.draw(scene_of({parts[0], parts[1], parts[2]}), view), expected(0));
    // An opaque one hides it.
    const Part lid{5, quad(0.5), paint({0, 0, 1}), moved_by({0, 0, 2})};
    check_middle(studio.draw(scene_of({parts[0], parts[2], lid}), view), {0, 0, 1});
}

TEST_CASE("of a mirror and its twins the highest id is in front, and no twin is seen in the mirror") {
    RendererFixture studio;
    const plan::View view = view_from({0, 0, 5});
    scene::Geometry uneven = quad(1);  // flat enough
    uneven.positions[0].z += 6e-5;
    uneven.positions[2].z += 6e-5;
    const scene::Material mirror = mirror_of(1), red = paint({1, 0, 0}), blue = paint({0, 0, 1}, 0.5);
    for (const scene::Geometry& geometry : {quad(1), uneven}) {
        check_middle(studio.draw(twins(geometry, {mirror}), view), {0, 1, 0});
        check_middle(studio.draw(twins(geometry, {red, mirror}), view), {0, 1, 0});
        check_middle(studio.draw(twins(geometry, {mirror, red}), view), {1, 0, 0});
        check_middle(studio.draw(twins(geometry, {red, mirror, red}), view), {1, 0, 0});
        check_middle(studio.draw(twins(geometry, {mirror, blue}), view), {0, 0.5, 0.5});
        check_middle(studio.draw(twins(geometry, {blue, mirror}), view), {0, 1, 0});
        check_middle(
            studio.draw(twins(geometry, {mirror_of(0), mirror_of(1), mirror_of(0.5, {1, 1, 1})}), view),
            {0.5, 1, 0.5});
    }
}

TEST_CASE("a mirror that is not seen costs nothing, and its target goes with it") {
    RendererFixture studio;
    const plan::View view = view_from({0.5, 1.5, 5}, {0, 0.6, 0});
    const Part ball{2, sphere(0.6, 8), kRed, moved_by({0, 0.8, 0})};
    const auto place = [&](const glm::dvec3& at) {
        return scene_of({{1, quad(1), mirror_of(1), moved_by(at)}, ball});
    };
    const auto seen = place({0, 0.8, -1.5});
    const scene::Image alone = studio.draw(scene_of({ball}), view);
    const auto plain = counts(studio.stats);
    CHECK(std::get<0>(plain) == 1);
    studio.draw(seen, view);
    // Its surface three times: to see whether it shows, as the mask of its reflection, and as itself.
    CHECK(counts(studio.stats) == std::tuple(4, 5, std::get<2>(plain) * 2 + 6));
    const long with_target = gl::live_gl_objects();
    for (const glm::dvec3& at : {glm::dvec3(0, 0.8, 9), {0, 0.8, 5.5}, {9, 0, -1}, {-9, 0, -1}, {0, 9, -1}}) {
        const scene::Image image = studio.draw(place(at), view);
        CHECK(image.rgba == alone.rgba);
        CHECK(counts(studio.stats) == plain);
    }
    studio.draw(seen, view);
    CHECK(gl::live_gl_objects() == with_target);
    // Colours, depth, what holds them, and the query whether the mirror shows.
    plan::View away = view;
    away.camera.focus = {0, 0.6, 20};
    studio.draw(seen, away);
    CHECK(gl::live_gl_objects() == with_target - 4);
}

TEST_CASE("a mirror seen along its plane does not flicker") {
    RendererFixture studio;
    const Part ball{2, sphere(0.6, 8), kRed, moved_by({0, 0.3, 0})};
    const auto scene = scene_of({floor_mirror(1), ball});
    plan::View view = view_from({0, 0, 5});
    const auto at = [&](double height) {
        view.camera.eye.y = view.camera.focus.y = height;
        return view;
    };
    // With a row of pixels whose centres lie in the plane, and without.
    for (const int height : {64, 65}) {
        view.height = height;
        const scene::Image without = studio.draw(scene_of({ball}), at(0));
        for (const double off : {0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6})
            for (const double side : {1.0, -1.0}) {
                CAPTURE(off);
                CHECK(farthest_apart(studio.draw(scene, at(side * off)), without) <= 1);
            }
        for (int step = -40; step <= 40; ++step) {
            CAPTURE(step);
            studio.check(scene, at(step * 0.0023));
        }
    }
    view.scene = scene;
    at(0);
    CHECK(plan::plan_frame(view).scene.mirrors.empty());
}

TEST_CASE("mirrors of any size and far away") {
    RendererFixture studio;
    for (const double scale : {1.0, 1e-6, 1e6})
        for (const double far : {0.0, 1e7}) {
            CAPTURE(scale);
            CAPTURE(far);
            const glm::dvec3 offset = glm::dvec3(far, -far, far) * scale;
            const glm::dmat4 place = moved_by(offset) * scaled_by(glm::dvec3(scale));
            plan::View view = view_from(glm::dvec3(1, 2, 5) * scale + offset, offset);
            studio.check(scene_of({{1, quad(3), mirror_of(0.9), place * turned_by(-80, {1, 0, 0})},
                                   {2, sphere(0.6, 8), kRed, place * moved_by({-0.8, 0.2, 0})},
                                   {3, box({0.4, 0.4, 0.4}), kRed, place * moved_by({0.8, 0.6, 0})}}),
                         view);
        }
}

TEST_CASE("a curved reflective part is drawn like one that does not reflect") {
    RendererFixture studio;
    const plan::View view = view_from({1, 1, 5});
    const auto ball = [](double reflectivity) {
        return std::vector<Part>{{1, sphere(1, 8), mirror_of(reflectivity), glm::dmat4(1)},
                                 floor_mirror(2, 0.5)};
    };
    CHECK(studio.draw(scene_of(ball(1)), view).rgba == studio.draw(scene_of(ball(0)), view).rgba);
}

TEST_CASE("in a stylized picture mirrors are surfaces like others") {
    RendererFixture studio;
    for (const double side : {5.0, -5.0}) {
        plan::View view = view_from({1, 1, side});
        view.mode = plan::DrawMode::stylized;
        const auto plate = [&](double reflectivity) {
            scene::Material material = mirror_of(reflectivity);
            material.two_sided = false;
            return studio.draw(scene_of({{1, quad(1), material, glm::dmat4(1)}}), view).rgba;
        };
        CHECK(plate(1) == plate(0));
    }
}

TEST_CASE("of a hundred mirrors no more are drawn than a picture may have") {
    RendererFixture studio;
    studio.draw(scene_of(hundred_mirrors()), view_from({0, 0, 12}));
    CHECK(studio.stats.passes <= 1 + 2 * static_cast<int>(plan::kMaxMirrors));
}

TEST_CASE("the sixteen largest mirrors are drawn as the reference has them, the next reflects the cube map") {
    RendererFixture studio;
    std::vector<scene::Texture> sky;
    for (unsigned i = 0; i < 6; ++i) sky.push_back({"sky.png", cloudy(64, 64, i + 1), false});
    const auto smallest = static_cast<scene::Id>(plan::kMaxMirrors) + 1;
    std::vector<Part> parts;
    for (scene::Id id = 1; id <= smallest; ++id)
        parts.push_back(
            {id, quad(id == smallest ? 0.42 : 0.45), mirror_of(0.8),
             moved_by({static_cast<double>((id - 1) % 6) - 2.5, static_cast<double>((id - 1) / 6) - 1, 0})});
    const std::vector<Part> mirrors = parts;
    // Behind the eye, for all of them to reflect.
    parts.push_back({100, quad(40), paint({0, 1, 0}), moved_by({0, 0, 20})});
    plan::View view = view_from({0.1, 0.2, 9});
    view.background.cube_map = {0, 1, 2, 3, 4, 5};
    const scene::Image drawn = studio.draw(scene_of(parts, sky), view);
    const auto traced = [&](const std::vector<Part>& shown) {
        view.scene = scene_of(shown, sky);
        return reference::trace(view);
    };
    const reference::ReferenceImage all = traced(parts), in_sky = traced(mirrors);
    std::vector<bool> largest, last;
    for (const scene::Index node : all.node) {
        last.push_back(node == static_cast<scene::Index>(smallest));
        largest.push_back(node != scene::kNone && !last.back());
    }
    const auto off = [&](const reference::ReferenceImage& expected, const std::vector<bool>& pixels) {
        const compare::Difference difference =
            compare::difference(drawn, reference::image_of(expected), pixels);
        CHECK(difference.count() > 30);
        return difference;
    };
    CHECK(off(all, largest).maximum() <= 2);
    CHECK(off(in_sky, last).maximum() <= 2);
    CHECK(off(all, last).share_above(50) > 0.9);
}
