#include "reference/textures.hpp"

#include "gl/mipmaps.hpp"
#include "noise.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

/// A board in the plane z = 0 of its own space that shows a picture as it is.
struct Board {
    scene::Image image;
    glm::dvec2 scale{1}, offset{0};  ///< texcoord = position · scale + offset
    glm::dmat4 matrix{1};
    double half = 1000;
    scene::Sampler sampler = {};
};

std::shared_ptr<const scene::PlacedScene> scene_of(const Board& board, const scene::Material& given = {}) {
    scene::SceneParts parts;
    parts.textures = {{"board.png", board.image, false, board.sampler}};
    scene::Geometry geometry = quad(board.half);
    for (const glm::dvec3& position : geometry.positions)
        geometry.texcoords.emplace_back(glm::dvec2(position) * board.scale + board.offset);
    parts.geometries = {geometry};
    parts.materials = {given};
    parts.materials[0].texture = 0;
    parts.materials[0].sampler = board.sampler;
    parts.nodes = {{scene::Node{1,
                                {},
                                scene::NodeType::geometry,
                                scene::kNone,
                                {},
                                true,
                                board.matrix,
                                scene::GeometryData{0, 0}},
                    0}};
    return std::make_shared<scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
}

/// Lit so that a surface with that normal shows its diffuse colour.
plan::View plainly_lit(plan::View view, const glm::dvec3& normal) {
    view.light.headlight = false;
    view.light.type = scene::LightData::Type::directional;
    view.light.direction = -normal;
    return view;
}

/// Draws the board lit so that it shows its picture.
PictureMismatch check(const Board& board, plan::View view, RendererFixture& studio) {
    view = plainly_lit(view, glm::normalize(glm::dvec3(board.matrix[2])));
    view.scene = scene_of(board);
    return mismatch(view, studio.draw(view.scene, view));
}

constexpr glm::ivec2 kSizes[]{{1, 1}, {2, 2}, {5, 3}, {64, 64}, {37, 19}, {256, 8}, {1, 7}, {100, 75}};

}  // namespace

TEST_CASE("levels are means of what they cover, by area") {
    for (const glm::ivec2 size :
         {glm::ivec2(1, 1), {2, 2}, {3, 1}, {5, 3}, {37, 19}, {64, 16}, {7, 1000}, {255, 257}}) {
        CAPTURE(size.x);
        CAPTURE(size.y);
        const scene::Image image = noise(size.x, size.y);
        const std::vector<scene::Image> levels = gl::mip_levels(image);
        const reference::MipMap expected(image);
        REQUIRE(static_cast<int>(levels.size()) == expected.levels() - 1);
        double worst = 0;
        for (int level = 1; level < expected.levels(); ++level) {
            const scene::Image& found = levels[static_cast<std::size_t>(level - 1)];
            REQUIRE(glm::ivec2(found.width, found.height) ==
                    glm::ivec2(expected.width(level), expected.height(level)));
            for (int y = 0; y < found.height; ++y)
                for (int x = 0; x < found.width; ++x) {
                    const glm::dvec3 off = glm::abs(glm::dvec3(pixel_of(found, x, found.height - 1 - y)) -
                                                    glm::dvec3(expected.texel(level, x, y)) * 255.0);
                    worst = std::max({worst, off.r, off.g, off.b});
                }
        }
        CHECK(worst <= 0.501);
    }
}

TEST_CASE("a picture lies upright on a surface, and its first row is the bottom one") {
    RendererFixture studio;
    scene::Image image;
    image.resize(2, 2);
    image.rgba = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 0, 255};
    plan::View view = plainly_lit(pixel_view(6, 6), {0, 0, 1});
    const scene::Image drawn =
        studio.draw(scene_of({image, glm::dvec2(1.0 / 6), glm::dvec2(0.5), glm::dmat4(1), 4}), view);
    CHECK(pixel_of(drawn, 1, 4) == glm::ivec3(255, 0, 0));
    CHECK(pixel_of(drawn, 4, 4) == glm::ivec3(0, 255, 0));
    CHECK(pixel_of(drawn, 1, 1) == glm::ivec3(0, 0, 255));
    CHECK(pixel_of(drawn, 4, 1) == glm::ivec3(255, 255, 0));
}

TEST_CASE("magnified: bilinear, repeated in both directions") {
    RendererFixture studio;
    for (const glm::ivec2 size : kSizes)
        for (const double texel : {1.0, 1.7, 8.0, 33.3}) {
            CAPTURE(size.x);
            CAPTURE(size.y);
            CAPTURE(texel);
            const Board board{noise(size.x, size.y), 1.0 / (glm::dvec2(size) * texel), {0.3, -7.9}};
            const PictureMismatch off = check(board, pixel_view(96, 64), studio);
            CHECK_MESSAGE(off.worst <= 2, off.where);
        }
}

TEST_CASE(
    "magnified by the nearest texel, beyond the edges of the picture, too; and a mix of levels where it is "
    "minified") {
    RendererFixture studio;
    const auto wraps = {scene::Wrap::repeat, scene::Wrap::mirror, scene::Wrap::clamp};
    for (const scene::Wrap wrap : wraps)
        for (const glm::ivec2 size : kSizes)
            for (const double texel : {0.8, 1.7, 8.0, 33.3}) {
                CAPTURE(wrap);
                CAPTURE(size.x);
                CAPTURE(size.y);
                CAPTURE(texel);
                const Board board{noise(size.x, size.y),
                                  1.0 / (glm::dvec2(size) * texel),
                                  {0.301, -0.903},
                                  glm::dmat4(1),
                                  1000,
                                  {{wrap, wrap}, scene::Magnification::nearest}};
                const PictureMismatch off = check(board, pixel_view(96, 64), studio);
                CHECK_MESSAGE(off.worst <= 2, off.where);
            }
}

TEST_CASE("minified: trilinear at the level of the pixel's longer side") {
    RendererFixture studio;
    for (const glm::ivec2 size : kSizes)
        for (const glm::dvec2 texels :
             {glm::dvec2(1.3), {2, 2}, {1, 3.7}, {5, 0.2}, {4, 4}, {11.3, 7}, {200, 3}}) {
            CAPTURE(size.x);
            CAPTURE(size.y);
            CAPTURE(texels.x);
            CAPTURE(texels.y);
            const Board board{noise(size.x, size.y), texels / glm::dvec2(size), {0.3, -7.9}};
            const PictureMismatch off = check(board, pixel_view(96, 64), studio);
            CHECK(off.rms <= 1);
            CHECK_MESSAGE(off.worst <= 2, off.where);
        }
}

TEST_CASE("minified on a tilted plane, up to its horizon") {
    RendererFixture studio;
    for (const double tilt : {20.0, 60.0, 80.0})
        for (const scene::Image& image : {noise(128, 128), cloudy(300, 170), noise(37, 19)}) {
            CAPTURE(tilt);
            CAPTURE(image.width);
            const glm::dmat4 tilted = turned_by(25, {0, 0, 1}) * turned_by(-tilt, {1, 0, 0});
            plan::View view = view_from({0, 0, 3});
            view.width = 240;
            view.height = 160;
            const PictureMismatch off = check({image, {0.35, 0.5}, {0.1, 0.2}, tilted}, view, studio);
            CHECK(off.compared > 20000);
            CHECK(off.rms <= 1);
        }
}

TEST_CASE("pictures of extreme sizes") {
    RendererFixture studio;
    for (const glm::ivec2 size : {glm::ivec2(16384, 16), {3, 16384}, {20001, 5}})
        for (const double texels : {0.1, 1.0, 2.5, 300.0}) {
            CAPTURE(size.x);
            CAPTURE(texels);
            // One that is larger than the driver takes lacks its finest level, or two.
            if (size.x > 16384 && texels < 2) continue;
            const PictureMismatch off = check({cloudy(size.x, size.y), texels / glm::dvec2(size), {0.3, 0.4}},
                                              pixel_view(96, 64), studio);
            CHECK_MESSAGE(off.worst <= 2, off.where);
        }
}

TEST_CASE("texture coordinates far from zero show the same") {
    RendererFixture studio;
    const scene::Image image = noise(32, 32);
    const plan::View view = plainly_lit(pixel_view(64, 64), {0, 0, 1});
    // The corners' own coordinates are exact in float.
    const Board near{image, glm::dvec2(1.0 / 64), {0, 0}, glm::dmat4(1), 64};
    Board far = near;
    far.offset = {1 << 20, -(1 << 21)};
    const scene::Image found = studio.draw(scene_of(far), view), wanted = studio.draw(scene_of(near), view);
    CHECK(found.rgba == wanted.rgba);
}

TEST_CASE("a texture takes the place of the diffuse colour and of nothing else") {
    RendererFixture studio;
    scene::Image image;
    image.resize(1, 1);
    image.rgba = {51, 102, 204, 255};
    scene::Material material = material_of({0.9, 0.1, 0.5}, {0.2, 0.3, 0.1}, 7);
    material.ambient = {0.05, 0.02, 0.1, 1};
    material.emission = {0.01, 0.1, 0.02, 1};
    plan::View view = view_from({1, 2, 4});
    const auto textured = scene_of({image, glm::dvec2(1), glm::dvec2(0), glm::dmat4(1), 2}, material);
    const scene::Image found = studio.draw(textured, view);
    scene::Material painted = material;
    painted.diffuse = {51.0 / 255, 102.0 / 255, 204.0 / 255, 1};
    view.scene = vrut::scene_of({{1, quad(2), painted, glm::dmat4(1)}});
    const PictureMismatch off = mismatch(view, found);
    CHECK_MESSAGE(off.worst <= 1, off.where);
    CHECK(off.surfaces > 400);

    // Neither the stylized drawing nor edges show it.
    for (const bool wireframe : {false, true}) {
        plan::View plain = view;
        plain.mode = wireframe ? plan::DrawMode::realistic : plan::DrawMode::stylized;
        plain.wireframe = wireframe;
        CHECK(studio.draw(textured, plain).rgba ==
              studio.draw(vrut::scene_of({{1, quad(2), material, glm::dmat4(1)}}), plain).rgba);
    }
}

TEST_CASE("geometry without texture coordinates shows no texture, and flat corners keep theirs") {
    RendererFixture studio;
    const plan::View view = view_from({1, 2, 4});
    scene::Image holes = noise(8, 8);
    for (std::size_t i = 3; i < holes.rgba.size(); i += 4) holes.rgba[i] = holes.rgba[i - 1];
    const Board board{holes, glm::dvec2(0.4), glm::dvec2(0.5), glm::dmat4(1), 2};
    const auto with = scene_of(board);
    const auto drawn = [&](bool normals, bool texcoords) {
        scene::SceneParts parts;
        parts.textures = with->scene->textures();
        parts.textures[0].transparent = true;
        parts.materials = with->scene->materials();
        parts.geometries = with->scene->geometries();
        if (!normals) parts.geometries[0].normals.clear();
        if (!texcoords) parts.geometries[0].texcoords.clear();
        parts.nodes = {{with->scene->nodes()[1], 0}};
        return studio.draw(
            std::make_shared<scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts)))), view);
    };
    const scene::Image smooth = drawn(true, true);
    CHECK(drawn(false, true).rgba == smooth.rgba);
    CHECK(drawn(true, false).rgba != smooth.rgba);
    CHECK(drawn(true, false).rgba ==
          studio.draw(vrut::scene_of({{1, quad(2), scene::Material(), glm::dmat4(1)}}), view).rgba);
}

TEST_CASE("a texture is uploaded once, when it is first drawn, and only then is its program made") {
    RendererFixture studio;
    scene::SceneParts parts;
    parts.textures = {
        {"a.png", noise(4, 4), false}, {"b.png", noise(9, 4), false}, {"c.png", noise(4, 4), false}};
    parts.geometries = {quad(1)};
    parts.geometries[0].texcoords.assign(4, glm::vec2(0.5));
    parts.materials.resize(3);
    parts.materials[1].texture = 0;
    parts.materials[2].texture = 1;
    for (scene::Id id = 1; id <= 5; ++id)
        parts.nodes.push_back({scene::Node{id,
                                           {},
                                           scene::NodeType::geometry,
                                           scene::kNone,
                                           {},
                                           true,
                                           glm::dmat4(1),
                                           scene::GeometryData{0, static_cast<scene::Index>(id % 3)}},
                               0});
    const auto scene =
        std::make_shared<const scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
    std::vector<scene::NodeState> states = scene->nodes;
    for (scene::NodeState& state : states) state.material = 0;
    const plan::View view = view_from({0, 0, 5});
    studio.draw(std::make_shared<const scene::PlacedScene>(scene::place(scene->scene, states)), view);
    CHECK(studio.stats.uploads == 1);
    const long objects = gl::live_gl_objects();
    studio.draw(scene, view);
    CHECK(studio.stats.uploads == 2);
    CHECK(studio.stats.passes == 1);
    CHECK(gl::live_gl_objects() == objects + 3);  // two textures, one program
    studio.draw(scene, view);
    CHECK(studio.stats.uploads == 0);
    CHECK(gl::live_gl_objects() == objects + 3);
}
