#include <random>

#include "noise.hpp"
#include "reference/textures.hpp"
#include "reference_image.hpp"

using namespace vrut;

namespace {

std::vector<scene::Texture> six(int size) {
    std::vector<scene::Texture> textures;
    for (unsigned i = 0; i < 6; ++i) textures.push_back({"", noise(size, size, i + 1), false});
    return textures;
}

constexpr std::array<scene::Index, 6> kSix{0, 1, 2, 3, 4, 5};

void check_shows(const reference::ReferenceImage& shown, const scene::Image& image) {
    REQUIRE(shown.color.size() * 4 == image.rgba.size());
    for (std::size_t i = 0; i < shown.color.size(); ++i)
        check_same(shown.color[i],
                   glm::dvec3(image.rgba[4 * i], image.rgba[4 * i + 1], image.rgba[4 * i + 2]) / 255.0, 1e-9);
}

glm::dvec3 texel_of(const std::vector<scene::Texture>& textures, std::size_t face, int x, int y) {
    const scene::Image& image = textures[face].image;
    const auto at = 4 * static_cast<std::size_t>(y * image.width + x);
    return glm::dvec3(image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]) / 255.0;
}

reference::CubeMap cube_of(const std::vector<scene::Texture>& textures) {
    return reference::CubeMap({&textures[0].image, &textures[1].image, &textures[2].image, &textures[3].image,
                               &textures[4].image, &textures[5].image});
}

constexpr std::array<glm::dvec3, 2> kStill{};

}  // namespace

TEST_CASE("nothing but a background") {
    plan::View view = picture({0, 0, 5}, {0, 0, 0}, 3, 2);
    for (const auto& scene : {std::shared_ptr<const scene::PlacedScene>(), scene_of({})}) {
        const reference::ReferenceImage shown = traced(scene, view);
        REQUIRE(shown.color.size() == 6);
        for (std::size_t i = 0; i < 6; ++i) {
            check_same(shown.color[i], plan::kDefaultBackground);
            CHECK(shown.node[i] == scene::kNone);
        }
    }
    CHECK(reference::image_of(traced(nullptr, view)).rgba ==
          std::vector<std::uint8_t>{230, 235, 242, 255, 230, 235, 242, 255, 230, 235, 242, 255,
                                    230, 235, 242, 255, 230, 235, 242, 255, 230, 235, 242, 255});
}

TEST_CASE("a picture fills the view, stretched and upright, its edges clamped") {
    plan::View view = picture({1, 2, 5}, {0, 0, 0}, 4, 3);
    view.background.texture = 0;
    const scene::Texture texture{"", noise(4, 3, 3), false};
    check_shows(traced(scene_of({}, {texture}), view), texture.image);

    scene::Texture two;
    two.image = {2, 1, {0, 0, 0, 255, 200, 200, 200, 255}};
    view.width = 8;
    view.height = 2;
    const reference::ReferenceImage wide = traced(scene_of({}, {two}), view);
    for (std::size_t i = 0; i < 16; ++i)
        check_same(
            wide.color[i],
            glm::dvec3(std::clamp((static_cast<double>(i % 8) + 0.5) / 4 - 0.5, 0.0, 1.0) * 200 / 255));
    view.width = view.height = 1;
    check_same(traced(scene_of({}, {two}), view).color[0], glm::dvec3(100 / 255.0));
}

TEST_CASE("a mirror shows the background's picture at the same pixel") {
    plan::View view = picture({0, 3, 5}, {0, 0, 0}, 4, 3);
    view.background.texture = 0;
    const scene::Texture texture{"", noise(4, 3, 3), false};
    scene::Material mirror = glowing({0, 0, 0});
    mirror.reflectivity = 1;
    const auto shown = traced(scene_of({{1, quad(50), mirror, glm::dmat4(1)}}, {texture}), view);
    CHECK(shown.node[5] != scene::kNone);
    check_shows(shown, texture.image);
}

TEST_CASE("each picture of a cube map is what a camera at the origin sees that way") {
    struct Way {
        glm::dvec3 view, up;
    };
    const std::array<Way, 6> ways{Way{{1, 0, 0}, {0, 1, 0}}, Way{{-1, 0, 0}, {0, 1, 0}},
                                  Way{{0, 1, 0}, {0, 0, 1}}, Way{{0, -1, 0}, {0, 0, -1}},
                                  Way{{0, 0, 1}, {0, 1, 0}}, Way{{0, 0, -1}, {0, 1, 0}}};
    for (const int size : {2, 5}) {
        const auto textures = six(size);
        for (std::size_t i = 0; i < 6; ++i) {
            CAPTURE(i);
            plan::View view;
            view.background.cube_map = kSix;
            view.camera.eye = {3, -7, 2};  // a cube map is infinitely far
            view.camera.focus = view.camera.eye + ways[i].view;
            view.camera.up = ways[i].up;
            view.camera.fov = 90;
            view.width = view.height = size;
            check_shows(traced(scene_of({}, textures), view), textures[i].image);
        }
    }
}

TEST_CASE("a cube map is filtered across its edges and at its corners") {
    const auto textures = six(4);
    const reference::CubeMap cube = cube_of(textures);
    // Between +x and +z, at the height of a texel's centre: +x has z to its right, +z has x to its left.
    for (int row = 0; row < 4; ++row) {
        const double y = (row + 0.5) / 2 - 1;
        const glm::dvec3 both = (texel_of(textures, 0, 3, row) + texel_of(textures, 4, 0, row)) / 2.0;
        check_same(cube.sample({1, y, 1}, kStill), both);
        check_same(cube.sample({1, y, 1 - 1e-9}, kStill), both, 1e-8);
        check_same(cube.sample({1 - 1e-9, y, 1}, kStill), both, 1e-8);
        // -x has -z to its right, -z has -x to its left.
        check_same(cube.sample({-1, y, -1}, kStill),
                   (texel_of(textures, 1, 3, row) + texel_of(textures, 5, 0, row)) / 2.0);
    }
    // +y: its top is +z, and +x to its right; the top of +z has +x to its left.
    for (int column = 0; column < 4; ++column) {
        const double x = (column + 0.5) / 2 - 1;
        check_same(cube.sample({x, 1, 1}, kStill),
                   (texel_of(textures, 2, column, 3) + texel_of(textures, 4, 3 - column, 3)) / 2.0);
        check_same(cube.sample({x, -1, -1}, kStill),
                   (texel_of(textures, 3, column, 3) + texel_of(textures, 5, column, 0)) / 2.0);
    }
    // At a corner three texels meet.
    const auto corner = [&](const glm::dvec3& direction, const glm::ivec2& in_x, const glm::ivec2& in_y,
                            const glm::ivec2& in_z) {
        const auto face = [&](int axis) {
            return static_cast<std::size_t>(2 * axis + (direction[axis] < 0));
        };
        check_same(cube.sample(direction, kStill), (texel_of(textures, face(0), in_x.x, in_x.y) +
                                                    texel_of(textures, face(1), in_y.x, in_y.y) +
                                                    texel_of(textures, face(2), in_z.x, in_z.y)) /
                                                       3.0);
    };
    corner({1, 1, 1}, {3, 3}, {3, 3}, {0, 3});
    corner({1, 1, -1}, {0, 3}, {3, 0}, {3, 3});
    corner({1, -1, 1}, {3, 0}, {3, 0}, {0, 0});
    corner({1, -1, -1}, {0, 0}, {3, 3}, {3, 0});
    corner({-1, 1, 1}, {0, 3}, {0, 3}, {3, 3});
    corner({-1, 1, -1}, {3, 3}, {0, 0}, {0, 3});
    corner({-1, -1, 1}, {0, 0}, {0, 0}, {3, 0});
    corner({-1, -1, -1}, {3, 0}, {0, 3}, {0, 0});
    // All edges: no jump.
    std::mt19937 random(1);
    std::uniform_real_distribution<double> across(-1, 1);
    for (int i = 0; i < 300; ++i) {
        glm::dvec3 direction(across(random));
        direction[i % 3] = i % 2 ? 1 : -1;
        direction[(i + 1) % 3] = i % 4 < 2 ? 1 : -1;
        direction[(i + 2) % 3] = across(random);
        glm::dvec3 beside = direction, other = direction;
        beside[i % 3] *= 1 + 1e-9;
        other[(i + 1) % 3] *= 1 + 1e-9;
        check_same(cube.sample(beside, kStill), cube.sample(other, kStill), 1e-7);
    }
}

TEST_CASE("a pixel that spans many texels of a cube map takes a coarser level of the face") {
    const auto textures = six(8);
    const reference::CubeMap cube = cube_of(textures);
    const reference::MipMap front(textures[5].image);
    // On -z, whose right is +x: 2 wide, 8 texels. A pixel of half its width is four texels.
    const glm::dvec3 center{-0.5, -0.5, -1};  // of the first texel of two
    check_same(cube.sample(center, {glm::dvec3(1, 0, 0), glm::dvec3(0, 0.1, 0)}),
               glm::dvec3(front.texel(2, 0, 0)));
    check_same(cube.sample(center * 3.0, {glm::dvec3(3, 0, 0), glm::dvec3(0, 0.3, 0)}),
               glm::dvec3(front.texel(2, 0, 0)));
    // A change along the direction itself is none.
    check_same(cube.sample(center, {glm::dvec3(1, 0, 0) + center * 5.0, center}),
               glm::dvec3(front.texel(2, 0, 0)));
    const double part = std::log2(3.0) - 1;
    check_same(
        cube.sample({0.25, 0.25, -1}, {glm::dvec3(0.75, 0, 0), glm::dvec3(0)}),
        glm::mix(glm::dvec3(front.texel(1, 2, 2)),
                 glm::dvec3(front.texel(2, 1, 1)) * 0.5625 + glm::dvec3(front.texel(2, 0, 0)) * 0.0625 +
                     glm::dvec3(front.texel(2, 0, 1)) * 0.1875 + glm::dvec3(front.texel(2, 1, 0)) * 0.1875,
                 part));
}

TEST_CASE("what is curved or transparent mixes the cube map along the reflected ray") {
    auto textures = six(1);  // one colour a face; texels of one face reach to the middle of the next
    scene::Material material = glowing({2, 0.5, 0});
    material.reflectivity = 0.25;
    plan::View view = look({0, 0, 5}, {0, 0, 0});
    const glm::dvec3 own(1, 0.5, 0);
    const Part ball{1, sphere(1, 64), material, turned_by(37, {1, 2, 3})};
    view.camera.fov = 1;
    check_same(traced(scene_of({ball}, textures), view).color[0], own);  // there is nothing to reflect
    // Straight on it is reflected back: the ball shows +z.
    view.background.cube_map = kSix;
    check_same(traced(scene_of({ball}, textures), view).color[0],
               own * 0.75 + texel_of(textures, 4, 0, 0) * 0.25, 0.02);
    // A slanted pane reflects to the side, in front of what is behind it.
    material.diffuse.a = 0.5;
    const Part pane{1, quad(1), material, turned_by(45, {0, 1, 0})};
    check_same(traced(scene_of({pane}, textures), view).color[0],
               (own * 0.75 + texel_of(textures, 0, 0, 0) * 0.25) * 0.5 + texel_of(textures, 5, 0, 0) * 0.5,
               1e-9);
    // In a mirror in the plane x = 0 the ball's other side is seen, and shows what is there.
    scene::Material mirror = glowing({0, 0, 0});
    mirror.reflectivity = 1;
    material.diffuse.a = 1;
    const Part far_ball{1, sphere(1, 64), material, moved_by({5, 0, 0})};
    const Part plate{2, quad(1), mirror, turned_by(90, {0, 1, 0})};
    view = look({10, 0, 0}, {0, 0, 0});
    view.camera.eye = {2, 0, 0};
    view.camera.fov = 1;
    view.background.cube_map = kSix;
    check_same(traced(scene_of({far_ball, plate}, textures), view).color[0],
               own * 0.75 + texel_of(textures, 1, 0, 0) * 0.25, 0.02);
    // A mirror alone shows the panorama the other way round.
    check_same(traced(scene_of({plate}, textures), view).color[0], texel_of(textures, 0, 0, 0), 1e-9);
}

TEST_CASE("curved reflective geometry that its matrix presses flat reflects the cube map") {
    const auto textures = six(1);
    scene::Geometry bent = quad(1);
    bent.positions[2].z = 0.01;
    bent.bounds.add(bent.positions[2]);
    scene::Material chrome = glowing({0, 0, 0});
    chrome.reflectivity = 1;
    // Seen from (-5, 0, 5), it reflects to (1, 0, 1); the ball stands there.
    const Part pressed{1, bent, chrome, scaled_by({1, 1, 0})};
    const Part ball{2, sphere(1, 8), glowing({0.2, 1, 0.4}), moved_by({3, 0.3, 3})};
    plan::View view = look({-3, 0.3, 3}, {0, 0.3, 0});
    view.background.cube_map = kSix;
    const glm::dvec3 between =
        (texel_of(textures, 0, 0, 0) + texel_of(textures, 4, 0, 0)) / 2.0;  // +x and +z
    check_same(traced(scene_of({pressed, ball}, textures), view).color[0], between, 1e-9);
    // A planar one is a mirror.
    const Part plate{1, quad(1), chrome, scaled_by({1, 1, 0})};
    check_same(traced(scene_of({plate, ball}, textures), view).color[0], {0.2, 1, 0.4}, 1e-9);
}
