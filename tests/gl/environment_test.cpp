#include <algorithm>
#include <cmath>

#include "noise.hpp"
#include "reference/reference.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

std::array<scene::Image, 6> six(int size, scene::Image (*make)(int, int, unsigned) = cloudy) {
    std::array<scene::Image, 6> images;
    for (unsigned i = 0; i < 6; ++i) images[i] = make(size, size, 10 * (i + 1));
    return images;
}

/// One part, and a panorama for it to reflect.
std::shared_ptr<const scene::PlacedScene> scene_of(const Part& part,
                                                   const std::array<scene::Image, 6>& images) {
    scene::SceneParts parts;
    for (const scene::Image& image : images) parts.textures.push_back({"face.png", image, false});
    parts.materials = {part.material};
    parts.geometries = {part.geometry};
    parts.nodes = {{scene::Node{part.id,
                                {},
                                scene::NodeType::geometry,
                                scene::kNone,
                                {},
                                true,
                                part.matrix,
                                scene::GeometryData{0, 0}},
                    0}};
    return std::make_shared<scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
}

scene::Material chrome(double reflectivity) {
    scene::Material material = material_of({0.3, 0.2, 0.1}, {0.5, 0.5, 0.5}, 20);
    material.reflectivity = reflectivity;
    return material;
}

plan::View in_panorama(plan::View view) {
    view.background.cube_map = {0, 1, 2, 3, 4, 5};
    return view;
}

PictureMismatch check(const Part& part, const std::array<scene::Image, 6>& images, const plan::View& view,
                      RendererFixture& studio) {
    plan::View shown = in_panorama(view);
    shown.scene = scene_of(part, images);
    return mismatch(shown, studio.draw(shown.scene, shown));
}

}  // namespace

TEST_CASE("a chrome ball reflects the panorama") {
    RendererFixture studio;
    for (const int size : {1, 4, 64, 512})
        for (const double reflectivity : {0.25, 1.0}) {
            CAPTURE(size);
            CAPTURE(reflectivity);
            const Part ball{1, sphere(1, 12), chrome(reflectivity),
                            moved_by({1, -0.5, 0.3}) * turned_by(40, {0, 1, 0})};
            plan::View view = view_from({2.5, 1.5, 3.5}, {1, -0.5, 0.3});
            const PictureMismatch off = check(ball, six(size), view, studio);
            CHECK(off.surfaces > 500);
            CHECK(off.rms <= 1);
        }
}

TEST_CASE("a small chrome ball reflects the panorama minified, to its rim") {
    RendererFixture studio;
    // Of more triangles than pixels along its rim.
    const auto scene = scene_of({1, sphere(1, 24), chrome(1), glm::dmat4(1)}, six(128));
    for (const glm::ivec2& size : {glm::ivec2(64, 48), glm::ivec2(24, 18)}) {
        CAPTURE(size.x);
        plan::View view = in_panorama(view_from({1, 1, 5}));
        view.width = size.x;
        view.height = size.y;
        view.scene = scene;
        const reference::ReferenceImage expected = reference::trace(view);
        const scene::Image drawn = studio.draw(scene, view);
        int pixels = 0;
        double worst = 0;
        for (std::size_t i = 0; i < expected.node.size(); ++i) {
            if (expected.node[i] == scene::kNone) continue;
            ++pixels;
            for (std::size_t k = 0; k < 3; ++k)
                worst = std::max(
                    worst, std::abs(drawn.rgba[4 * i + k] - 255 * expected.color[i][static_cast<int>(k)]));
        }
        CHECK(pixels > 50);
        CHECK(worst <= 5);
    }
}

TEST_CASE("flat faces of a reflective box reflect the panorama, turned and mirrored as it may be") {
    RendererFixture studio;
    const std::array<scene::Image, 6> images = six(32, noise);
    for (const double x : {1.0, -1.0}) {
        const Part part{1, box({1, 0.7, 0.8}), chrome(0.6), turned_by(30, {0, 1, 0}) * scaled_by({x, 1, 1})};
        const PictureMismatch off = check(part, images, view_from({2, 1.5, 3}), studio);
        CHECK(off.surfaces > 500);
        CHECK_MESSAGE(off.worst <= 3, off.where);
    }
}

TEST_CASE("a curved reflective part that its matrix presses flat reflects the panorama") {
    RendererFixture studio;
    scene::Geometry bent = quad(1);
    bent.positions[2].z = 0.5;
    bent.bounds.add(bent.positions[2]);
    const Part pressed{1, bent, chrome(0.6), turned_by(20, {0, 1, 0}) * scaled_by({1, 1, 0})};
    const PictureMismatch off = check(pressed, six(32), view_from({2, 1.5, 3}), studio);
    CHECK(off.surfaces > 300);
    CHECK_MESSAGE(off.worst <= 2, off.where);
}

TEST_CASE("a surface's own colour is clamped before the panorama is mixed in") {
    RendererFixture studio;
    scene::Material bright = chrome(0.5);
    bright.emission = {3, 3, 3, 1};
    scene::Image grey;
    grey.resize(1, 1);
    grey.rgba = {51, 51, 51, 255};
    std::array<scene::Image, 6> images;
    images.fill(grey);
    const scene::Image image = studio.draw(scene_of({1, sphere(1, 8), bright, glm::dmat4(1)}, images),
                                           in_panorama(view_from({0, 0, 3})));
    CHECK(pixel_of(image, 48, 32) == glm::ivec3(153));
}

TEST_CASE("what reflects no panorama is plain, and pays nothing for it") {
    RendererFixture studio;
    const std::array<scene::Image, 6> images = six(8);
    const plan::View plain = view_from({1, 1, 4});
    const auto picture = [&](const scene::Geometry& geometry, double reflectivity, const plan::View& view) {
        return studio.draw(scene_of({1, geometry, chrome(reflectivity), glm::dmat4(1)}, images), view);
    };
    const scene::Geometry ball = sphere(1, 8);
    const scene::Image matte = picture(ball, 0, plain);
    const long objects = gl::live_gl_objects();
    CHECK(picture(ball, 0.5, plain).rgba == matte.rgba);
    CHECK(gl::live_gl_objects() == objects);
    CHECK(studio.stats.uploads == 1);
    plan::View stylized = in_panorama(plain);
    stylized.mode = plan::DrawMode::stylized;
    CHECK(picture(ball, 0.5, stylized).rgba == picture(ball, 0, stylized).rgba);
    CHECK(picture(ball, 0.5, in_panorama(plain)).rgba != picture(ball, 0, in_panorama(plain)).rgba);
    // One pass for the background, one for the ball.
    CHECK(studio.stats.passes == 2);
}

TEST_CASE("the reference renderer sees the same textures, backgrounds and reflections") {
    RendererFixture studio;
    scene::SceneParts parts;
    for (const scene::Image& image : six(128)) parts.textures.push_back({"face.png", image, false});
    parts.textures.push_back({"board.png", cloudy(200, 133), false});
    scene::Image lace = cloudy(60, 40);
    for (std::size_t i = 3; i < lace.rgba.size(); i += 4) lace.rgba[i] = lace.rgba[i - 1];
    parts.textures.push_back({"lace.png", lace, true});
    parts.geometries = {sphere(0.8, 16), quad(3), box({0.4, 0.4, 0.4}), quad(0.7)};
    for (const glm::dvec3& position : parts.geometries[1].positions)
        parts.geometries[1].texcoords.emplace_back(position * 0.7 + 0.1);
    for (const glm::dvec3& position : parts.geometries[3].positions)
        parts.geometries[3].texcoords.emplace_back(position * 1.3);
    parts.materials = {chrome(0.8), material_of({1, 1, 1}, {0.2, 0.2, 0.2}, 10), chrome(0.5), chrome(0.3)};
    parts.materials[1].texture = 6;
    parts.materials[3].texture = 7;
    parts.materials[3].diffuse.a = 0.8;
    const glm::dmat4 places[] = {moved_by({0, 0.8, 0}), turned_by(-90, {1, 0, 0}),
                                 moved_by({1.3, 0.4, 0.6}) * turned_by(30, {0, 1, 0}),
                                 moved_by({-0.5, 0.7, 1.5})};
    for (scene::Index i = 0; i < 4; ++i)
        parts.nodes.push_back({scene::Node{i + 1,
                                           {},
                                           scene::NodeType::geometry,
                                           scene::kNone,
                                           {},
                                           true,
                                           places[i],
                                           scene::GeometryData{i, i}},
                               0});
    plan::View view = view_from({2, 1.7, 4}, {0, 0.4, 0});
    view.width = 240;
    view.height = 160;
    view.scene = std::make_shared<scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
    for (const bool all_around : {true, false}) {
        view.background = {};
        if (all_around)
            view.background.cube_map = {0, 1, 2, 3, 4, 5};
        else
            view.background.texture = 6;
        const PictureMismatch off = mismatch(view, studio.draw(view.scene, view));
        CHECK(off.compared > 30000);
        CHECK_MESSAGE(off.rms <= 0.5, off.where);
    }
}
