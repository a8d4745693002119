#include "plan/frame_plan.hpp"

#include <doctest/doctest.h>

#include "shapes.hpp"
#include "views.hpp"

using namespace vrut;

namespace {

/// Geometry nodes 1 to 4 with the materials plain, glass, chrome and mirrored glass, and node 5 with none.
scene::PlacedScene showroom() {
    scene::SceneParts parts;
    parts.geometries = {quad(1)};
    parts.materials.resize(4);
    parts.materials[1].diffuse.a = 0.5;
    parts.materials[2].reflectivity = 0.1;
    parts.materials[3].diffuse.a = 0.99;
    parts.materials[3].reflectivity = 1;
    for (scene::Id id = 1; id <= 5; ++id) {
        const scene::GeometryData data{0, id == 5 ? scene::kNone : static_cast<scene::Index>(id - 1)};
        parts.nodes.push_back(
            {scene::Node{id, {}, scene::NodeType::geometry, scene::kNone, {}, true, glm::dmat4(1), data}, 0});
    }
    parts.nodes.push_back(
        {scene::Node{
             6, {}, scene::NodeType::light, scene::kNone, {}, true, glm::dmat4(1), scene::LightData{}},
         0});
    return scene::place(*scene::Scene::build(std::move(parts)));
}

}  // namespace

TEST_CASE("geometry nodes are counted by what their material is now") {
    scene::PlacedScene placed = showroom();
    CHECK(plan::count_classes(placed) == plan::ClassCounts{2, 2, 1});
    for (scene::NodeState& state : placed.nodes) state.material = 2;
    CHECK(plan::count_classes(placed) == plan::ClassCounts{0, 0, 5});
    CHECK(plan::count_classes(scene::place(scene::Scene())) == plan::ClassCounts{});
}

TEST_CASE("a plan holds what the view needs and no more") {
    plan::View view = view_from({0, 0, 5});
    CHECK(plan::plan_frame(view).scene.opaque.empty());
    scene::PlacedScene placed = showroom();
    for (scene::NodeState& state : placed.nodes)
        if (state.material == 2) state.material = 0;  // no mirrors
    view.scene = std::make_shared<const scene::PlacedScene>(std::move(placed));
    const auto sizes = [&] {
        const plan::FramePlan plan = plan::plan_frame(view);
        return std::array{plan.scene.opaque.size(), plan.edges.size(), plan.overlay.opaque.size(),
                          plan.selected.size()};
    };
    using Sizes = std::array<std::size_t, 4>;
    CHECK(sizes() == Sizes{3, 0, 0, 0});
    view.wireframe = true;
    CHECK(sizes() == Sizes{0, 5, 0, 0});
    view.mode = plan::DrawMode::stylized;
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

TEST_CASE("textures, colours of vertices and the panorama are planned for surfaces that show them") {
    scene::SceneParts parts;
    parts.textures.resize(1);
    parts.geometries = {quad(1), sphere(1, 4), sphere(1, 4)};
    parts.geometries[2].texcoords.assign(parts.geometries[2].positions.size(), glm::vec2(0));
    parts.geometries[1].colors.assign(parts.geometries[1].positions.size(), glm::vec3(0.5));
    parts.materials.resize(3);
    parts.materials[0].reflectivity = 0.5;
    parts.materials[1] = parts.materials[0];
    parts.materials[1].diffuse.a = 0.5;
    parts.materials[2].texture = 0;
    for (scene::Id id = 0; id < 9; ++id)
        parts.nodes.push_back({scene::Node{id + 1,
                                           {},
                                           scene::NodeType::geometry,
                                           scene::kNone,
                                           {},
                                           true,
                                           glm::dmat4(1),
                                           scene::GeometryData{static_cast<scene::Index>(id / 3),
                                                               static_cast<scene::Index>(id % 3)}},
                               0});
    plan::View view = view_from({0, 0, 5});
    view.scene =
        std::make_shared<const scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
    const auto ids = [&](const auto& chosen) {
        const plan::DrawLists lists = plan::plan_frame(view).scene;
        std::vector<plan::DrawItem> items = lists.opaque;
        for (const plan::TransparentGroup& group : lists.transparent)
            items.insert(items.end(), group.items.begin(), group.items.end());
        std::vector<scene::Id> result;
        for (const plan::DrawItem& item : items)
            if (chosen(item))
                result.push_back(view.scene->scene->nodes()[static_cast<std::size_t>(item.node)].id);
        std::sort(result.begin(), result.end());
        return result;
    };
    const auto reflecting = [&] { return ids([](const plan::DrawItem& item) { return item.environment; }); };
    const auto textured = [&] { return ids([](const plan::DrawItem& item) { return item.texture == 0; }); };
    const auto colored = [&] { return ids([](const plan::DrawItem& item) { return item.colored; }); };
    CHECK(textured() == std::vector<scene::Id>{9});
    CHECK(colored() == std::vector<scene::Id>{4, 5, 6});
    CHECK(reflecting().empty());
    view.background.cube_map.emplace();
    // All but the opaque plane, which is a mirror.
    CHECK(reflecting() == std::vector<scene::Id>{2, 4, 5, 7, 8});
    view.mode = plan::DrawMode::stylized;
    CHECK(reflecting().empty());
    CHECK(textured().empty());
    CHECK(colored().empty());
}

TEST_CASE("what is not drawn is told, and lights are drawn") {
    const auto notices = plan::unsupported_features(*showroom().scene);
    CHECK(notices == std::vector<std::string>{"1 curved or transparent reflective parts reflect nothing: "
                                              "the scene has no cube map"});
    scene::SceneParts parts;
    parts.geometries = {sphere(1, 4)};
    parts.materials.resize(1);
    parts.materials[0].reflectivity = 1;
    parts.nodes = {{scene::Node{1,
                                {},
                                scene::NodeType::geometry,
                                scene::kNone,
                                {},
                                true,
                                glm::dmat4(1),
                                scene::GeometryData{0, 0}},
                    0},
                   {scene::Node{2,
                                {},
                                scene::NodeType::background,
                                scene::kNone,
                                {},
                                true,
                                glm::dmat4(1),
                                scene::BackgroundData{}},
                    0}};
    CHECK(plan::unsupported_features(*scene::Scene::build(parts)).size() == 1);
    std::get<scene::BackgroundData>(parts.nodes[1].node.data).cube_textures.emplace();
    CHECK(plan::unsupported_features(*scene::Scene::build(parts)).empty());

    parts.geometries = {quad(1)};
    const auto hang = [&](scene::Id mirrors) {
        parts.nodes.clear();
        for (scene::Id id = 1; id <= mirrors; ++id)
            parts.nodes.push_back({scene::Node{id,
                                               {},
                                               scene::NodeType::geometry,
                                               scene::kNone,
                                               {},
                                               true,
                                               glm::dmat4(1),
                                               scene::GeometryData{0, 0}},
                                   0});
        return plan::unsupported_features(*scene::Scene::build(parts));
    };
    CHECK(hang(16).empty());
    CHECK(hang(17) ==
          std::vector<std::string>{"17 planar mirrors: only the 16 largest in the image show reflections"});
}
