#include "reference/textures.hpp"

#include "noise.hpp"
#include "plan/frame_plan.hpp"
#include "reference/shading.hpp"
#include "reference_image.hpp"

using namespace vrut;

namespace {

constexpr scene::Sampler kClamp{{scene::Wrap::clamp, scene::Wrap::clamp}};

scene::Image image_of_grays(int width, int height, const std::vector<int>& grays) {
    scene::Image image;
    image.resize(width, height);
    for (std::size_t i = 0; i < grays.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) image.rgba[4 * i + k] = static_cast<std::uint8_t>(grays[i]);
        image.rgba[4 * i + 3] = 255;
    }
    return image;
}

glm::dvec3 texel(const scene::Image& image, int x, int y) {
    const auto at = 4 * static_cast<std::size_t>(y * image.width + x);
    return glm::dvec3(image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]) / 255.0;
}

/// The picture on a plate that fills a view of so many pixels, `repeats` times across and up.
reference::ReferenceImage on_plate(const scene::Image& image, int width, int height,
                                   const glm::vec2& repeats = {1, 1}, const glm::vec2& from = {0, 0}) {
    const double w = width / 2.0, h = height / 2.0;
    scene::Geometry plate;
    plate.positions = {{-w, -h, 0}, {w, -h, 0}, {w, h, 0}, {-w, h, 0}};
    plate.triangles = {{0, 1, 2}, {0, 2, 3}};
    plate.texcoords = {from, from + glm::vec2(repeats.x, 0), from + repeats, from + glm::vec2(0, repeats.y)};
    for (const glm::dvec3& position : plate.positions) plate.bounds.add(position);
    scene::Material material = material_of({0.1, 0.9, 0.1});  // the picture replaces it
    material.texture = 0;
    plan::View view = pixels(width, height);
    view.light = directional({0, 0, -1});
    return traced(scene_of({{1, plate, material, glm::dmat4(1)}}, {{"", image, false}}), view);
}

constexpr std::array<glm::dvec2, 2> kMagnified{};

}  // namespace

TEST_CASE("a picture as large as what it is seen on is shown texel by texel, upright") {
    const scene::Image image = noise(8, 6);
    const reference::ReferenceImage shown = on_plate(image, 8, 6);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 8; ++x)
            check_same(shown.color[8 * static_cast<std::size_t>(y) + static_cast<std::size_t>(x)],
                       texel(image, x, y), 1e-9);
}

TEST_CASE("without texture coordinates there is no picture") {
    scene::Material material = material_of({0.1, 0.9, 0.1});
    material.texture = 0;
    plan::View view = look({0, 0, 5}, {0, 0, 0});
    check_same(
        traced(scene_of({{1, quad(1), material, glm::dmat4(1)}}, {{"", noise(2, 2), false}}), view).color[0],
        {0.1, 0.9, 0.1});
}

TEST_CASE("without texture coordinates the alpha of a picture counts as 1") {
    scene::Material material = glowing({0, 0, 0});
    material.texture = 0;
    material.reflectivity = 1;
    scene::Image holes = noise(2, 2);
    holes.rgba[3] = 0;
    const std::vector<Part> parts{
        {1, quad(1), material, glm::dmat4(1)},
        {2, quad(9), glowing({1, 0, 0}), moved_by({0, 0, 9}) * turned_by(180, {0, 1, 0})}};
    // It is opaque, and a mirror.
    const auto scene = scene_of(parts, {{"", holes, true}});
    const plan::View view = look({0, 0, 5}, {0, 0, 0});
    check_same(traced(scene, view).color[0], {1, 0, 0});
    CHECK(plan::count_classes(*scene) == plan::ClassCounts{1, 0, 1});
    plan::View shown = view;
    shown.scene = scene;
    CHECK(plan::plan_frame(shown).scene.mirrors.size() == 1);
}

TEST_CASE("magnified it is bilinear, and repeats") {
    const scene::Image image = noise(2, 3);
    for (const glm::vec2& from : {glm::vec2(0), glm::vec2(-7, 1024)}) {
        const reference::ReferenceImage shown = on_plate(image, 8, 12, {1, 1}, from);
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 8; ++x) {
                // Four pixels a texel: 1.5/4 or 0.5/4 from the nearest centre of a texel.
                const double u = (x + 0.5) / 4 - 0.5, v = (y + 0.5) / 4 - 0.5;
                const int i = static_cast<int>(std::floor(u)), k = static_cast<int>(std::floor(v));
                const double s = u - i, t = v - k;
                const auto at = [&](int a, int b) { return texel(image, (a + 2) % 2, (b + 3) % 3); };
                check_same(shown.color[8 * static_cast<std::size_t>(y) + static_cast<std::size_t>(x)],
                           (1 - s) * (1 - t) * at(i, k) + s * (1 - t) * at(i + 1, k) +
                               (1 - s) * t * at(i, k + 1) + s * t * at(i + 1, k + 1),
                           1e-9);
            }
    }
    // One number by hand: at u = 1/16 of two texels, 3/8 of the last one and 5/8 of the first.
    const reference::MipMap map(image_of_grays(2, 1, {0, 200}));
    CHECK(map.sample({1.0 / 16, 0.3}, kMagnified, scene::Sampler()).r == doctest::Approx(75 / 255.0));
    CHECK(map.sample({1.0 / 16, 0.3}, kMagnified, kClamp).r == 0);
    // Mirrored, u = 1.25 is 0.75, and -1.75 is 0.25.
    constexpr scene::Sampler kMirror{{scene::Wrap::mirror, scene::Wrap::repeat}};
    CHECK(map.sample({1.25, 0.3}, kMagnified, kMirror).r == doctest::Approx(200 / 255.0));
    CHECK(map.sample({-1.75, 0.3}, kMagnified, kMirror).r == 0);
    CHECK(map.sample({17.0 / 16, 0.3}, kMagnified, kMirror).r == doctest::Approx(200 / 255.0));
    CHECK(map.sample({std::nan(""), 1e300}, kMagnified, scene::Sampler()).a == 1);
}

TEST_CASE("by the nearest texel it is magnified without mixing, and so is its share between two levels") {
    const reference::MipMap map(image_of_grays(2, 1, {0, 200}));
    scene::Sampler sampler;
    sampler.magnification = scene::Magnification::nearest;
    const auto gray_at = [&](double u, const std::array<glm::dvec2, 2>& change) {
        return map.sample({u, 0.3}, change, sampler).r * 255;
    };
    CHECK(gray_at(1.0 / 16, kMagnified) == 0);
    CHECK(gray_at(0.49, kMagnified) == 0);
    CHECK(gray_at(0.51, kMagnified) == doctest::Approx(200));
    CHECK(gray_at(-0.01, kMagnified) == doctest::Approx(200));  // repeats
    CHECK(gray_at(std::nan(""), kMagnified) == 0);
    // Level 1 is the mean. A pixel is √2 texels long: half of each level.
    const std::array<glm::dvec2, 2> shrunk{{{std::sqrt(2.0) / 2, 0}, {0, 0}}};
    CHECK(gray_at(0.51, shrunk) == doctest::Approx((200 + 100) / 2.0));
    sampler.wraps = {scene::Wrap::mirror, scene::Wrap::clamp};
    CHECK(gray_at(1.25, kMagnified) == doctest::Approx(200));
    CHECK(gray_at(1.75, kMagnified) == 0);
    CHECK(gray_at(2.0, kMagnified) == 0);
    sampler.wraps = {scene::Wrap::clamp, scene::Wrap::clamp};
    CHECK(gray_at(1.0, kMagnified) == doctest::Approx(200));
    CHECK(gray_at(-3, kMagnified) == 0);
}

TEST_CASE("each level is a box filter of the one before, weighted by area") {
    const reference::MipMap five(image_of_grays(5, 1, {10, 20, 40, 80, 160}));
    REQUIRE(five.levels() == 3);
    CHECK(five.width(1) == 2);
    CHECK(five.height(1) == 1);
    CHECK(five.texel(1, 0, 0).r * 255 == doctest::Approx((10 + 20 + 40 / 2.0) / 2.5));
    CHECK(five.texel(1, 1, 0).r * 255 == doctest::Approx((40 / 2.0 + 80 + 160) / 2.5));
    CHECK(five.texel(2, 0, 0).r * 255 == doctest::Approx(62));

    const reference::MipMap upright(image_of_grays(2, 3, {0, 100, 30, 10, 60, 40}));
    REQUIRE(upright.levels() == 2);
    CHECK(upright.texel(1, 0, 0).r * 255 == doctest::Approx(40));
    const reference::MipMap long_one(image_of_grays(1, 8, {0, 10, 20, 30, 40, 50, 60, 70}));
    REQUIRE(long_one.levels() == 4);
    CHECK(long_one.height(1) == 4);
    CHECK(long_one.texel(1, 0, 2).r * 255 == doctest::Approx(45));
    CHECK(long_one.texel(3, 0, 0).r * 255 == doctest::Approx(35));
}

TEST_CASE("shrunk it is trilinear, by the longer side of the pixel in texels") {
    const reference::MipMap map(image_of_grays(4, 1, {0, 40, 80, 240}));  // 20 160; 90
    const auto at = [&](double u, const glm::dvec2& across, const glm::dvec2& up) {
        return map.sample({u, 0.5}, {across, up}, kClamp).r * 255;
    };
    CHECK(at(0.25, {0.5, 0}, {0, 0}) == doctest::Approx(20));  // two texels
    CHECK(at(0.25, {0, 0}, {0, 2}) == doctest::Approx(20));
    CHECK(at(0.25, {0.4, 0.3 * 4}, {0, 0}) == doctest::Approx(20));
    CHECK(at(0.25, {-0.4, 0.3 * 4}, {0, 0}) == doctest::Approx(20));
    CHECK(at(0.25, {1, 0}, {0.1, 0}) == doctest::Approx(90));
    CHECK(at(0.25, {70, 0}, {0.1, 0}) == doctest::Approx(90));
    CHECK(at(0.25, {std::nan(""), 0}, {0.1, 0}) == doctest::Approx(90));
    const double part = std::log2(3.0) - 1;
    CHECK(at(0.25, {0.75, 0}, {0, 0}) == doctest::Approx(20 + part * 70));
    CHECK(at(0.125, {0.3, 0}, {0, 0}) == doctest::Approx(std::log2(1.2) * 20));
    CHECK(at(0.125, {0.25, 0}, {0, 0}) == doctest::Approx(0));
}

TEST_CASE("a plate that is smaller than its picture shows its levels") {
    const scene::Image image = noise(32, 16);
    const reference::ReferenceImage shown = on_plate(image, 8, 8, {1, 0.5f});  // four texels across, one up
    const reference::MipMap map(image);
    REQUIRE(map.width(2) == 8);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            // Two pixels a texel of level 2 upwards; it starts half a texel below the first centre.
            const double v = (y + 0.5) / 4 - 0.5;
            const int k = static_cast<int>(std::floor(v));
            const auto row = [&](int b) { return glm::dvec3(map.texel(2, x, (b + 4) % 4)); };
            check_same(shown.color[8 * static_cast<std::size_t>(y) + static_cast<std::size_t>(x)],
                       glm::mix(row(k), row(k + 1), v - k), 1e-9);
        }
}

TEST_CASE("what a pixel spans is the derivative of what its ray meets") {
    using namespace vrut::reference;
    plan::View view = picture({2, 3, 4}, {0.1, 0.2, 0});
    scene::Geometry geometry = sphere(2, 6);
    for (const glm::dvec3& p : geometry.positions) geometry.texcoords.emplace_back(p.x * p.y, p.z + 2 * p.x);
    view.scene = scene_of({{1, geometry, two_sided(material_of({1, 1, 1})), scaled_by({1, -2, 0.5})}});
    const reference::TracedScene surfaces(view);
    const reference::RayDifferential ray{{0.1, 0.2, -0.3},
                                         glm::normalize(glm::dvec3(-2, -3, -4)),
                                         {glm::dvec3(0.02, 0.01, -0.03), glm::dvec3(0.01, -0.02, 0)},
                                         {glm::dvec3(0.01, 0.003, -0.01), glm::dvec3(-0.002, 0.01, 0.004)}};
    const auto hit = surfaces.closest_opaque_hit(ray);
    REQUIRE(hit);
    const reference::TracedInstance& part = surfaces.parts()[0];
    const reference::SurfaceInteraction interaction = reference::interaction_of(part, *hit, ray);
    for (std::size_t i = 0; i < 2; ++i) {
        constexpr double kStep = 1e-5;
        const auto moved = [&](double by) {
            reference::RayDifferential other = ray;
            other.origin += ray.dorigin_dxy[i] * by;
            other.direction = glm::normalize(ray.direction + ray.ddirection_dxy[i] * by);
            const auto there = surfaces.closest_opaque_hit(other);
            REQUIRE(there);
            REQUIRE(there->triangle == hit->triangle);
            return reference::interaction_of(part, *there, other);
        };
        const reference::SurfaceInteraction after = moved(kStep), before = moved(-kStep);
        const glm::dvec2 texcoord = (after.texcoord - before.texcoord) / (2 * kStep);
        const glm::dvec3 normal = (after.normal - before.normal) / (2 * kStep);
        CHECK(glm::distance(interaction.duv_dxy[i], texcoord) < 1e-6 * glm::length(texcoord));
        CHECK(glm::distance(interaction.dn_dxy[i], normal) < 1e-6 * glm::length(normal));
        CHECK(glm::length(texcoord) > 0.01);
    }
}

TEST_CASE("a pixel on a plate seen in a mirror spans what it would behind it") {
    // The mirrored plate's picture is a slope so fine that levels differ.
    scene::Geometry plate = quad(4);
    plate.texcoords = {{0, 0}, {9, 0}, {9, 9}, {0, 9}};
    scene::Material material = material_of({1, 1, 1});
    material.texture = 0;
    scene::Material mirror = glowing({0, 0, 0});
    mirror.reflectivity = 1;
    plan::View view = picture({-3, 0.5, 3}, {0, 0, 0});
    view.light = directional({0, 0, -1});
    const scene::Texture texture{"", noise(64, 64), false};
    const glm::dmat4 place = moved_by({5, 0, 3}) * turned_by(-60, {0, 1, 0.2});
    const auto with = traced(
        scene_of({{1, quad(40), mirror, glm::dmat4(1)}, {2, plate, two_sided(material), place}}, {texture}),
        view);
    plan::View behind = view;
    behind.light = directional({0, 0, 1});
    const auto should =
        traced(scene_of({{2, plate, two_sided(material), scaled_by({1, 1, -1}) * place}}, {texture}), behind);
    int compared = 0;
    for (std::size_t i = 0; i < with.color.size(); ++i) {
        if (with.node[i] != 1 || should.node[i] == scene::kNone) continue;
        check_same(with.color[i], should.color[i], 1e-9);
        ++compared;
    }
    CHECK(compared > 200);
}

TEST_CASE("the picture's alpha times the material's; its pixels let the background through") {
    scene::Image image = image_of_grays(2, 1, {255, 0});
    image.rgba[3] = 51;
    scene::Geometry plate = quad(1);
    plate.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    scene::Material material = material_of({1, 1, 1});
    material.diffuse.a = 0.5;
    material.texture = 0;
    plan::View view = look({-0.5, 0, 1}, {-0.5, 0, 0});
    view.camera.fov = 1;
    view.background.color = {0, 0, 1};
    const auto scene = scene_of({{1, plate, material, glm::dmat4(1)}}, {{"", image, true}});
    check_same(traced(scene, view).color[0], {0.1, 0.1, 0.1 + 0.9});
    view.camera.eye.x = view.camera.focus.x = 0.5;
    check_same(traced(scene, view).color[0], {0, 0, 0.5});
}
