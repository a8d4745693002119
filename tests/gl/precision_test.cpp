#include "reference/reference.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

const scene::Material kRed = material_of({1, 0, 0}), kGreen = material_of({0, 1, 0}),
                      kBlue = material_of({0, 0, 1});

bool is_red(const glm::ivec3& color) { return color.r > 50 && color.g == 0 && color.b == 0; }

plan::View moved(plan::View view, double scale, const glm::dvec3& offset) {
    view.camera.eye = view.camera.eye * scale + offset;
    view.camera.focus = view.camera.focus * scale + offset;
    view.camera.center = view.camera.focus;
    return view;
}

/// A few things of all kinds, `in_file` of whose size and place are in the positions and the rest in the
/// matrices.
std::shared_ptr<const scene::PlacedScene> things(double scale, const glm::dvec3& offset, bool in_file) {
    const scene::Material material = material_of({0.6, 0.4, 0.2}, {0.3, 0.3, 0.3}, 30);
    const auto part = [&](scene::Id id, const scene::Geometry& geometry, const glm::dvec3& at) {
        if (in_file) return Part{id, mapped(geometry, scale, at * scale + offset), material, glm::dmat4(1)};
        return Part{id, geometry, material, moved_by(at * scale + offset) * scaled_by(glm::dvec3(scale))};
    };
    return scene_of({part(1, sphere(1, 8), {-1, 0, 0}), part(2, box({0.7, 0.7, 0.7}), {1, 0.2, 0}),
                     part(3, quad(3), {0, 0, -1}), part(4, quad(0.5, false), {0, 1, 1})});
}

/// Adds positions and triangles.
void add(scene::Geometry& geometry, const scene::Geometry& other, const glm::dmat4& matrix = glm::dmat4(1)) {
    const auto first = static_cast<unsigned>(geometry.positions.size());
    for (const glm::dvec3& position : other.positions) {
        geometry.positions.emplace_back(matrix * glm::dvec4(position, 1));
        geometry.bounds.add(geometry.positions.back());
    }
    for (const glm::uvec3& triangle : other.triangles) geometry.triangles.push_back(triangle + first);
}

/// Boxes of a metre to a centimetre around the origin, each turned its own way.
scene::Geometry detail() {
    scene::Geometry geometry;
    add(geometry, box({0.7, 0.3, 0.1}), moved_by({0, 0.3, -0.3}) * turned_by(10, {0, 1, 0}));
    add(geometry, box({0.05, 0.08, 0.05}), moved_by({0, 0.1, 0}) * turned_by(35, {0, 1, 0}));
    for (int i = 0; i < 4; ++i)
        add(geometry, box({0.02, 0.015, 0.01}),
            moved_by({0.06 * i, 0.15, 0.1}) * turned_by(20 + 20 * i, glm::normalize(glm::dvec3(1, 2, i))));
    return geometry;
}

/// A strip from the origin to `end` and a bit beyond.
scene::Geometry ground_to(const glm::dvec3& end) {
    const glm::dvec3 along = 3.0 * glm::normalize(end), across = glm::cross(along, {0, 1, 0});
    return surface(1, 1, [&](double u, double v) { return v * (end + along) + (2 * u - 1) * across; });
}

/// Where a strip of 200 km ends.
const glm::dvec3 kFarEnd{1.2e5, 0, 1.6e5};

/// The strip and what stands at its end.
scene::Geometry ground_with_detail() {
    scene::Geometry geometry = ground_to(kFarEnd);
    add(geometry, detail(), moved_by(kFarEnd));
    return geometry;
}

}  // namespace

TEST_CASE("size and place of a scene do not change its picture") {
    RendererFixture studio;
    const plan::View view = view_from({1, 1.5, 6});
    CHECK(studio.check(things(1, {0, 0, 0}, true), view).surfaces > 2000);
    const glm::dvec3 far{1e7, -1e7, 1e7};
    for (const bool in_file : {true, false}) {
        CAPTURE(in_file);
        for (const double scale : {1e-6, 1e6, 1e-3, 12345.678}) {
            CAPTURE(scale);
            studio.check(things(scale, {0, 0, 0}, in_file), moved(view, scale, {0, 0, 0}));
        }
        studio.check(things(1, far, in_file), moved(view, 1, far));
        studio.check(things(1e6, far * 1e6, in_file), moved(view, 1e6, far * 1e6));
    }
}

TEST_CASE("a geometry of 200 km is drawn as precisely near its end as a small one") {
    RendererFixture studio;
    const scene::Material material = material_of({0.6, 0.4, 0.2}, {0.3, 0.3, 0.3}, 30);
    const glm::dmat4 placed = moved_by({-3e5, 2e5, 1e3}) * turned_by(70, glm::normalize(glm::dvec3(1, 2, 3)));
    for (const double scale : {1.0, 1e3})  // of the file's numbers; the node's matrix takes it back
        for (const glm::dmat4& place : {glm::dmat4(1), placed}) {
            CAPTURE(scale);
            const scene::Geometry geometry = mapped(ground_with_detail(), scale, {0, 0, 0});
            const auto scene = scene_of({{1, geometry, material, place * scaled_by(glm::dvec3(1 / scale))}});
            for (const glm::dvec3& eye :
                 {glm::dvec3(0.05, 0.16, 0.31), glm::dvec3(-0.3, 0.2, 0.1), glm::dvec3(3, 2, 4)}) {
                CAPTURE(eye.x);
                const auto in_world = [&](const glm::dvec3& point) {
                    return glm::dvec3(place * glm::dvec4(kFarEnd + point, 1));
                };
                const plan::View view = view_from(in_world(eye), in_world({0, 0.1, 0}));
                CHECK(studio.check(scene, view).surfaces > 2000);
            }
        }
}

TEST_CASE("a geometry of 200 km is drawn in every way as two geometries are") {
    RendererFixture studio;
    scene::Material matte = material_of({0.6, 0.4, 0.2}), glass = matte, chrome = matte;
    glass.diffuse.a = 0.5;
    chrome.reflectivity = 0.7;
    const Part mirror{3, quad(0.5), chrome, moved_by(kFarEnd + glm::dvec3(-0.4, 0.4, -0.1))};
    plan::View view = view_from(kFarEnd + glm::dvec3(0.3, 0.6, 1.2), kFarEnd);
    view.light.headlight = false;
    view.light.type = scene::LightData::Type::directional;
    view.light.direction = glm::normalize(glm::dvec3(-1, -2, -1));
    for (const scene::Material& material : {matte, glass}) {
        const auto together = scene_of({{1, ground_with_detail(), material, glm::dmat4(1)}, mirror});
        const auto apart = scene_of({{1, ground_to(kFarEnd), material, glm::dmat4(1)},
                                     {2, detail(), material, moved_by(kFarEnd)},
                                     mirror});
        const auto check = [&] {
            const scene::Image expected = studio.draw(apart, view), image = studio.draw(together, view);
            int off = 0;
            for (int i = 0; i < view.width * view.height; ++i) {
                const glm::ivec3 is = pixel_of(image, i % view.width, i / view.width),
                                 should = pixel_of(expected, i % view.width, i / view.width);
                off += glm::any(glm::greaterThan(glm::abs(is - should), glm::ivec3(2)));
            }
            CHECK(off <= 10);  // at edges
        };
        check();
        view.wireframe = true;
        check();
        view.mode = plan::DrawMode::stylized;
        check();
        view.wireframe = false;
        check();
        view.mode = plan::DrawMode::realistic;
        view.methods.light = plan::Methods::Lighting::vertex;
        check();
        view.methods = {};
        view.selected = 0;  // the root: all
        check();
        view.selected = scene::kNone;
    }
}

TEST_CASE("nodes of a geometry of 200 km lie where it is drawn") {
    RendererFixture studio;
    const scene::Material material = material_of({0.6, 0.4, 0.2});
    const auto scene = scene_of({{1, ground_with_detail(), material, glm::dmat4(1)}});
    plan::View view = view_from(kFarEnd + glm::dvec3(0.3, 0.2, 1.2), kFarEnd);
    view.scene = scene;
    const std::vector<scene::Index> drawn = studio.renderer().node_ids(view),
                                    should = reference::trace(view).node;
    REQUIRE(drawn.size() == should.size());
    int off = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) off += drawn[i] != should[i];
    CHECK(off <= 2);
}

TEST_CASE("a flattened part of any size is lit") {
    RendererFixture studio;
    scene::Geometry sideways = quad(1);
    sideways.normals.assign(4, glm::vec3(1, 0, 0));
    for (const double scale : {1e-9, 1e-6, 1.0, 1e6, 1e9}) {
        CAPTURE(scale);
        plan::View view = moved(view_from({0.5, 0.3, 5}), scale, {0, 0, 0});
        view.scene = scene_of({{1, quad(scale), kRed, glm::dmat4(1)}});
        const PictureMismatch result =
            mismatch(view, studio.draw(scene_of({{1, sideways, kRed, scaled_by({scale, scale, 0})}}), view));
        CHECK_MESSAGE(result.worst <= 1, result.where);
        CHECK(result.surfaces > 300);
    }
}

TEST_CASE("depth tells a millimetre at a kilometre, with something before the eye") {
    RendererFixture studio;
    for (const double tilt : {0.0, 30.0, 75.0}) {
        CAPTURE(tilt);
        const glm::dmat4 there = moved_by({0, 0, -1000}) * turned_by(tilt, {1, 0, 0});
        const glm::dmat4 a_bit_nearer = there * moved_by({0, 0, 0.001 / std::cos(glm::radians(tilt))});
        // Whichever is drawn first; the speck at 1 cm, out of view, draws the near plane close.
        for (const bool nearer_first : {true, false}) {
            const auto scene = scene_of({{1, quad(1e-3), kBlue, moved_by({1, 0, -0.01})},
                                         {nearer_first ? 2 : 4, quad(300), kRed, a_bit_nearer},
                                         {3, quad(300), kGreen, there}});
            plan::View view = view_from({0, 0, 0}, {0, 0, -1});
            view.camera.fov = 20;
            const scene::Image image = studio.draw(scene, view);
            int red = 0;
            for (int y = 0; y < view.height; ++y)
                for (int x = 0; x < view.width; ++x)
                    if (std::hypot(x - 47.5, y - 31.5) < (tilt > 60 ? 10 : 25))
                        red += !is_red(pixel_of(image, x, y));
            CHECK(red == 0);
        }
    }
}

TEST_CASE("near and far cut nothing off") {
    RendererFixture studio;
    // A wall before the eye and one at the horizon, in one view.
    const auto scene = scene_of({{1, quad(0.002), kRed, moved_by({-0.002, 0, -0.01})},
                                 {2, quad(5000), kGreen, moved_by({0, 0, -5000})}});
    const PictureMismatch result = studio.check(scene, view_from({0, 0, 0}, {0, 0, -1}));
    CHECK(result.surfaces == result.compared);
    // A floor that goes on behind the eye.
    const auto floor = scene_of({{1, quad(100), kRed, turned_by(-90, {1, 0, 0})}});
    CHECK(studio.check(floor, view_from({0, 1, 0}, {0, 0.7, -1})).surfaces > 2000);
}

TEST_CASE("what is as near as a hundred millionth of far is drawn") {
    RendererFixture studio;
    const double far = 20e3;
    for (const double near : {0.1, 4e-3, 1e-8 * far}) {
        CAPTURE(near);
        // The ground goes on behind the eye.
        const auto scene =
            scene_of({{1, quad(far), kGreen, moved_by({0, -1.7, 0}) * turned_by(-90, {1, 0, 0})},
                      {2, quad(near / 10), kRed, moved_by({0, 0, -near})},
                      {3, sphere(1, 8), kBlue, moved_by({-2, 0, -6})},
                      {4, quad(far / 3), kBlue, moved_by({0, 0, -far})}});
        const plan::View view = view_from({0, 0, 0}, {0, 0, -5});
        CHECK(studio.check(scene, view).surfaces > 2000);
        CHECK(is_red(pixel_of(studio.draw(scene, view), view.width / 2, view.height / 2)));
    }
}

TEST_CASE("something very far away hides nothing") {
    RendererFixture studio;
    for (const double far : {1e5, 1e9, 1e15}) {
        CAPTURE(far);
        const auto scene = scene_of({{1, sphere(1, 8), kRed, glm::dmat4(1)},
                                     {2, quad(1), kGreen, moved_by({0, -0.9, 1.5})},
                                     {3, quad(far / 1000), kBlue, moved_by({far / 10, 0, -far})}});
        CHECK(studio.check(scene, view_from({0, 0, 4})).surfaces > 500);
    }
}

TEST_CASE("of equal depth the higher id is in front") {
    RendererFixture studio;
    const plan::View view = view_from({1, 2, 5});
    const glm::dmat4 matrix = turned_by(33, glm::normalize(glm::dvec3(1, 1, 0.2))) * scaled_by({1, 1.3, 0.9});
    for (const scene::Geometry& geometry : {sphere(1.3, 10), box({1, 1, 1}), sphere(1.3, 3, false)}) {
        const auto alone = [&](const scene::Material& material) {
            return studio.draw(scene_of({{1, geometry, material, matrix}}), view).rgba;
        };
        const std::vector<std::uint8_t> red = alone(kRed), green = alone(kGreen);
        // The first deeper in the tree than the second or not, in either order in the file.
        const auto both = [&](scene::Id red_id, scene::Id green_id, bool deeper, bool red_first) {
            scene::SceneParts parts;
            parts.materials = {kRed, kGreen};
            parts.geometries = {geometry};
            const auto add = [&](scene::Id id, scene::Id parent, scene::Index material) {
                parts.nodes.push_back({scene::Node{id,
                                                   {},
                                                   scene::NodeType::geometry,
                                                   scene::kNone,
                                                   {},
                                                   true,
                                                   matrix,
                                                   scene::GeometryData{0, material}},
                                       parent});
            };
            if (!red_first) add(green_id, 0, 1);
            add(red_id, deeper ? 1 : 0, 0);
            if (red_first) add(green_id, 0, 1);
            parts.nodes.push_back(
                {scene::Node{1, {}, scene::NodeType::assembly, scene::kNone, {}, true, glm::dmat4(1), {}},
                 0});
            return studio
                .draw(std::make_shared<scene::PlacedScene>(
                          scene::place(*scene::Scene::build(std::move(parts)))),
                      view)
                .rgba;
        };
        for (const bool deeper : {false, true})
            for (const bool red_first : {false, true}) {
                CHECK(both(8, 2, deeper, red_first) == red);
                CHECK(both(2, 8, deeper, red_first) == green);
                CHECK(both(1000000, 999999, deeper, red_first) == red);
            }
    }
}
