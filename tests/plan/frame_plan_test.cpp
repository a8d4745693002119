#include "plan/frame_plan.hpp"

#include <doctest/doctest.h>

#include "shapes.hpp"
#include "views.hpp"

using namespace vrut;

namespace {

/// Geometry nodes 1 to 4 with the materials plain, glass, chrome and mirrored glass, and node 5 with none.
PlacedScene showroom() {
    SceneParts parts;
    parts.geometries = {quad(1)};
    parts.materials.resize(4);
    parts.materials[1].diffuse.a = 0.5;
    parts.materials[2].reflectivity = 0.1;
    parts.materials[3].diffuse.a = 0.99;
    parts.materials[3].reflectivity = 1;
    for (Id id = 1; id <= 5; ++id) {
        const GeometryData data{0, id == 5 ? kNone : static_cast<Index>(id - 1)};
        parts.nodes.push_back({Node{id, {}, NodeType::geometry, kNone, {}, true, glm::dmat4(1), data}, 0});
    }
    parts.nodes.push_back({Node{6, {}, NodeType::light, kNone, {}, true, glm::dmat4(1), LightData{}}, 0});
    return place(*Scene::build(std::move(parts)));
}

}  // namespace

TEST_CASE("geometry nodes are counted by what their material is now") {
    PlacedScene placed = showroom();
    CHECK(count_classes(placed) == ClassCounts{2, 2, 1});
    for (NodeState& state : placed.nodes) state.material = 2;
    CHECK(count_classes(placed) == ClassCounts{0, 0, 5});
    CHECK(count_classes(place(Scene())) == ClassCounts{});
}

TEST_CASE("a plan holds what the view needs and no more") {
    View view = view_from({0, 0, 5});
    CHECK(plan_frame(view).scene.opaque.empty());
    PlacedScene placed = showroom();
    for (NodeState& state : placed.nodes)
        if (state.material == 2) state.material = 0;  // no mirrors
    view.scene = std::make_shared<const PlacedScene>(std::move(placed));
    const auto sizes = [&] {
        const FramePlan plan = plan_frame(view);
        return std::array{plan.scene.opaque.size(), plan.edges.size(), plan.overlay.opaque.size(),
                          plan.selected.size()};
    };
    using Sizes = std::array<std::size_t, 4>;
    CHECK(sizes() == Sizes{3, 0, 0, 0});
    view.wireframe = true;
    CHECK(sizes() == Sizes{0, 5, 0, 0});
    view.mode = DrawMode::stylized;
    CHECK(sizes() == Sizes{0, 5, 0, 0});
    view.selected = view.scene->scene->find_node(2);
    CHECK(sizes() == Sizes{0, 4, 0, 1});
    view.wireframe = false;
    CHECK(sizes() == Sizes{4, 4, 1, 1});
    view.selected = view.scene->scene->find_node(0);
    CHECK(sizes() == Sizes{0, 0, 5, 5});
    view.selected = view.scene->scene->find_node(6);
    CHECK(sizes() == Sizes{5, 5, 0, 0});
}

TEST_CASE("textures and the panorama are planned for surfaces that show them") {
    SceneParts parts;
    parts.textures.resize(1);
    parts.geometries = {quad(1), sphere(1, 4), sphere(1, 4)};
    parts.geometries[2].texcoords.assign(parts.geometries[2].positions.size(), glm::vec2(0));
    parts.materials.resize(3);
    parts.materials[0].reflectivity = 0.5;
    parts.materials[1] = parts.materials[0];
    parts.materials[1].diffuse.a = 0.5;
    parts.materials[2].texture = 0;
    for (Id id = 0; id < 9; ++id)
        parts.nodes.push_back({Node{id + 1,
                                    {},
                                    NodeType::geometry,
                                    kNone,
                                    {},
                                    true,
                                    glm::dmat4(1),
                                    GeometryData{static_cast<Index>(id / 3), static_cast<Index>(id % 3)}},
                               0});
    View view = view_from({0, 0, 5});
    view.scene = std::make_shared<const PlacedScene>(place(*Scene::build(std::move(parts))));
    const auto ids = [&](const auto& chosen) {
        const DrawLists lists = plan_frame(view).scene;
        std::vector<DrawItem> items = lists.opaque;
        for (const TransparentGroup& group : lists.transparent)
            items.insert(items.end(), group.items.begin(), group.items.end());
        std::vector<Id> result;
        for (const DrawItem& item : items)
            if (chosen(item))
                result.push_back(view.scene->scene->nodes()[static_cast<std::size_t>(item.node)].id);
        std::sort(result.begin(), result.end());
        return result;
    };
    const auto reflecting = [&] { return ids([](const DrawItem& item) { return item.environment; }); };
    const auto textured = [&] { return ids([](const DrawItem& item) { return item.texture == 0; }); };
    CHECK(textured() == std::vector<Id>{9});
    CHECK(reflecting().empty());
    view.background.cube_map.emplace();
    // All but the opaque plane, which is a mirror.
    CHECK(reflecting() == std::vector<Id>{2, 4, 5, 7, 8});
    view.mode = DrawMode::stylized;
    CHECK(reflecting().empty());
    CHECK(textured().empty());
}

TEST_CASE("what is not drawn is told, and lights are drawn") {
    const auto notices = unsupported_features(*showroom().scene);
    CHECK(notices == std::vector<std::string>{"1 curved or transparent reflective parts have no cube map to "
                                              "reflect"});
    SceneParts parts;
    parts.geometries = {sphere(1, 4)};
    parts.materials.resize(1);
    parts.materials[0].reflectivity = 1;
    parts.nodes = {{Node{1, {}, NodeType::geometry, kNone, {}, true, glm::dmat4(1), GeometryData{0, 0}}, 0},
                   {Node{2, {}, NodeType::background, kNone, {}, true, glm::dmat4(1), BackgroundData{}}, 0}};
    CHECK(unsupported_features(*Scene::build(parts)).size() == 1);
    std::get<BackgroundData>(parts.nodes[1].node.data).cube_textures.emplace();
    CHECK(unsupported_features(*Scene::build(parts)).empty());

    parts.geometries = {quad(1)};
    const auto hang = [&](Id mirrors) {
        parts.nodes.clear();
        for (Id id = 1; id <= mirrors; ++id)
            parts.nodes.push_back(
                {Node{id, {}, NodeType::geometry, kNone, {}, true, glm::dmat4(1), GeometryData{0, 0}}, 0});
        return unsupported_features(*Scene::build(parts));
    };
    CHECK(hang(16).empty());
    CHECK(hang(17) ==
          std::vector<std::string>{"17 mirrors: the scene is seen in the 16 that are largest in a picture"});
}
