#include "plan/transparency_plan.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "io/read_scene.hpp"
#include "plan/cut_cache.hpp"
#include "shapes.hpp"
#include "views.hpp"

using namespace vrut;

namespace {

std::shared_ptr<const scene::PlacedScene> car() {
    auto scene = io::read_scene(VRUT_CARS "/car-20k.vrut");
    REQUIRE(scene);
    return std::make_shared<const scene::PlacedScene>(scene::place(*std::move(scene)));
}

/// Of window glass, not of a lamp.
bool is_window(const scene::Scene& scene, const plan::DrawItem& item) {
    return scene.material(item.material).name.starts_with("Glass");
}

}  // namespace

TEST_CASE("a car's windows are drawn sorted from all around, but for one that is seen along its edge") {
    int along = 0;
    plan::View view = view_from({0, 1, 5});
    view.scene = car();
    const scene::Scene& scene = *view.scene->scene;
    for (int side = 0; side < 8; ++side)
        for (const double height : {0.4, 1.2, 2.5}) {
            CAPTURE(side);
            CAPTURE(height);
            const double angle = glm::radians(45.0 * side + 10);
            view.camera.eye = {5 * std::sin(angle), height, 5 * std::cos(angle)};
            const plan::FramePlan plan = plan::plan_frame(view);
            std::size_t blended = 0, windows = 0, expected = 0, exact = 0;
            for (const plan::TransparentGroup& group : plan.scene.transparent)
                for (const plan::DrawItem& item : group.items) {
                    ++blended;
                    if (!is_window(scene, item)) continue;
                    ++windows;
                    exact += group.exact;
                }
            plan::CutCache cuts;
            for (const plan::DrawItem& item : plan::visible_faces(view, cuts))
                expected += scene.is_transparent(scene.material(item.material));
            CHECK(blended == expected);
            CHECK(windows >= 8);  // of four doors, two quarters, the boot lid, and the windscreen
            CHECK(exact <= 2);    // a bent pane's outer and inner sheet, where both are seen
            along += exact > 0;
        }
    CHECK(along <= 3);
}

namespace {

Part pane(scene::Id id, const glm::dvec3& color, const glm::dmat4& matrix) {
    scene::Material material;
    material.emission = {color, 1};
    material.diffuse = {0, 0, 0, 0.5};
    material.two_sided = true;
    return {id, quad(1), material, matrix};
}

std::vector<plan::TransparentGroup> groups_of(const std::vector<Part>& parts) {
    plan::View view = view_from({0, 0, 5});
    view.scene = scene_of(parts);
    return plan::plan_frame(view).scene.transparent;
}

}  // namespace

TEST_CASE("panes that cross are an exact group where that can be seen") {
    const glm::dvec3 red(0.9, 0, 0), blue(0, 0, 0.9);
    const glm::dmat4 left = turned_by(30, {0, 1, 0}), right = turned_by(-30, {0, 1, 0});
    const auto different = groups_of({pane(1, red, left), pane(2, blue, right)});
    REQUIRE(different.size() == 1);
    CHECK(different[0].exact);
    const auto same = groups_of({pane(1, red, left), pane(2, red, right)});
    REQUIRE(same.size() == 1);
    CHECK(!same[0].exact);
    // Only those that cross pay for it: one behind them and one before them are sorted.
    const auto four = groups_of({pane(1, red, left), pane(2, blue, right), pane(3, red, moved_by({0, 0, 2})),
                                 pane(4, blue, moved_by({0, 0, -2}))});
    REQUIRE(four.size() == 3);
    CHECK(four[0].items.size() == 1);
    CHECK(four[1].exact);
    CHECK(four[1].items.size() == 2);
    CHECK(!four[2].exact);
}

TEST_CASE("panes of one material whose vertices have other colours are an exact group where they cross") {
    std::vector<Part> parts{pane(1, {}, turned_by(30, {0, 1, 0})), pane(2, {}, turned_by(-30, {0, 1, 0}))};
    for (Part& part : parts) part.material.ambient = {0.9, 0.9, 0.9, 1};
    CHECK(!groups_of(parts)[0].exact);
    parts[1].geometry.colors.assign(parts[1].geometry.positions.size(), glm::vec3(0));
    CHECK(groups_of(parts)[0].exact);
}

TEST_CASE("panes beside each other, and panes that meet in an edge, are sorted") {
    const glm::dvec3 red(0.9, 0, 0), blue(0, 0, 0.9);
    const auto box_of_panes =
        groups_of({pane(1, red, moved_by({0, 0, 1})), pane(2, blue, moved_by({0, 0, -1})),
                   pane(3, blue, turned_by(90, {0, 1, 0}) * moved_by({0, 0, 1})),
                   pane(4, red, turned_by(90, {0, 1, 0}) * moved_by({0, 0, -1})),
                   pane(5, blue, turned_by(90, {1, 0, 0}) * moved_by({0, 0, 1}))});
    REQUIRE(box_of_panes.size() == 1);
    CHECK(!box_of_panes[0].exact);
    CHECK(box_of_panes[0].items.front().node != box_of_panes[0].items.back().node);
    const auto coplanar = groups_of({pane(1, red, glm::dmat4(1)), pane(2, blue, moved_by({0.5, 0, 0})),
                                     pane(3, red, moved_by({1, 0.5, 0}))});
    REQUIRE(coplanar.size() == 1);
    CHECK(!coplanar[0].exact);
}

TEST_CASE("more panes than can be compared are sorted at each pixel where not too many lie over each other") {
    std::vector<Part> parts;
    for (int i = 0; i < 2500; ++i)
        parts.push_back(
            pane(i + 1, {0.5, 0, 0},
                 moved_by({0, 0.03 * (i % 50 - 25), -0.01 * (i * 617 % 2500)}) * scaled_by({1, 0.01, 1})));
    const auto groups = groups_of(parts);
    REQUIRE(groups.size() == 1);
    CHECK(groups[0].items.size() == 2500);
    CHECK(groups[0].exact);
}

TEST_CASE("panes that reach behind the eye count as one layer where more panes are than can be compared") {
    const Part around_eye = pane(9000, {0, 0.5, 0}, moved_by({0, -0.3, 4.5}) * turned_by(90, {1, 0, 0}));
    for (const bool deep : {false, true}) {
        CAPTURE(deep);
        std::vector<Part> parts{around_eye};
        for (int i = 0; i < 2500; ++i)
            parts.push_back(pane(i + 1, {0.5, 0, 0},
                                 moved_by({0, deep ? 0 : 0.03 * (i % 50 - 25), -0.01 * (i * 617 % 2500)}) *
                                     scaled_by({1, deep ? 1 : 0.01, 1})));
        const auto groups = groups_of(parts);
        REQUIRE(groups.size() == 1);
        CHECK(groups[0].exact == !deep);
    }
}

TEST_CASE("more panes than can be compared, in a deep stack, are drawn by their distance") {
    std::vector<Part> parts;
    parts.reserve(1500);
    for (int i = 0; i < 1500; ++i)
        parts.push_back(pane(i + 1, {0.5, 0, 0}, moved_by({0, 0, -0.01 * (i * 617 % 1500)})));
    const auto groups = groups_of(parts);
    REQUIRE(groups.size() == 1);
    REQUIRE(groups[0].items.size() == 1500);
    CHECK(!groups[0].exact);
    for (std::size_t i = 1; i < 1500; ++i)
        CHECK(groups[0].items[i - 1].view_from_node[3].z < groups[0].items[i].view_from_node[3].z);
}

namespace {

/// Two nodes of one geometry in one place.
std::vector<plan::TransparentGroup> groups_of_coincident(const scene::Geometry& geometry,
                                                         std::vector<scene::Material> materials) {
    plan::View view = view_from({0, 0, 5});
    view.scene = coincident_scene(geometry, std::move(materials), turned_by(20, {0, 1, 0}));
    return plan::plan_frame(view).scene.transparent;
}

}  // namespace

TEST_CASE("coincident glass is an exact group where a ray can meet the shape twice") {
    scene::Material red = pane(1, {0.9, 0, 0}, glm::dmat4(1)).material,
                    blue = pane(1, {0, 0, 0.9}, glm::dmat4(1)).material;
    const auto is_exact = [&](const scene::Geometry& geometry) {
        const auto groups = groups_of_coincident(geometry, {red, blue});
        REQUIRE(groups.size() == 1);
        REQUIRE(groups[0].items.size() == 2);
        CHECK(groups[0].items[0].node < groups[0].items[1].node);
        return groups[0].exact;
    };
    CHECK(is_exact(sphere(1, 8)));
    CHECK_FALSE(is_exact(quad(1)));
    red.two_sided = false;
    CHECK(is_exact(sphere(1, 8)));  // of one the backs are drawn
    blue.two_sided = false;
    CHECK_FALSE(is_exact(sphere(1, 8)));  // of a convex shape only fronts
    CHECK_FALSE(is_exact(quad(1)));
    CHECK(is_exact(sphere(1, 40)));  // more triangles than are compared
}
