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
