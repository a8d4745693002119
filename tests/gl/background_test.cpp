#include "compare/difference.hpp"
#include "noise.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

std::array<scene::Image, 6> six(int size, scene::Image (*make)(int, int, unsigned) = noise) {
    std::array<scene::Image, 6> images;
    for (unsigned i = 0; i < 6; ++i) images[i] = make(size, size, 10 * (i + 1));
    return images;
}

/// The parts before backgrounds that `view` is given to show.
std::shared_ptr<const scene::PlacedScene> scene_with(const std::vector<scene::Image>& images,
                                                     const std::vector<Part>& given = {}) {
    std::vector<scene::Texture> textures;
    for (const scene::Image& image : images) textures.push_back({"background.png", image, false});
    return scene_of(given, std::move(textures));
}

plan::View before_picture(plan::View view) {
    view.background.texture = 0;
    return view;
}

plan::View in_panorama(plan::View view) {
    view.background.cube_map = {0, 1, 2, 3, 4, 5};
    return view;
}

std::vector<scene::Image> listed(const std::array<scene::Image, 6>& images) {
    return {images.begin(), images.end()};
}

PictureMismatch check(const std::vector<scene::Image>& images, plan::View view, RendererFixture& studio) {
    view.scene = scene_with(images);
    return mismatch(view, studio.draw(view.scene, view));
}

plan::View looking(const glm::dvec3& direction, const glm::dvec3& up, double fov, int width, int height) {
    plan::View view;
    view.camera.eye = {0, 0, 0};
    view.camera.focus = direction;
    view.camera.up = up;
    view.camera = scene::with_orthogonal_up(view.camera);
    view.camera.fov = fov;
    view.width = width;
    view.height = height;
    return view;
}

}  // namespace

TEST_CASE("a background picture fills the view, upright") {
    RendererFixture studio;
    const scene::Image image = noise(48, 32);
    plan::View view = view_from({1, 2, 3});
    view.width = image.width;
    view.height = image.height;
    CHECK(studio.draw(scene_with({image}), before_picture(view)).rgba == image.rgba);
}

TEST_CASE("a background picture is stretched, its edges clamped, and filtered") {
    RendererFixture studio;
    for (const glm::ivec2 size :
         {glm::ivec2(1, 1), {2, 2}, {5, 3}, {37, 19}, {96, 64}, {300, 170}, {16384, 16}})
        for (const glm::ivec2 picture : {glm::ivec2(96, 64), {31, 77}, {1, 500}, {5, 3}}) {
            CAPTURE(size.x);
            CAPTURE(size.y);
            CAPTURE(picture.x);
            plan::View view = view_from({1, 2, 3});
            view.width = picture.x;
            view.height = picture.y;
            const PictureMismatch off = check({noise(size.x, size.y)}, before_picture(view), studio);
            CHECK_MESSAGE(off.worst <= 2, off.where);
        }
}

TEST_CASE("each picture of a panorama is what a camera with 90 degrees sees") {
    RendererFixture studio;
    const std::array<scene::Image, 6> images = six(32);
    struct CubeFace {
        glm::dvec3 view, up;
    };
    const std::array<CubeFace, 6> faces{CubeFace{{1, 0, 0}, {0, 1, 0}}, CubeFace{{-1, 0, 0}, {0, 1, 0}},
                                        CubeFace{{0, 1, 0}, {0, 0, 1}}, CubeFace{{0, -1, 0}, {0, 0, -1}},
                                        CubeFace{{0, 0, 1}, {0, 1, 0}}, CubeFace{{0, 0, -1}, {0, 1, 0}}};
    for (std::size_t i = 0; i < 6; ++i) {
        CAPTURE(i);
        const scene::Image found = studio.draw(scene_with(listed(images)),
                                               in_panorama(looking(faces[i].view, faces[i].up, 90, 32, 32)));
        CHECK(compare::difference(found, images[i]).maximum() <= 1);
    }
}

TEST_CASE("a panorama is filtered across its edges and corners") {
    RendererFixture studio;
    for (const int size : {1, 2, 3, 8})
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z) {
                    if (std::abs(x) + std::abs(y) + std::abs(z) < 2) continue;
                    CAPTURE(size);
                    CAPTURE(x);
                    CAPTURE(y);
                    CAPTURE(z);
                    const plan::View view = looking({x, y, z}, {0.1, 1, 0.2}, 40, 48, 48);
                    const PictureMismatch off = check(listed(six(size)), in_panorama(view), studio);
                    CHECK_MESSAGE(off.worst <= 2, off.where);
                }
}

TEST_CASE("the corner of a cube map is the mean of its three texels") {
    RendererFixture studio;
    const std::array<scene::Image, 6> images = six(4);
    const auto scene = scene_with(listed(images));
    const auto check_corner = [&](const glm::dvec3& corner, const glm::ivec2& in_x, const glm::ivec2& in_y,
                                  const glm::ivec2& in_z) {
        // Column and row from the bottom left, in the pictures that look along x, y and z.
        const auto texel = [&](int axis, const glm::ivec2& at) {
            const scene::Image& image = images[static_cast<std::size_t>(2 * axis + (corner[axis] < 0))];
            return glm::dvec3(pixel_of(image, at.x, image.height - 1 - at.y)) / 255.0;
        };
        const plan::View view = in_panorama(looking(corner, {0.1, 1, 0.2}, 1, 1, 1));
        const glm::ivec3 off = pixel_of(studio.draw(scene, view), 0, 0) -
                               bytes_of((texel(0, in_x) + texel(1, in_y) + texel(2, in_z)) / 3.0);
        CHECK(std::max({std::abs(off.r), std::abs(off.g), std::abs(off.b)}) <= 1);
    };
    check_corner({1, 1, 1}, {3, 3}, {3, 3}, {0, 3});
    check_corner({1, 1, -1}, {0, 3}, {3, 0}, {3, 3});
    check_corner({1, -1, 1}, {3, 0}, {3, 0}, {0, 0});
    check_corner({1, -1, -1}, {0, 0}, {3, 3}, {3, 0});
    check_corner({-1, 1, 1}, {0, 3}, {0, 3}, {3, 3});
    check_corner({-1, 1, -1}, {3, 3}, {0, 0}, {0, 3});
    check_corner({-1, -1, 1}, {0, 0}, {0, 0}, {3, 0});
    check_corner({-1, -1, -1}, {3, 0}, {0, 3}, {0, 0});
}

TEST_CASE("a panorama is minified by the pixel's longer side, in any direction") {
    RendererFixture studio;
    for (const int size : {64, 100, 255})
        for (const double fov : {60.0, 120.0, 165.0})
            for (const glm::dvec3& direction : {glm::dvec3(0.01, 0.02, -1),
                                                {1, 0.3, 0.2},
                                                {-0.2, 0.9, 0.5},
                                                {0.3, -0.8, 0.1},
                                                {-1, -1, -1}}) {
                CAPTURE(size);
                CAPTURE(fov);
                CAPTURE(direction.x);
                const plan::View view = looking(direction, {0.1, 1, 0.2}, fov, 96, 64);
                const PictureMismatch off = check(listed(six(size)), in_panorama(view), studio);
                CHECK(off.rms <= 1);
                CHECK_MESSAGE(off.worst <= 3, off.where);
            }
}

TEST_CASE("a panorama is infinitely far away, and comes before a picture") {
    RendererFixture studio;
    plan::View view = in_panorama(looking({1, 0.3, 0.2}, {0, 1, 0}, 60, 96, 64));
    const auto scene = scene_with(listed(six(16, cloudy)));
    const scene::Image at_origin = studio.draw(scene, view);
    view.camera.eye += glm::dvec3(128, -512, 64);
    view.camera.focus += glm::dvec3(128, -512, 64);
    view.background.texture = 2;
    const scene::Image elsewhere = studio.draw(scene, view);
    CHECK(compare::difference(elsewhere, at_origin).maximum() <= 1);
}

TEST_CASE("the samples of a pixel see the background where they see what stands before it") {
    RendererFixture studio;
    const scene::Image image = noise(48, 32);
    plan::View view = pixel_view(96, 64);
    view.light.headlight = false;
    view.light.type = scene::LightData::Type::directional;
    // A board that fills the view with the same picture.
    scene::SceneParts parts;
    parts.textures = {{"board.png", image, false}};
    parts.geometries = {rectangle(-96, -64, 192, 128, view)};
    for (const glm::dvec3& position : parts.geometries[0].positions)
        parts.geometries[0].texcoords.emplace_back(glm::dvec2(position) / glm::dvec2(96, 64) + 0.5);
    parts.materials.resize(1);
    parts.materials[0].texture = 0;
    parts.nodes = {{scene::Node{1,
                                {},
                                scene::NodeType::geometry,
                                scene::kNone,
                                {},
                                true,
                                glm::dmat4(1),
                                scene::GeometryData{0, 0}},
                    0}};
    const auto board =
        std::make_shared<scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
    for (const int samples : {1, 3, 5}) {
        CAPTURE(samples);
        view.samples = samples;
        const scene::Image wanted = studio.draw(board, view),
                           found = studio.draw(scene_with({image}), before_picture(view));
        std::vector<bool> inner;  // at the edges the background is clamped, the board repeats
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x)
                inner.push_back(x >= 2 && x < view.width - 2 && y >= 2 && y < view.height - 2);
        CHECK(compare::difference(found, wanted, inner).maximum() <= 1);
    }
    view = in_panorama(looking({1, 0.3, 0.2}, {0, 1, 0}, 80, 32, 32));
    view.samples = 64;
    const PictureMismatch off = check(listed(six(16)), view, studio);
    CHECK_MESSAGE(off.worst <= 3, off.where);
}

TEST_CASE("backgrounds stand behind everything and cost one pass where they are no plain colour") {
    RendererFixture studio;
    const std::vector<Part> parts{{1, quad(0.01), material_of({0.5, 0.6, 0.7}), moved_by({0, 0, 4.9})},
                                  {2, quad(400), material_of({0.9, 0.2, 0.1}), moved_by({2000, 0, -5000})}};
    const plan::View plain = view_from({0, 0, 5});
    const auto scene = scene_with(listed(six(4)), parts), empty = scene_with(listed(six(4)));
    const scene::Image before_colour = studio.draw(scene, plain);
    CHECK(studio.stats.passes == 1);
    CHECK(studio.stats.uploads == 2);
    const long objects = gl::live_gl_objects();
    for (const plan::View& view : {before_picture(plain), in_panorama(plain)}) {
        const scene::Image background = studio.draw(empty, view);
        CHECK(studio.stats.passes == 1);
        CHECK(studio.stats.draws == 1);
        CHECK(studio.stats.uploads == 1);
        const scene::Image found = studio.draw(scene, view);
        CHECK(studio.stats.passes == 2);
        CHECK(studio.stats.draws == 3);
        int fronts = 0, wrong = 0;
        for (int y = 0; y < found.height; ++y)
            for (int x = 0; x < found.width; ++x) {
                const bool front = pixel_of(before_colour, x, y) != glm::ivec3(230, 235, 242);
                fronts += front;
                wrong += pixel_of(found, x, y) != pixel_of(front ? before_colour : background, x, y);
            }
        CHECK(fronts > 20);
        CHECK(wrong == 0);
    }
    studio.draw(scene, plain);
    CHECK(studio.stats.passes == 1);
    // The panorama, a program for it and one for pictures, a sampler, and an array without attributes.
    CHECK(gl::live_gl_objects() == objects + 5);
    // Pictures are the scene's: without one there is the colour.
    CHECK(pixel_of(studio.draw(nullptr, in_panorama(plain)), 5, 5) == glm::ivec3(230, 235, 242));
    CHECK(studio.stats.passes == 0);
}

TEST_CASE("the stylized drawing and the wireframe have the background, too") {
    RendererFixture studio;
    const auto scene = scene_with({noise(96, 64)}, {{1, quad(1), scene::Material(), glm::dmat4(1)}});
    for (const bool wireframe : {false, true}) {
        plan::View view = before_picture(view_from({0, 0, 5}));
        view.mode = wireframe ? plan::DrawMode::realistic : plan::DrawMode::stylized;
        view.wireframe = wireframe;
        CHECK(pixel_of(studio.draw(scene, view), 3, 4) == pixel_of(noise(96, 64), 3, 4));
    }
}
