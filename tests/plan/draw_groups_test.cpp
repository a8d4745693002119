#include "plan/draw_groups.hpp"

#include <doctest/doctest.h>

#include <random>

#include "plan/frame_plan.hpp"
#include "shapes.hpp"

using namespace vrut;

namespace {

/// Boxes of half a unit, with textures that take turns.
struct Boxes {
    std::shared_ptr<const scene::PlacedScene> scene;
    std::vector<plan::DrawItem> items;
};

Boxes boxes_at(const std::vector<glm::dvec3>& places, int textures) {
    std::vector<Part> parts;
    for (std::size_t i = 0; i < places.size(); ++i)
        parts.push_back({static_cast<scene::Id>(i + 1), box(glm::dvec3(0.5)), material_of(glm::dvec3(0.5)),
                         moved_by(places[i])});
    Boxes result{scene_of(parts), {}};
    for (std::size_t i = 0; i < places.size(); ++i) {
        plan::DrawItem item;
        item.node = result.scene->scene->find_node(static_cast<scene::Id>(i + 1));
        item.geometry = static_cast<scene::Index>(i);
        item.texture = static_cast<scene::Index>(i) % textures;
        item.view_from_node = moved_by(places[i]);
        result.items.push_back(item);
    }
    return result;
}

std::vector<scene::Index> order_of(Boxes boxes) {
    plan::group_for_draws(boxes.items, *boxes.scene, glm::dvec3(0));
    std::vector<scene::Index> order;
    for (const plan::DrawItem& item : boxes.items) order.push_back(item.geometry);
    return order;
}

}  // namespace

TEST_CASE("items that are apart are grouped by what one draw call can draw, each group by rising id") {
    const Boxes boxes = boxes_at({{0, 0, -9}, {2, 0, -9}, {4, 0, -9}, {6, 0, -9}, {8, 0, -9}}, 2);
    CHECK(order_of(boxes) == std::vector<scene::Index>{0, 2, 4, 1, 3});
}

TEST_CASE("an item stays behind one of another texture that touches it") {
    CHECK(order_of(boxes_at({{0, 0, -9}, {1, 0, -9}, {2, 0, -9}}, 2)) == std::vector<scene::Index>{0, 1, 2});
    CHECK(order_of(boxes_at({{0, 0, -9}, {1.0005, 0, -9}, {2.001, 0, -9}}, 2)) ==
          std::vector<scene::Index>{0, 1, 2});
    CHECK(order_of(boxes_at({{0, 0, -9}, {1.1, 0, -9}, {2.2, 0, -9}}, 2)) ==
          std::vector<scene::Index>{0, 2, 1});
}

TEST_CASE("of any two items that overlap the one with the lower id stays first") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> anywhere(-12, 12);
    std::vector<glm::dvec3> places;
    for (int i = 0; i < 2000; ++i)
        places.emplace_back(anywhere(random), anywhere(random), anywhere(random) - 30);
    const std::vector<scene::Index> order = order_of(boxes_at(places, 5));
    REQUIRE(order.size() == places.size());
    int turned = 0, wrong = 0;
    for (std::size_t a = 0; a < order.size(); ++a)
        for (std::size_t b = a + 1; b < order.size(); ++b) {
            if (order[a] < order[b]) continue;
            ++turned;
            const glm::dvec3 apart = glm::abs(places[static_cast<std::size_t>(order[a])] -
                                              places[static_cast<std::size_t>(order[b])]);
            wrong += apart.x <= 1 && apart.y <= 1 && apart.z <= 1;
        }
    CHECK(turned > 1000);
    CHECK(wrong == 0);
}

TEST_CASE("what one draw call can draw") {
    plan::DrawItem item, other;
    other.geometry = other.material = other.node = 1;
    other.view_from_node = moved_by({1, 2, 3});
    CHECK(plan::share_draw(item, other));
    const auto shares = [&](auto change) {
        plan::DrawItem changed = other;
        change(changed);
        return plan::share_draw(item, changed);
    };
    CHECK(shares([](plan::DrawItem& changed) { changed.cull_mode = plan::CullMode::hidden_back; }));
    CHECK(shares([](plan::DrawItem& changed) { changed.mirrored = true; }));
    CHECK_FALSE(shares([](plan::DrawItem& changed) { changed.cull_mode = plan::CullMode::none; }));
    CHECK_FALSE(shares([](plan::DrawItem& changed) { changed.texture = 0; }));
    CHECK_FALSE(shares([](plan::DrawItem& changed) { changed.colored = true; }));
    CHECK_FALSE(shares([](plan::DrawItem& changed) { changed.emissive = true; }));
    CHECK_FALSE(shares([](plan::DrawItem& changed) { changed.metallic_roughness = true; }));
    CHECK_FALSE(shares([](plan::DrawItem& changed) { changed.coated = true; }));
    CHECK_FALSE(shares([](plan::DrawItem& changed) { changed.normal_texture = 0; }));
    CHECK_FALSE(shares([](plan::DrawItem& changed) { changed.occlusion_roughness_metallic_texture = 0; }));
    CHECK_FALSE(shares([](plan::DrawItem& changed) { changed.environment = true; }));
    CHECK_FALSE(shares([](plan::DrawItem& changed) { changed.clip_planes = {{0, 0, 1, 0}}; }));
}
