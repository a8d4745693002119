#include <cmath>

#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

const glm::ivec3 kMarked{255, 153, 0};
const scene::Material kPaint = material_of({0.2, 0.3, 0.4});

int count(const scene::Image& image, const glm::ivec3& color) {
    int found = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) found += pixel_of(image, x, y) == color;
    return found;
}

/// How many pixels are not as they should be: marked within `width` of what `covers` outside of it, and as in
/// `plain` elsewhere.
template <class Covers>
int faults(const scene::Image& image, const scene::Image& plain, int width, const Covers& covers) {
    int wrong = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            bool near = false;
            for (int dy = -width; dy <= width; ++dy)
                for (int dx = -width; dx <= width; ++dx)
                    near = near || (dx * dx + dy * dy <= width * width && covers(x + dx, y + dy));
            const bool marked = near && !covers(x, y);
            wrong += pixel_of(image, x, y) != (marked ? kMarked : pixel_of(plain, x, y));
        }
    return wrong;
}

}  // namespace

TEST_CASE("an outline is as wide in pixels everywhere: two at a megapixel, more in larger pictures") {
    RendererFixture studio;
    struct OutlineCase {
        int height, width;
    };
    for (const OutlineCase& c : {OutlineCase{64, 1}, {432, 1}, {640, 2}, {864, 2}, {865, 3}, {1728, 4}}) {
        CAPTURE(c.height);
        plan::View view = pixel_view(60, c.height);
        const auto scene = scene_of({{1, rectangle(20, 30, 41, 50, view), kPaint, glm::dmat4(1)}});
        const scene::Image plain = studio.draw(scene, view);
        CHECK(studio.stats.passes == 1);
        view.selected = 1;
        const scene::Image image = studio.draw(scene, view);
        CHECK(studio.stats.passes == 3);
        CHECK(faults(image, plain, c.width,
                     [](int x, int y) { return x >= 20 && x < 41 && y >= 30 && y < 50; }) == 0);
        const int sides = 2 * (21 + 20) * c.width;
        CHECK(count(image, kMarked) >= sides);
        CHECK(count(image, kMarked) <= sides + 4 * c.width * c.width);
    }
}

TEST_CASE("an outline lies over everything, around all of a subtree together") {
    RendererFixture studio;
    plan::View view = pixel_view(80, 60);
    scene::SceneParts parts;
    parts.materials = {kPaint};
    parts.geometries = {rectangle(10, 10, 30, 30, view), rectangle(25, 20, 45, 40, view),
                        rectangle(60, 10, 70, 20, view), rectangle(5, 5, 75, 55, view),
                        rectangle(1, 1, 3, 3, view)};
    const auto add = [&](scene::Id id, scene::Id parent, scene::Index geometry, double z, bool active) {
        if (geometry == scene::kNone)
            parts.nodes.push_back(
                {scene::Node{
                     id, {}, scene::NodeType::assembly, scene::kNone, {}, active, moved_by({0, 0, z}), {}},
                 parent});
        else
            parts.nodes.push_back({scene::Node{id,
                                               {},
                                               scene::NodeType::geometry,
                                               scene::kNone,
                                               {},
                                               active,
                                               moved_by({0, 0, z}),
                                               scene::GeometryData{geometry, 0}},
                                   parent});
    };
    add(1, 0, scene::kNone, 0, true);
    add(2, 1, 0, 0, true);
    add(3, 1, scene::kNone, 0, true);
    add(4, 3, 1, 0, true);
    add(5, 3, 4, 0, false);  // does not show
    add(6, 0, 2, 0, true);
    add(7, 0, 3, 1e-6, true);  // the curtain before it all
    add(8, 0, scene::kNone, 0, true);
    const auto scene =
        std::make_shared<const scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
    const scene::Image plain = studio.draw(scene, view);
    const auto first = [](int x, int y) { return x >= 10 && x < 30 && y >= 10 && y < 30; };
    const auto second = [](int x, int y) { return x >= 25 && x < 45 && y >= 20 && y < 40; };
    const auto third = [](int x, int y) { return x >= 60 && x < 70 && y >= 10 && y < 20; };
    const auto select = [&](scene::Id id) {
        view.selected = scene->scene->find_node(id);
        return studio.draw(scene, view);
    };
    CHECK(faults(select(1), plain, 1, [&](int x, int y) { return first(x, y) || second(x, y); }) == 0);
    CHECK(studio.stats.draws == 2 + 2 + 2 + 2 + 2);
    CHECK(faults(select(2), plain, 1, first) == 0);
    CHECK(faults(select(3), plain, 1, second) == 0);
    CHECK(faults(select(6), plain, 1, third) == 0);
    // Nothing that shows: nothing is drawn for it.
    for (const scene::Id id : {5, 8}) {
        CHECK(select(id).rgba == plain.rgba);
        CHECK(studio.stats.passes == 1);
    }
    CHECK(faults(select(0), plain, 1, [](int x, int y) { return x >= 5 && x < 75 && y >= 5 && y < 55; }) ==
          0);
}

TEST_CASE("what is selected shows through what stands before it, as if that were not there") {
    RendererFixture studio;
    plan::View view = pixel_view(80, 60);
    const scene::Material red = material_of({0.9, 0, 0}), green = material_of({0, 0.9, 0}),
                          blue = material_of({0, 0, 0.9});
    scene::SceneParts parts;
    parts.materials = {red, green, blue};
    parts.geometries = {rectangle(10, 10, 30, 30, view), rectangle(5, 5, 75, 55, view)};
    const auto add = [&](scene::Id id, scene::Id parent, scene::Index geometry, scene::Index material,
                         const glm::dvec3& at) {
        parts.nodes.push_back({scene::Node{id,
                                           {},
                                           scene::NodeType::geometry,
                                           scene::kNone,
                                           {},
                                           true,
                                           moved_by(at),
                                           scene::GeometryData{geometry, material}},
                               parent});
    };
    parts.nodes.push_back(
        {scene::Node{1, {}, scene::NodeType::assembly, scene::kNone, {}, true, glm::dmat4(1), {}}, 0});
    add(2, 1, 0, 0, {0, 0, 0.01});  // the nearer of two that are selected, by the lower id
    add(3, 1, 0, 1, {10, -10, 0});
    add(4, 0, 1, 2, {0, 0, 0.02});  // the curtain before it all
    const auto scene =
        std::make_shared<const scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
    std::vector<scene::NodeState> states = scene->nodes;
    states[static_cast<std::size_t>(scene->scene->find_node(4))].active = false;
    const auto open = std::make_shared<const scene::PlacedScene>(scene::place(scene->scene, states));
    for (const plan::DrawMode mode : {plan::DrawMode::realistic, plan::DrawMode::stylized}) {
        CAPTURE(static_cast<int>(mode));
        view.mode = mode;
        view.selected = scene::kNone;
        const scene::Image without = studio.draw(open, view), plain = studio.draw(scene, view);
        view.selected = scene->scene->find_node(1);
        const scene::Image image = studio.draw(scene, view);
        int through = 0, before = 0;
        for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 80; ++x) {
                const bool covered =
                    (x >= 10 && x < 30 && y >= 10 && y < 30) || (x >= 20 && x < 40 && y >= 20 && y < 40);
                if (pixel_of(image, x, y) == kMarked) continue;
                through += covered && pixel_of(image, x, y) == pixel_of(without, x, y);
                before += !covered && pixel_of(image, x, y) == pixel_of(plain, x, y);
            }
        CHECK(through == 700);
        CHECK(before == 80 * 60 - 700 - count(image, kMarked));
    }
    // Where depth is judged after it, what is seen counts: a marker on the selection is whole, one that the
    // curtain covers is not.
    view.mode = plan::DrawMode::realistic;
    view.markers = markers_at({{-20, 10, 0.01}, {20, -10, -40}});
    const scene::Image marked = studio.draw(scene, view);
    CHECK(pixel_of(marked, 20, 20) == glm::ivec3(204, 10, 82));
    CHECK(pixel_of(marked, 57, 38) != glm::ivec3(204, 10, 82));
}

TEST_CASE("glass that is selected is blended once, and shows through what stands before it") {
    RendererFixture studio;
    plan::View view = pixel_view(80, 60);
    scene::Material glass = material_of({0, 0.9, 0});
    glass.diffuse.a = 0.5;
    const Part pane{1, rectangle(10, 10, 30, 30, view), glass, glm::dmat4(1)},
        wall{2, rectangle(0, 0, 80, 60, view), material_of({0.9, 0, 0}), moved_by({0, 0, -1})};
    const auto behind = scene_of({pane, wall, {3, quad(9), kPaint, moved_by({-20, 10, 0.1})}});
    const scene::Image plain = studio.draw(scene_of({pane, wall}), view);
    view.selected = 1;
    CHECK(faults(studio.draw(scene_of({pane, wall}), view), plain, 1,
                 [](int x, int y) { return x >= 10 && x < 30 && y >= 10 && y < 30; }) == 0);
    CHECK(pixel_of(plain, 20, 20).g > 80);
    CHECK(pixel_of(plain, 20, 20).r > 80);
    const scene::Image through = studio.draw(behind, view);
    CHECK(pixel_of(through, 20, 20).g > 110);  // half green, over the paint
    CHECK(pixel_of(through, 20, 20).r < 40);
}

TEST_CASE("outlines at the picture's border, before and behind the eye, and of what is as small as a speck") {
    RendererFixture studio;
    plan::View view = pixel_view(80, 60);
    view.selected = 1;
    const auto draw = [&](const scene::Geometry& geometry, const glm::dmat4& matrix = glm::dmat4(1)) {
        return studio.draw(scene_of({{1, geometry, kPaint, matrix}}), view);
    };
    const auto plain = [&](const scene::Geometry& geometry) {
        plan::View unmarked = view;
        unmarked.selected = scene::kNone;
        return studio.draw(scene_of({{1, geometry, kPaint, glm::dmat4(1)}}), unmarked);
    };
    const scene::Geometry corner = rectangle(-20, -20, 10, 10, view);
    CHECK(faults(draw(corner), plain(corner), 1,
                 [](int x, int y) { return x >= -20 && x < 10 && y >= -20 && y < 10; }) == 0);
    CHECK(count(draw(rectangle(-20, -20, 100, 100, view)), kMarked) == 0);
    CHECK(count(draw(rectangle(-20, -20, -5, -5, view)), kMarked) == 0);
    CHECK(count(draw(quad(5), moved_by({0, 0, 200})), kMarked) == 0);  // behind the eye
    // A floor that goes on behind the eye: the upper edge alone.
    const scene::Image floor = draw(quad(20), moved_by({0, -10, 30}) * turned_by(-90, {1, 0, 0}));
    CHECK(count(floor, kMarked) > 30);
    // Half a hundredth of a pixel, between the centres.
    const scene::Image speck = draw(rectangle(30.2, 20.2, 30.205, 20.205, view));
    CHECK(count(speck, kMarked) == 4);
    CHECK(pixel_of(speck, 29, 20) == kMarked);
    CHECK(pixel_of(speck, 30, 19) == kMarked);
}

TEST_CASE("an outline owes nothing to the one before") {
    RendererFixture studio;
    plan::View view = pixel_view(80, 60);
    const auto scene = scene_of({{1, rectangle(10, 10, 30, 30, view), kPaint, glm::dmat4(1)},
                                 {2, rectangle(33, 12, 60, 28, view), kPaint, glm::dmat4(1)}});
    view.selected = 2;
    const scene::Image fresh = studio.draw(scene, view);
    view.selected = 1;
    const scene::Image first = studio.draw(scene, view);
    CHECK(first.rgba != fresh.rgba);
    plan::View other = view;
    other.width = 33;
    studio.draw(scene, other);
    studio.draw(scene, view);
    view.selected = 2;
    CHECK(studio.draw(scene, view).rgba == fresh.rgba);
    view.selected = 1;
    CHECK(studio.draw(scene, view).rgba == first.rgba);
}

TEST_CASE("an outline in the stylized drawing, around what faces away too, and finer with more samples") {
    RendererFixture studio;
    plan::View view = pixel_view(80, 60);
    view.mode = plan::DrawMode::stylized;
    view.selected = 1;
    const scene::Geometry geometry = turned_inside_out(rectangle(20, 10, 41, 30, view));
    const scene::Image image = studio.draw(scene_of({{1, geometry, kPaint, glm::dmat4(1)}}), view);
    CHECK(studio.stats.passes == 4);
    CHECK(count(image, kMarked) == 2 * (21 + 20));
    view.mode = plan::DrawMode::realistic;
    view.samples = 16;
    const scene::Image fine = studio.draw(scene_of({{1, sphere(20, 16), kPaint, glm::dmat4(1)}}), view);
    int between = 0;
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 80; ++x) {
            const glm::ivec3 color = pixel_of(fine, x, y);
            between += color.r == 255 && color.b > 10 && color.b < 245;
        }
    CHECK(between > 50);
}
