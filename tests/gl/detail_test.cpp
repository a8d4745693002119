#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "compare/difference.hpp"
#include "io/read_scene.hpp"
#include "mesh/detail_levels.hpp"
#include "plan/detail_plan.hpp"
#include "renderer/renderer.hpp"
#include "shapes.hpp"

using namespace vrut;

namespace {

const scene::Material kPaint = material_of({0.8, 0.3, 0.1}, {0.3, 0.3, 0.3}, 20);

scene::Material seen_through(scene::Material material) {
    material.diffuse.a = 0.4;
    return material;
}

scene::Material mirroring(scene::Material material) {
    material.reflectivity = 0.9;
    return material;
}

/// A square in the plane z = 0 of many triangles.
scene::Geometry sheet(double half, unsigned cells) {
    return surface(cells, cells,
                   [&](double u, double v) { return half * glm::dvec3(2 * u - 1, 2 * v - 1, 0); });
}

plan::View simplified(plan::View view, const std::shared_ptr<const scene::PlacedScene>& scene,
                      double pixels = 0.5) {
    const auto levels = std::make_shared<const mesh::DetailLevels>(scene->scene);
    levels->wait();
    view.scene = scene;
    view.levels = levels;
    view.detail = pixels;
    return view;
}

plan::View view_from(const glm::dvec3& eye, const glm::dvec3& focus = glm::dvec3(0)) {
    plan::View view;
    view.camera.eye = eye;
    view.camera.focus = focus;
    view.camera = scene::with_orthogonal_up(view.camera);
    view.width = 480;
    view.height = 320;
    view.samples = 4;
    return view;
}

struct Saving {
    std::uint64_t all = 0, drawn = 0;
    double left() const { return static_cast<double>(drawn) / static_cast<double>(all); }
};

/// Draws with and without levels and compares.
Saving check(plan::View view, const std::shared_ptr<const scene::PlacedScene>& scene, double pixels = 0.5) {
    renderer::Renderer renderer;
    scene::Image whole, coarse;
    plan::FrameStats all, left;
    view.scene = scene;
    renderer.render(view, whole, all);
    renderer.render(simplified(view, scene, pixels), coarse, left);
    const compare::Difference apart = compare::difference(whole, coarse);
    CHECK(apart.psnr() >= 45);
    CHECK(apart.share_above(8) <= 0.002);
    CHECK(renderer.take_messages().empty());
    return {all.triangles, left.triangles};
}

}  // namespace

TEST_CASE("with fewer triangles the picture hardly changes") {
    const plan::View view = view_from({1, 2, 6});
    const auto ball = scene_of({{1, sphere(1.5, 100), kPaint, glm::dmat4(1)}});
    CHECK(check(view, ball).left() < 0.55);
    const auto flat = scene_of({{1, sphere(1.5, 100, false), kPaint, glm::dmat4(1)}});
    CHECK(check(view, flat).left() <= 1);  // each triangle has a shade of its own, and is seen
    CHECK(check(view_from({3, 6, 18}), flat).left() < 0.55);
    const auto both = scene_of({{1, sphere(1.5, 80), seen_through(kPaint), glm::dmat4(1)},
                                {2, sphere(0.7, 80), kPaint, moved_by({0.4, 0, 0})}});
    CHECK(check(view, both).left() < 0.8);
    const auto mirrored = scene_of({{1, sphere(0.7, 80), kPaint, moved_by({0, 0, 1.2})},
                                    {2, sheet(2, 40), mirroring(kPaint), glm::dmat4(1)}});
    CHECK(check(view, mirrored).left() < 0.5);
}

TEST_CASE("in a better order every triangle is drawn, and the picture stays as it is") {
    scene::Geometry shuffled = sphere(1, 60);
    std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), std::mt19937(1));
    const auto scene = scene_of({{1, shuffled, kPaint, glm::dmat4(1)},
                                 {2, shuffled, seen_through(kPaint), moved_by({1.5, 0, 1})},
                                 {3, sheet(3, 4), mirroring(kPaint), moved_by({0, 0, -1.5})}});
    plan::View view = view_from({1, 2, 6});
    renderer::Renderer renderer;
    for (const scene::Index selected : {scene::kNone, scene->scene->find_node(1)}) {
        view.scene = scene;
        view.selected = selected;
        view.levels = nullptr;
        scene::Image before, after;
        plan::FrameStats all, same;
        renderer.render(view, before, all);
        view = simplified(view, scene, 0);
        renderer.render(view, after, same);
        CHECK(compare::difference(before, after).maximum() == 0);
        // More of those that face away lie together; a selected part is drawn in file order.
        CHECK(same.triangles <= all.triangles);
        for (const plan::DrawItem& item : plan::plan_frame(view).scene.opaque) {
            REQUIRE(item.level != nullptr);
            CHECK(item.level->number == 0);
            const auto geometry = static_cast<std::size_t>(item.geometry);
            CHECK(item.level->triangles.size() == scene->scene->geometries()[geometry].triangles.size());
        }
    }
}

TEST_CASE("the car with fewer triangles") {
    auto read = io::read_scene(std::string(VRUT_CARS) + "/car-20k.vrut");
    REQUIRE(read);
    const auto car = std::make_shared<const scene::PlacedScene>(scene::place(*std::move(read)));
    CHECK(check(view_from({4, 2, 5}, {0, 0.7, 0}), car, 1).left() < 1);
}

TEST_CASE("a selected part among simplified ones is drawn whole") {
    const auto scene = scene_of(
        {{1, sphere(1, 60), kPaint, glm::dmat4(1)}, {2, sphere(1, 60), kPaint, moved_by({1.5, 0, -1})}});
    plan::View view = view_from({1, 2, 6});
    view.selected = scene->scene->find_node(2);
    CHECK(check(view, scene).left() < 0.9);
    const plan::FramePlan plan = plan::plan_frame(simplified(view, scene));
    REQUIRE(plan.selected.size() == 1);
    CHECK(plan.selected[0].level == nullptr);
    REQUIRE(plan.scene.opaque.size() == 1);
    CHECK(plan.scene.opaque[0].level != nullptr);
}

TEST_CASE("parts in one place have one level, glass and solid, painted and plain") {
    const auto twins = [](scene::Geometry geometry, const scene::Material& one,
                          const scene::Material& other) {
        geometry.texcoords.resize(geometry.positions.size());
        scene::SceneParts parts;
        parts.geometries = {geometry};
        parts.materials = {one, other};
        scene::Image white;
        white.resize(1, 1);
        white.rgba = {255, 255, 255, 255};
        parts.textures = {{"white.png", white, false}};
        for (scene::Id id = 1; id <= 3; ++id) {
            const glm::dmat4 matrix = id < 3 ? glm::dmat4(1) : moved_by({2.5, 0, -2});
            parts.nodes.push_back({scene::Node{id,
                                               {},
                                               scene::NodeType::geometry,
                                               scene::kNone,
                                               {},
                                               true,
                                               matrix,
                                               scene::GeometryData{0, id == 2 ? 1 : 0}},
                                   0});
        }
        return std::make_shared<const scene::PlacedScene>(
            scene::place(*scene::Scene::build(std::move(parts))));
    };
    const scene::Material blue = material_of({0.1, 0.1, 0.9});
    scene::Material painted = blue;
    painted.texture = 0;
    constexpr double kFine = 0.25;  // most of these outlines are dark against a light background
    const plan::View view = view_from({1, 2, 6});
    CHECK(check(view, twins(sphere(1, 100), kPaint, seen_through(blue)), kFine).left() < 0.6);
    CHECK(check(view, twins(sphere(1, 100), seen_through(blue), kPaint), kFine).left() < 0.6);
    CHECK(check(view, twins(sphere(1, 100), seen_through(kPaint), seen_through(blue)), kFine).left() < 0.6);
    CHECK(check(view, twins(sheet(1, 20), kPaint, seen_through(blue)), kFine).left() < 1);
    const double alone = check(view, twins(sphere(1, 100), kPaint, painted), kFine).left();
    CHECK(alone > 0.6);  // the third of them, which has no twin
    CHECK(alone < 0.9);
}

TEST_CASE("what is painted on a part stays where it is") {
    scene::Geometry painted = sheet(1.5, 40);
    for (const glm::dvec3& p : painted.positions)
        painted.texcoords.emplace_back(p.x + 0.2 * std::sin(5 * p.y), p.y + 0.2 * std::sin(5 * p.x));
    scene::Image stripes;
    stripes.resize(8, 8);
    for (std::size_t i = 0; i < stripes.rgba.size(); ++i)
        stripes.rgba[i] = i % 4 == 3 || i / 8 % 2 == 0 ? 255 : 0;
    scene::Material material = kPaint;
    material.texture = 0;
    const auto scene = scene_of({{1, painted, material, glm::dmat4(1)}}, {{"stripes.png", stripes, false}});
    CHECK(check(view_from({1, 2, 6}), scene).left() == 1);
}

TEST_CASE("a level is chosen by what its error is in the picture") {
    const auto scene = scene_of({{1, sphere(1, 60), kPaint, glm::dmat4(1)}});
    plan::View view = simplified(view_from({0, 0, 6}), scene);
    const auto chosen = [&](double distance, double detail) {
        view.camera.eye = {0, 0, distance};
        view.detail = detail;
        const plan::FramePlan plan = plan::plan_frame(view);
        if (plan.scene.opaque.empty()) return -1;
        const mesh::DetailLevel* level = plan.scene.opaque[0].level;
        if (!level) return 0;
        // Straight ahead, the nearest point is this far away.
        const double pixels = view.height / 2.0 / std::tan(view.camera.fov * scene::kRadiansPerDegree / 2);
        CHECK(level->error * pixels / (distance - 1) <= detail);
        return level->number;
    };
    CHECK(chosen(6, 0) == 0);
    CHECK(chosen(6, 1e-9) == 0);
    int before = 0;
    for (const double detail : {0.05, 0.2, 0.5, 1.0, 4.0}) {
        const int level = chosen(6, detail);
        CHECK(level >= before);
        before = level;
    }
    CHECK(before >= 3);
    CHECK(chosen(100, 0.5) > chosen(3, 0.5));
    CHECK(chosen(1.01, 0.5) <= chosen(3, 0.5));
    CHECK(chosen(0.5, 1000) == 0);  // within the box
    view.wireframe = true;
    CHECK(plan::plan_frame(view).edges[0].level == nullptr);
    view.wireframe = false;
    view.mode = plan::DrawMode::stylized;
    view.camera.eye = {0, 0, 6};
    CHECK(plan::plan_frame(view).scene.opaque[0].level == nullptr);
}

TEST_CASE("no step in a part is seen longer than is said of it") {
    plan::View view = view_from({0, 0, 0}, {0, 0, -1});
    const math::Bounds box{{2, -1, -1}, {4, 1, 1}};
    const glm::dmat4 matrix = moved_by({0, 0, -6}) * turned_by(20, {0, 1, 0}) * scaled_by({1, 2, 0.5});
    const double most = plan::max_screen_space_scale(matrix, box, view);
    const glm::dmat4 clip = math::reversed_clip_from_view(plan::projection_of(view), 0.1);
    const auto pixel = [&](const glm::dvec3& at) {
        const glm::dvec4 p = clip * matrix * glm::dvec4(at, 1);
        return glm::dvec2(p) / p.w * glm::dvec2(view.width, view.height) / 2.0;
    };
    double longest = 0;
    for (const glm::dvec3& corner : math::corners(box))
        for (const glm::dvec3& step :
             {glm::dvec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}, {0.6, 0, 0.8}, {0.6, 0, -0.8}}) {
            const glm::dvec3 to = corner + 1e-4 * step * glm::sign(box.center() - corner + 1e-9);
            longest = std::max(longest, glm::distance(pixel(corner), pixel(to)) / 1e-4);
        }
    CHECK(longest <= most * 1.001);
    CHECK(longest > most / 3);
    CHECK(std::isinf(plan::max_screen_space_scale(glm::dmat4(1), {glm::dvec3(-1), glm::dvec3(1)}, view)));
}

namespace {

scene::Material two_sided(scene::Material material) {
    material.two_sided = true;
    return material;
}

/// Draws every triangle with and without what is known about closed parts.
plan::FramePlan check_backs(plan::View view, const std::shared_ptr<const scene::PlacedScene>& scene) {
    renderer::Renderer renderer;
    scene::Image all, left;
    plan::FrameStats stats;
    view.scene = scene;
    renderer.render(view, all, stats);
    view = simplified(view, scene, 0);
    renderer.render(view, left, stats);
    CHECK(compare::difference(all, left).share_above(1) == 0);
    return plan::plan_frame(view);
}

}  // namespace

TEST_CASE("backs of closed parts are left out where they are hidden") {
    const auto cull_mode = [](const plan::FramePlan& plan) { return plan.scene.opaque.at(0).cull_mode; };
    const scene::Geometry whole = welded(sphere(1, 12));
    const auto ball = scene_of({{1, whole, two_sided(kPaint), glm::dmat4(1)}});
    CHECK(cull_mode(check_backs(view_from({1, 2, 5}), ball)) == plan::CullMode::hidden_back);
    CHECK(cull_mode(check_backs(view_from({0, 0, 0.5}, {1, 0, 0}), ball)) == plan::CullMode::none);
    CHECK(cull_mode(check_backs(view_from({0, 0, 1 + 1e-9}), ball)) == plan::CullMode::none);
    const auto plain = scene_of({{1, whole, kPaint, glm::dmat4(1)}});
    CHECK(cull_mode(check_backs(view_from({1, 2, 5}), plain)) == plan::CullMode::back);
    const auto turned = scene_of({{1, turned_inside_out(whole), two_sided(kPaint), glm::dmat4(1)}});
    CHECK(cull_mode(check_backs(view_from({1, 2, 5}), turned)) == plan::CullMode::none);
    const auto flat = scene_of({{1, whole, two_sided(kPaint), scaled_by({1, 1, 0})}});
    CHECK(cull_mode(check_backs(view_from({1, 2, 5}), flat)) == plan::CullMode::none);
    scene::Geometry dark = whole;  // the normals face inwards, and are turned to the viewer
    for (glm::vec3& normal : dark.normals) normal = -normal;
    const auto other = scene_of({{1, dark, two_sided(kPaint), scaled_by({-1, 1, 2})}});
    CHECK(cull_mode(check_backs(view_from({1, 2, 5}), other)) == plan::CullMode::hidden_back);
}

TEST_CASE("what a mirror cuts is drawn from both sides in it") {
    const auto scene = scene_of({{1, welded(sphere(0.7, 24)), two_sided(kPaint), moved_by({0, 0, 1.2})},
                                 {2, welded(sphere(0.7, 24)), two_sided(kPaint), moved_by({1, 1, 0.3})},
                                 {3, sheet(2, 4), mirroring(kPaint), glm::dmat4(1)}});
    const plan::FramePlan plan = check_backs(view_from({1, 2, 6}), scene);
    REQUIRE(plan.scene.mirrors.size() == 1);
    const auto& reflected = plan.scene.mirrors[0].reflected.opaque;
    REQUIRE(reflected.size() == 2);
    CHECK(reflected[0].cull_mode == plan::CullMode::hidden_back);
    CHECK(reflected[1].cull_mode == plan::CullMode::none);
}
