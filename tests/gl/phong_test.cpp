#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

/// Everything at once, and no two channels alike.
scene::Material rich(double shininess) {
    scene::Material material = material_of({0.5, 0.3, 0.1}, {0.2, 0.3, 0.5}, shininess);
    material.ambient = {0.05, 0.1, 0.02, 1};
    material.emission = {0.02, 0.03, 0.1, 1};
    return material;
}

}  // namespace

TEST_CASE("a plane under the headlight") {
    RendererFixture studio;
    for (const double shininess : {0.0, 1.0, 7.5, 64.0, 1000.0, 10000.0}) {
        CAPTURE(shininess);
        const auto scene = scene_of({{1, quad(2), rich(shininess), glm::dmat4(1)}});
        for (const glm::dvec3& eye : {glm::dvec3(0, 0, 5), glm::dvec3(1, 2, 4), glm::dvec3(4, 0.5, 0.6)}) {
            const PictureMismatch result = studio.check(scene, view_from(eye));
            CHECK(result.surfaces > 400);
            CHECK(result.compared > 96 * 64 * 8 / 10);
        }
    }
}

TEST_CASE("a ball: normals are interpolated in space and made unit at the pixel") {
    RendererFixture studio;
    for (const double shininess : {0.0, 64.0, 10000.0}) {
        CAPTURE(shininess);
        const auto scene = scene_of({{1, sphere(1.5, 8), rich(shininess), turned_by(20, {1, 0, 0})}});
        CHECK(studio.check(scene, view_from({0, 1, 5})).surfaces > 1000);
        plan::View near = view_from({0, 0.5, 1.7}, {0.5, 0.5, 0});
        near.camera.fov = 100;
        CHECK(studio.check(scene, near).surfaces > 1000);
    }
}

TEST_CASE("a box without normals has flat faces") {
    RendererFixture studio;
    const auto scene =
        scene_of({{1, box({1, 0.7, 1.3}), rich(20), turned_by(30, glm::normalize(glm::dvec3(1, 2, 3)))}});
    for (const glm::dvec3& eye : {glm::dvec3(0, 0, 6), glm::dvec3(4, 3, 2), glm::dvec3(-3, -4, -2)})
        CHECK(studio.check(scene, view_from(eye)).surfaces > 500);
}

TEST_CASE("a ball without normals has flat faces too, and each keeps its own") {
    RendererFixture studio;
    const auto scene = scene_of({{1, sphere(1.8, 5, false), rich(30), glm::dmat4(1)}});
    CHECK(studio.check(scene, view_from({1, 1, 5})).surfaces > 400);
}

TEST_CASE("zero normals take the face's, corner by corner") {
    RendererFixture studio;
    scene::Geometry mixed = quad(2);
    mixed.normals = {{0, 0, 0}, {0, 1, 1}, {0, 0, 0}, {-1, 0, 0.5}};
    CHECK(studio.check(scene_of({{1, mixed, rich(10), turned_by(40, {0, 1, 0})}}), view_from({0, 0, 5}))
              .surfaces > 400);
    mixed.normals.assign(4, glm::vec3(0));
    CHECK(studio.check(scene_of({{1, mixed, rich(10), glm::dmat4(1)}}), view_from({1, 0, 5})).surfaces > 400);
}

TEST_CASE("normals of any length are directions") {
    RendererFixture studio;
    for (const float length : {1e-25f, 1e-3f, 7.f, 1e15f}) {
        CAPTURE(length);
        scene::Geometry geometry = quad(2);
        geometry.normals = {{0, 0, length}, {length, 0, length}, {0, 0, length}, {0, -length, length}};
        studio.check(scene_of({{1, geometry, rich(10), glm::dmat4(1)}}), view_from({0, 1, 5}));
    }
}

TEST_CASE("normals under stretching, shearing and mirroring matrices") {
    RendererFixture studio;
    glm::dmat4 shear(1);
    shear[1][0] = 0.8;
    shear[2][1] = -0.6;
    for (const glm::dmat4& matrix :
         {scaled_by({0.3, 1, 2}), shear, scaled_by({-1, 1, 1}), shear * scaled_by({1, -2, 0.5}),
          scaled_by({-1, -1, -1}), turned_by(70, {0, 0, 1}) * scaled_by({1, 1, 1e-3}),
          scaled_by({1, 1, 1e-9})}) {
        CHECK(studio.check(scene_of({{1, sphere(1, 6), rich(15), matrix}}), view_from({1, 1, 4})).surfaces >
              100);
        CHECK(studio.check(scene_of({{1, box({1, 1, 1}), rich(15), matrix}}), view_from({1, 1, 6})).surfaces >
              100);
    }
}

TEST_CASE("the headlight's colour and attenuation") {
    RendererFixture studio;
    const auto scene = scene_of({{1, quad(3), rich(20), glm::dmat4(1)}});
    plan::View view = view_from({1, 1, 3});
    view.light.color = {0.9, 0.5, 0.2, 0.1};  // its alpha means nothing
    studio.check(scene, view);
    for (const glm::dvec3& attenuation :
         {glm::dvec3(2, 0, 0), glm::dvec3(0, 0.5, 0), glm::dvec3(0.1, 0.2, 0.05), glm::dvec3(0, 0, 0.3),
          glm::dvec3(0, 0, 0), glm::dvec3(0.5, 0, 0), glm::dvec3(0, 1e15, 1e15)}) {
        CAPTURE(attenuation.y);
        view.light.attenuation = attenuation;
        studio.check(scene, view);
    }
    // A denominator below a millionth counts as one.
    const auto dim = scene_of({{1, quad(3), material_of({3e-7, 5e-7, 7e-7}), glm::dmat4(1)}});
    view.light.color = {1, 1, 1, 1};
    view.light.attenuation = {0, 0, 1e-9};
    studio.check(dim, view);
}

TEST_CASE("colours are clamped, not wrapped") {
    RendererFixture studio;
    scene::Material bright = material_of({3, 0.5, 0}, {0, 4, 0.5}, 2);
    bright.emission = {0, 0, 0.7, 1};
    bright.ambient = {0, 0, 0.6, 1};
    const auto scene = scene_of({{1, sphere(1.5, 8), bright, glm::dmat4(1)}});
    plan::View view = view_from({0, 0, 5});
    CHECK(studio.check(scene, view).surfaces > 500);
    view.light.color = {1e6, 1e6, 1e6, 1};
    studio.check(scene, view);
}

TEST_CASE("what no light falls on has its ambient and emission") {
    RendererFixture studio;
    scene::Geometry away = quad(2);
    away.normals.assign(4, glm::vec3(0, 0, -1));
    scene::Image image = studio.draw(scene_of({{1, away, rich(5), glm::dmat4(1)}}), view_from({0, 0, 4}));
    CHECK(pixel_of(image, 48, 32) == bytes_of({0.07, 0.13, 0.12}));
    away.normals.assign(4, glm::vec3(1, 0, 0));  // at right angles, and beyond on one side
    studio.check(scene_of({{1, away, rich(0), glm::dmat4(1)}}), view_from({0, 0, 4}));
}

TEST_CASE("the background's bytes") {
    RendererFixture studio;
    plan::View view = view_from({0, 0, 4});
    const auto all = [&](const glm::ivec3& bytes) {
        const scene::Image image = studio.draw(scene_of({}), view);
        bool same = true;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) same = same && pixel_of(image, x, y) == bytes;
        for (std::size_t i = 3; i < image.rgba.size(); i += 4) same = same && image.rgba[i] == 255;
        return same;
    };
    CHECK(all({230, 235, 242}));
    view.background.color = {0, 1, 0.6};
    CHECK(all({0, 255, 153}));
    view.background.color = {100.4 / 255, 100.6 / 255, 1e-9};
    CHECK(all({100, 101, 0}));
}
