#include "plan/occlusion_culling.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "random_parts.hpp"
#include "views.hpp"

using namespace vrut;

namespace {

plan::View view_of(const std::vector<Part>& parts, const glm::dvec3& eye) {
    plan::View view = view_from(eye);
    view.scene = scene_of(parts);
    return view;
}

plan::OcclusionPlan plan_of(const plan::View& view, plan::OcclusionHistory& history) {
    return plan::plan_occlusion(plan::plan_frame(view).scene.opaque, view,
                                math::reversed_clip_from_view(plan::projection_of(view), 0.01), history);
}

plan::OcclusionHistory history_of(const plan::View& view) {
    return plan::OcclusionHistory(view.scene->nodes.size());
}

std::vector<scene::Index> nodes_of(const std::vector<plan::DrawItem>& items) {
    std::vector<scene::Index> nodes;
    for (const plan::DrawItem& item : items) nodes.push_back(item.node);
    return nodes;
}

/// Balls side by side, of more than 1,000 triangles each.
std::vector<Part> balls(int count) {
    std::vector<Part> parts;
    for (int i = 0; i < count; ++i)
        parts.push_back({i + 1, sphere(0.1, 20), kBronze, moved_by({0.3 * i, 0, 0})});
    return parts;
}

}  // namespace

TEST_CASE("a node whose results stay the same is queried less and less often") {
    plan::OcclusionHistory history(3);
    int queried = 0;
    std::vector<int> gaps;
    for (int image = 0, last = 0; image < 1000; ++image) {
        history.begin_image(glm::dvec3(0), 1);
        CHECK_FALSE(history.is_occluded(2));
        if (!history.is_query_due(2)) continue;
        history.set_occluded(2, false);
        if (queried++ > 0) gaps.push_back(image - last);
        last = image;
    }
    REQUIRE(gaps.size() > 8);
    CHECK(std::ranges::is_sorted(gaps));
    CHECK(gaps.front() <= 2);
    CHECK(gaps.back() > static_cast<int>(plan::OcclusionHistory::kLongestInterval) / 4);
    CHECK(gaps.back() <= static_cast<int>(plan::OcclusionHistory::kLongestInterval));
    // After another result it is soon queried again.
    history.set_occluded(2, true);
    CHECK(history.is_occluded(2));
    CHECK_FALSE(history.is_occluded(1));
    history.begin_image(glm::dvec3(0), 1);
    history.begin_image(glm::dvec3(0), 1);
    CHECK(history.is_query_due(2));
}

TEST_CASE("all items are drawn and queried at first, then those that were occluded are culled") {
    const plan::View view = view_of(balls(6), {0.8, 0, 5});
    plan::OcclusionHistory history = history_of(view);
    CHECK(plan_of(view, history).boxes.empty());
    plan::OcclusionPlan plan = plan_of(view, history);
    CHECK(plan.culled.empty());
    REQUIRE(plan.boxes.size() == 6);
    const std::vector<scene::Index> all = nodes_of(plan::plan_frame(view).scene.opaque);
    REQUIRE(all.size() == 6);
    for (const scene::Index node : all) history.set_occluded(node, node == all[1] || node == all[4]);
    plan = plan_of(view, history);
    CHECK(nodes_of(plan.culled) == std::vector{all[1], all[4]});
    CHECK(nodes_of(plan.drawn) == std::vector{all[0], all[2], all[3], all[5]});
    REQUIRE(plan.boxes.size() >= 2);
    CHECK(plan.boxes[0].node == all[1]);
    CHECK(plan.boxes[1].node == all[4]);
}

TEST_CASE("few occluded triangles are drawn, and queried now and then") {
    const plan::View view = view_of(balls(24), {3.4, 0, 12});
    plan::OcclusionHistory history = history_of(view);
    plan_of(view, history);
    const scene::Index hidden = plan::plan_frame(view).scene.opaque[3].node;
    std::size_t boxes = 0;
    for (int image = 0; image < 64; ++image) {
        history.set_occluded(hidden, true);
        const plan::OcclusionPlan plan = plan_of(view, history);
        CHECK(plan.culled.empty());
        for (const plan::OcclusionBox& box : plan.boxes) history.set_occluded(box.node, box.node == hidden);
        boxes += plan.boxes.size();
    }
    CHECK(boxes < 24 * 10);
}

TEST_CASE("where the eye jumps, all items are drawn and queried again") {
    plan::View view = view_of(balls(6), {0.8, 0, 5});
    plan::OcclusionHistory history = history_of(view);
    plan_of(view, history);
    const scene::Index occluded = plan::plan_frame(view).scene.opaque[2].node;
    history.set_occluded(occluded, true);
    view.camera = view_from({1.8, 0, 4.8}).camera;
    CHECK(nodes_of(plan_of(view, history).culled) == std::vector{occluded});
    view.camera = view_from({-3, 0, 4.8}).camera;
    const plan::OcclusionPlan plan = plan_of(view, history);
    CHECK(plan.culled.empty());
    CHECK(plan.boxes.empty());
    CHECK_FALSE(history.is_occluded(occluded));
    CHECK(plan_of(view, history).boxes.size() == 6);
}

TEST_CASE("small items, and those that cover many pixels for their triangles, are never queried") {
    std::vector<Part> parts = balls(1);
    parts.push_back({2, sphere(0.1, 8), kBronze, moved_by({0.5, 0, 0})});
    plan::View view = view_of(parts, {0, 0, 5});
    plan::OcclusionHistory history = history_of(view);
    plan_of(view, history);
    CHECK(plan_of(view, history).boxes.size() == 1);
    view.camera = view_from({0, 0, 0.3}).camera;
    view.width = 960;
    view.height = 640;
    plan::OcclusionHistory near = history_of(view);
    plan_of(view, near);
    CHECK(plan_of(view, near).boxes.empty());
}

TEST_CASE("faces are culled in realistic images only, and not by frustum culling") {
    plan::View view = view_from({0, 0, 5});
    CHECK(plan::culls_occluded(view));
    view.wireframe = true;
    CHECK_FALSE(plan::culls_occluded(view));
    view.wireframe = false;
    view.mode = plan::DrawMode::stylized;
    CHECK_FALSE(plan::culls_occluded(view));
    view.mode = plan::DrawMode::realistic;
    view.methods.culling = plan::Methods::Culling::frustum;
    CHECK_FALSE(plan::culls_occluded(view));
}

TEST_CASE("a box holds its item, turned, mirrored, sheared or flattened, and some more") {
    Dice dice(5);
    std::vector<Part> parts = random_parts(dice, kBronze);
    for (Part& part : parts) part.matrix = moved_by({0, 0, -30}) * part.matrix;
    parts[0].matrix *= scaled_by({1, 0, 1});
    parts[1].matrix *= scaled_by({1, 0, 0});
    parts[2].matrix *= scaled_by({0, 0, 0});
    parts[3].matrix *= turned_by(40, {1, 1, 0}) * scaled_by({1, 4, 0.2}) * turned_by(30, {0, 1, 1});
    const plan::View view = view_of(parts, {0, 0, 5});
    const std::vector<plan::DrawItem> items = plan::visible_items(view);
    REQUIRE(items.size() == parts.size());
    for (const plan::DrawItem& item : items) {
        const auto box = plan::occlusion_box(item, view);
        REQUIRE(box);
        CHECK(box->node == item.node);
        const glm::dmat4 box_from_view = glm::inverse(box->view_from_box);
        CHECK(glm::determinant(box->view_from_box) > 0);
        for (const glm::dvec3& point :
             view.scene->scene->geometries()[static_cast<std::size_t>(item.geometry)].positions) {
            const glm::dvec3 in_view(item.view_from_node * glm::dvec4(point, 1));
            for (int axis = 0; axis < 3; ++axis)
                for (const double side : {-1e-4, 1e-4}) {
                    glm::dvec3 beside = in_view;
                    beside[axis] += side * glm::length(in_view);
                    const glm::dvec3 in_box = glm::abs(glm::dvec3(box_from_view * glm::dvec4(beside, 1)));
                    CHECK(std::max({in_box.x, in_box.y, in_box.z}) <= 1 + 1e-9);
                }
        }
    }
}

TEST_CASE("what surrounds the eye, lies behind it or comes close to it has no box") {
    for (const glm::dvec3& place :
         {glm::dvec3(0), glm::dvec3(0, 0, 1.5), glm::dvec3(0, 0, -1.01), glm::dvec3(1.5, 0, 0)}) {
        const plan::View view = view_of({{1, sphere(1, 20), kBronze, moved_by(place)}}, {0, 0, 0.001});
        CHECK_FALSE(plan::occlusion_box(plan::visible_items(view)[0], view));
    }
    const plan::View view = view_of({{1, sphere(1, 20), kBronze, moved_by({0, 0, -1.2})}}, {0, 0, 0.001});
    CHECK(plan::occlusion_box(plan::visible_items(view)[0], view));
}
