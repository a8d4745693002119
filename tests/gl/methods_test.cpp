#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

/// The channel furthest off, of 255.
int apart(const scene::Image& a, const scene::Image& b) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    int worst = 0;
    for (std::size_t k = 0; k < a.rgba.size(); ++k) worst = std::max(worst, std::abs(a.rgba[k] - b.rgba[k]));
    return worst;
}

/// Part of the pixels with a channel off by more than 3 of 255.
double share_off(const scene::Image& a, const scene::Image& b) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    std::size_t off = 0;
    for (std::size_t k = 0; k < a.rgba.size(); k += 4) {
        const auto differs = [&](std::size_t i) { return std::abs(a.rgba[k + i] - b.rgba[k + i]) > 3; };
        off += differs(0) || differs(1) || differs(2);
    }
    return static_cast<double>(off) / static_cast<double>(a.width * a.height);
}

plan::View lit_at_vertices(plan::View view) {
    view.methods.light = plan::Methods::Lighting::vertex;
    return view;
}

plan::View sorted(plan::View view) {
    view.methods.transparency = plan::Methods::Transparency::sorted;
    return view;
}

plan::View lit_by(scene::LightData::Type type, plan::View view) {
    view.light.headlight = false;
    view.light.type = type;
    view.light.position = {3, 2, 4};
    view.light.direction = glm::normalize(glm::dvec3(-3, -2, -4));
    view.light.angle = 40;
    return view;
}

scene::Material shiny() { return material_of({0.5, 0.3, 0.1}, {0.2, 0.3, 0.5}, 10); }

scene::Material glass(const glm::dvec3& color, double alpha) {
    scene::Material material;
    material.emission = {color, 1};
    material.diffuse = {0, 0, 0, alpha};
    material.two_sided = true;
    return material;
}

plan::View by_lists(plan::View view) {
    view.methods.transparency = plan::Methods::Transparency::per_pixel_lists;
    return view;
}

plan::View anisotropic(plan::View view) {
    view.methods.texture_filter = plan::Methods::TextureFilter::anisotropic;
    return view;
}

/// Root of the mean square of how far the pixels of an image are from the means of those of one `factor`
/// times as wide and high.
double distance_from_finer(const scene::Image& image, const scene::Image& finer, int factor) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            glm::dvec3 mean(0);
            for (int k = 0; k < factor * factor; ++k)
                mean += glm::dvec3(pixel_of(finer, x * factor + k % factor, y * factor + k / factor));
            const glm::dvec3 off = glm::dvec3(pixel_of(image, x, y)) - mean / double(factor * factor);
            sum += glm::dot(off, off) / 3;
        }
    return std::sqrt(sum / (image.width * image.height));
}

/// A floor with stripes along the view and across, every other texel dark.
std::shared_ptr<const scene::PlacedScene> striped_floor(double alpha) {
    scene::Texture stripes{"stripes", {}};
    stripes.image.resize(64, 64);
    for (std::size_t k = 0; k < stripes.image.rgba.size(); ++k)
        stripes.image.rgba[k] = k % 4 == 3 || k / 4 % 2 == 0 || k / 256 % 8 == 0 ? 255 : 0;
    scene::Geometry floor = quad(20);
    floor.texcoords = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    scene::Material material = material_of({1, 1, 1});
    material.diffuse.a = alpha;
    material.texture = 0;
    return scene_of({{1, floor, material, turned_by(-90, {1, 0, 0})}}, {stripes});
}

}  // namespace

TEST_CASE("by default nothing is spared") {
    CHECK(plan::View().methods ==
          plan::Methods{plan::Methods::Lighting::pixel, plan::Methods::Transparency::exact});
}

TEST_CASE("light at the vertices comes close to light at the pixels where triangles are small") {
    RendererFixture studio;
    scene::Material both_sides = shiny();
    both_sides.two_sided = true;
    const plan::View view = view_from({0, 1, 4});
    for (const bool inside_out : {false, true}) {
        scene::Geometry ball = sphere(1.5, 90);
        if (inside_out) ball = turned_inside_out(ball);
        const auto scene = scene_of({{1, ball, inside_out ? both_sides : shiny(), glm::dmat4(1)}});
        for (const plan::View& lit : {view, lit_by(scene::LightData::Type::point, view),
                                      lit_by(scene::LightData::Type::directional, view)}) {
            const scene::Image at_pixels = studio.draw(scene, lit);
            CHECK(pixel_of(at_pixels, 48, 32) != bytes_of(plan::kDefaultBackground));
            const scene::Image at_vertices = studio.draw(scene, lit_at_vertices(lit));
            CHECK(at_vertices.rgba != at_pixels.rgba);
            // On its outline a triangle of two sides has vertices that are turned to different ones.
            CHECK(share_off(at_pixels, at_vertices) <= (inside_out ? 0.01 : 0));
        }
    }
}

TEST_CASE("light at the vertices of a large triangle misses what shines between them") {
    RendererFixture studio;
    const auto scene = scene_of({{1, quad(4), material_of({0.9, 0.9, 0.9}), glm::dmat4(1)}});
    plan::View view = lit_by(scene::LightData::Type::point, view_from({0, 0, 5}));
    view.light.position = {0, 0, 0.5};
    const scene::Image at_pixels = studio.draw(scene, view),
                       at_vertices = studio.draw(scene, lit_at_vertices(view));
    CHECK(pixel_of(at_pixels, 48, 32).x > 220);
    CHECK(pixel_of(at_vertices, 48, 32).x < 30);
    // What was drawn in between leaves nothing behind.
    CHECK(studio.draw(scene, view).rgba == at_pixels.rgba);
}

TEST_CASE("light at the vertices leaves pictures, panoramas, mirrors and glass as they are") {
    RendererFixture studio;
    // Under parallel light, without highlights, every vertex of a face is lit as its pixels are.
    scene::Texture checks{"checks", {}};
    checks.image.resize(8, 8);
    for (std::size_t k = 0; k < checks.image.rgba.size(); ++k)
        checks.image.rgba[k] = static_cast<std::uint8_t>(k % 4 == 3 ? 128 + k % 100 : k * 37 % 256);
    scene::Material printed = material_of({1, 1, 1}), pane = printed, chrome = material_of({0.4, 0.3, 0.2});
    printed.texture = pane.texture = 0;
    pane.diffuse.a = 0.5;
    pane.two_sided = true;
    chrome.reflectivity = 0.6;
    scene::Geometry poster = quad(1);
    poster.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const auto scene = scene_of({{1, poster, printed, moved_by({-1.2, 0, 0})},
                                 {2, poster, pane, turned_by(20, {0, 1, 0}) * moved_by({0.3, 0, 1})},
                                 {3, box({0.5, 0.5, 0.5}), chrome, moved_by({1.2, 0.8, 0})},
                                 {4, quad(1), chrome, turned_by(-40, {0, 1, 0}) * moved_by({1.2, -0.6, 0})},
                                 {5, quad(1), chrome, scaled_by({0.3, 0.3, 0}) * moved_by({0, -3, 0})}},
                                {checks});
    plan::View view = lit_by(scene::LightData::Type::directional, view_from({0, 0.5, 5}));
    for (const bool panorama : {false, true}) {
        if (panorama) view.background.cube_map = std::array<scene::Index, 6>{};
        CHECK(apart(studio.draw(scene, view), studio.draw(scene, lit_at_vertices(view))) <= 1);
    }
    view.selected = 1;
    CHECK(apart(studio.draw(scene, view), studio.draw(scene, lit_at_vertices(view))) <= 1);
    view.mode = plan::DrawMode::stylized;
    CHECK(apart(studio.draw(scene, view), studio.draw(scene, lit_at_vertices(view))) <= 1);
    // Edges are turned to the viewer, those of one-sided parts too.
    view.mode = plan::DrawMode::realistic;
    view.selected = scene::kNone;
    view.wireframe = true;
    view.camera = view_from({0, 0.5, -5}).camera;
    CHECK(apart(studio.draw(scene, view), studio.draw(scene, lit_at_vertices(view))) <= 1);
}

TEST_CASE("sorted transparency is exact where parts have an order") {
    RendererFixture studio;
    std::vector<Part> parts;
    for (int i = 0; i < 5; ++i)
        parts.push_back({1 + i * 3 % 5, quad(1), glass({i / 4.0, 0.5, 1 - i / 4.0}, 0.4),
                         turned_by(3.0 * i, {0, 1, 0}) * moved_by({0.1 * i, 0, 0.5 * i})});
    parts.push_back({9, sphere(0.5, 12), glass({0.1, 0.7, 0.2}, 0.5), moved_by({0, 0, 4})});
    const auto scene = scene_of(parts);
    for (const glm::dvec3& eye : {glm::dvec3(0.3, 0.2, 7), glm::dvec3(1, -2, -5)}) {
        const plan::View view = view_from(eye);
        CHECK(studio.check(scene, sorted(view)).surfaces > 300);
        CHECK(studio.draw(scene, view).rgba == studio.draw(scene, sorted(view)).rgba);
    }
}

TEST_CASE("sorted transparency draws panes that cross one after the other, each once") {
    RendererFixture studio;
    const auto scene = scene_of({{1, quad(1), glass({0.9, 0.1, 0.1}, 0.6), turned_by(40, {0, 1, 0})},
                                 {2, quad(1), glass({0.1, 0.2, 0.9}, 0.6), turned_by(-40, {0, 1, 0})},
                                 // It shows itself through itself, too.
                                 {3, sphere(0.6, 8), glass({0.1, 0.9, 0.3}, 0.5), moved_by({0, 0.3, 0})}});
    const plan::View view = view_from({0, 0, 5});
    const scene::Image exact = studio.draw(scene, view);
    CHECK(apart(exact, studio.draw(scene, sorted(view))) > 30);
    CHECK(studio.stats.draws == 3);
    CHECK(studio.stats.passes == 1);
    CHECK(studio.draw(scene, view).rgba == exact.rgba);
}

TEST_CASE("lists for all glass show what glass in order shows") {
    RendererFixture studio;
    std::vector<Part> parts;
    for (int i = 0; i < 5; ++i)
        parts.push_back({1 + i * 3 % 5, quad(1), glass({i / 4.0, 0.5, 1 - i / 4.0}, 0.4),
                         turned_by(3.0 * i, {0, 1, 0}) * moved_by({0.1 * i, 0, 0.5 * i})});
    parts.push_back({9, sphere(0.5, 12), glass({0.1, 0.7, 0.2}, 0.5), moved_by({0, 0, 4})});
    parts.push_back({10, box({0.3, 0.3, 0.3}), material_of({0.5, 0.5, 0.5}), moved_by({0.4, 0, 1.2})});
    const auto scene = scene_of(parts);
    for (const glm::dvec3& eye : {glm::dvec3(0.3, 0.2, 7), glm::dvec3(1, -2, -5)}) {
        const plan::View view = view_from(eye);
        const scene::Image in_order = studio.draw(scene, view);
        const int draws = studio.stats.draws;
        CHECK(studio.check(scene, by_lists(view)).surfaces > 300);
        CHECK(studio.stats.draws == draws + 1);
        CHECK(apart(in_order, studio.draw(scene, by_lists(view))) <= 1);
        CHECK(studio.draw(scene, view).rgba == in_order.rgba);
    }
}

TEST_CASE("an anisotropic filter keeps what a trilinear one blurs on a floor seen aslant") {
    RendererFixture studio;
    constexpr int kFiner = 8;
    for (const double alpha : {1.0, 0.6}) {
        const auto floor = striped_floor(alpha);
        plan::View view = lit_by(scene::LightData::Type::directional, view_from({0, 1, 12}, {0, -0.8, 0}));
        view.light.direction = {0, -1, 0};
        plan::View finer = view;
        finer.width *= kFiner;
        finer.height *= kFiner;
        const scene::Image truth = studio.draw(floor, finer), trilinear = studio.draw(floor, view);
        const double blurred = distance_from_finer(trilinear, truth, kFiner),
                     kept = distance_from_finer(studio.draw(floor, anisotropic(view)), truth, kFiner);
        CHECK(blurred > 5);
        CHECK(kept < 0.6 * blurred);
        // What was drawn in between leaves nothing behind.
        CHECK(studio.draw(floor, view).rgba == trilinear.rgba);
        // Seen straight on, both are one filter.
        view.camera = view_from({0, 9, 0.001}).camera;
        CHECK(apart(studio.draw(floor, view), studio.draw(floor, anisotropic(view))) <= 1);
    }
}
