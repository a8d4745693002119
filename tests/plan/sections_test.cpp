#include <doctest/doctest.h>

#include <algorithm>

#include "plan/cut_cache.hpp"
#include "plan/draw_commands.hpp"
#include "plan/frame_plan.hpp"
#include "shapes.hpp"
#include "views.hpp"

using namespace vrut;

namespace {

const scene::ClipPlane kAboveFront{{0, 0, 1}, 0.25};

/// A box at the origin, one before it, one behind it, and a sheet across.
std::shared_ptr<const scene::PlacedScene> four_parts() {
    return scene_of({{1, box({0.5, 0.5, 0.5}), kBronze},
                     {2, box({0.1, 0.1, 0.1}), kBronze, moved_by({0, 0, 2})},
                     {3, box({0.1, 0.1, 0.1}), kBronze, moved_by({0, 0, -2})},
                     {4, quad(1), kBronze, turned_by(90, {0, 1, 0})}});
}

plan::View view_of(std::shared_ptr<const scene::PlacedScene> scene, std::vector<scene::ClipPlane> planes) {
    plan::View view;
    view.camera.eye = {0, 0, 10};
    view.camera.focus = {0, 0, 0};
    view.scene = std::move(scene);
    view.clip_planes = std::move(planes);
    return view;
}

std::vector<plan::DrawItem> items_of(const std::vector<plan::DrawItem>& items, scene::Index node) {
    std::vector<plan::DrawItem> found;
    std::copy_if(items.begin(), items.end(), std::back_inserter(found),
                 [&](const plan::DrawItem& item) { return item.node == node; });
    return found;
}

}  // namespace

TEST_CASE("a part that a plane cuts is clipped, and has a cap; others are drawn as ever, or not at all") {
    const auto scene = four_parts();
    const plan::DrawLists lists = plan::plan_frame(view_of(scene, {kAboveFront})).scene;
    const auto cut = items_of(lists.opaque, 1);
    REQUIRE(cut.size() == 2);
    CHECK(cut[0].clip_planes.size() == 1);
    CHECK(cut[0].cull_mode == plan::CullMode::back);
    CHECK_FALSE(cut[0].cut);
    REQUIRE(cut[1].cut);
    CHECK(cut[1].cut->cut.triangles.size() == 6);  // eight edges of sides and their diagonals
    CHECK(cut[1].clip_planes.empty());
    CHECK(items_of(lists.opaque, 2).empty());
    REQUIRE(items_of(lists.opaque, 3).size() == 1);
    CHECK(items_of(lists.opaque, 3)[0].clip_planes.empty());
}

TEST_CASE("a part that is left open shows both sides, and lines where it is cut") {
    const plan::DrawLists lists = plan::plan_frame(view_of(four_parts(), {kAboveFront})).scene;
    const auto sheet = items_of(lists.opaque, 4);
    REQUIRE(sheet.size() == 1);
    CHECK(sheet[0].cull_mode == plan::CullMode::none);
    CHECK(lists.cut_lines.size() == 2);
    scene::ClipPlane uncapped = kAboveFront;
    uncapped.caps = false;
    const plan::DrawLists open = plan::plan_frame(view_of(four_parts(), {uncapped})).scene;
    REQUIRE(items_of(open.opaque, 1).size() == 1);
    CHECK(items_of(open.opaque, 1)[0].cull_mode == plan::CullMode::none);
    CHECK(open.cut_lines.size() == 2);
}

TEST_CASE("a cap is clipped by the other planes") {
    const plan::DrawLists lists =
        plan::plan_frame(view_of(four_parts(), {kAboveFront, {{1, 0, 0}, 0.1}})).scene;
    const auto items = items_of(lists.opaque, 1);
    REQUIRE(items.size() == 3);
    CHECK(items[0].clip_planes.size() == 2);
    CHECK(items[1].clip_planes.size() == 1);
    CHECK(items[2].clip_planes.size() == 1);
}

TEST_CASE("without planes, and with planes that cut nothing, a frame is planned as ever") {
    const plan::View without = view_of(four_parts(), {});
    const plan::View beside = view_of(without.scene, {{{0, 0, 1}, 5}, {{-1, 0, 0}, 5}});
    const plan::FramePlan plan = plan::plan_frame(without), other = plan::plan_frame(beside);
    CHECK(plan.scene.cut_lines.empty());
    CHECK(other.scene.cut_lines.empty());
    CHECK(plan::draw_commands(plan, without).size() == plan::draw_commands(other, beside).size());
    REQUIRE(plan.scene.opaque.size() == other.scene.opaque.size());
    for (std::size_t i = 0; i < plan.scene.opaque.size(); ++i) {
        CHECK(plan.scene.opaque[i].node == other.scene.opaque[i].node);
        CHECK(other.scene.opaque[i].clip_planes.empty());
    }
}

TEST_CASE("a wireframe has the lines of cuts, and no caps") {
    plan::View view = view_of(four_parts(), {kAboveFront});
    view.wireframe = true;
    const plan::FramePlan plan = plan::plan_frame(view);
    CHECK(plan.scene.opaque.empty());
    CHECK(plan.scene.cut_lines.size() == 2);
    for (const plan::DrawItem& item : plan.edges)
        if (item.node == 1 && !item.cut) CHECK(item.clip_planes.size() == 1);
}

TEST_CASE("caps go with what is selected") {
    plan::View view = view_of(four_parts(), {kAboveFront});
    view.selected = 1;
    const plan::FramePlan plan = plan::plan_frame(view);
    CHECK(items_of(plan.scene.opaque, 1).empty());
    CHECK(items_of(plan.overlay.opaque, 1).size() == 2);
    CHECK(plan.overlay.cut_lines.size() == 1);
}

TEST_CASE("a cut is kept until its plane or its part moves, and forgotten when an image does without it") {
    const plan::View view = view_of(four_parts(), {kAboveFront});
    plan::CutCache cuts;
    plan::DrawBudget budget(false);
    const auto find = [&](const plan::View& of) {
        cuts.begin_image();
        return cuts.find(of, 1, 0, budget);
    };
    const auto first = find(view);
    CHECK(find(view) == first);
    plan::View moved = view;
    moved.clip_planes[0].distance = 0.3;
    const auto second = find(moved);
    CHECK(second != first);
    plan::View nodes = moved;
    std::vector<scene::NodeState> states = view.scene->nodes;
    states[1].matrix = moved_by({0, 0, 0.1});
    nodes.scene = std::make_shared<const scene::PlacedScene>(scene::place(view.scene->scene, states));
    CHECK(find(nodes) != second);
    const auto last = find(nodes);
    cuts.begin_image();
    CHECK(find(nodes) != last);
}

TEST_CASE("hatching goes on from part to part, also where what is far off is hidden") {
    plan::View view = view_of(four_parts(), {kAboveFront});
    view.clip_planes[0].hatched = true;
    plan::View without = view;
    std::vector<scene::NodeState> states = view.scene->nodes;
    states[2].active = false;
    without.scene = std::make_shared<const scene::PlacedScene>(scene::place(view.scene->scene, states));
    REQUIRE(without.scene->bounds.radius() != view.scene->bounds.radius());
    plan::CutCache cuts;
    plan::DrawBudget budget(false);
    const auto known = cuts.find(view, 1, 0, budget);
    CHECK(cuts.find(view, 1, 0, budget) == known);
    CHECK(cuts.find(without, 1, 0, budget) != known);
    CHECK(cuts.find(view, 1, 0, budget)->cut.hatching.size() == known->cut.hatching.size());
}
