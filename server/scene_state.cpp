#include "scene_state.hpp"

#include "frame_plan.hpp"

namespace vrut {

namespace {

void add_backgrounds(const PlacedScene& placed, protocol::BackgroundsState& backgrounds) {
    const std::vector<bool> shown = shown_nodes(placed, std::nullopt);
    Id first = -1;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const Node& node = placed.scene->nodes()[i];
        const auto* data = std::get_if<BackgroundData>(&node.data);
        if (!data) continue;
        const glm::dvec4 color = glm::min(placed.scene->material(data->material).diffuse, glm::dvec4(1));
        backgrounds.items[std::to_string(node.id)] = {node.name, color};
        if (shown[i] && (first < 0 || node.id < first)) first = node.id;
    }
    if (first >= 0) backgrounds.active = std::to_string(first);
}

bool is_shown(const PlacedScene& placed, Id id) {
    const Index index = placed.scene->find_node(id);
    return index != kNone && shown_nodes(placed, std::nullopt)[static_cast<std::size_t>(index)];
}

}  // namespace

std::vector<std::string> all_notices(const Scene& scene) {
    std::vector<std::string> notices = scene.notices();
    for (std::string& notice : undrawn_features(scene)) notices.push_back(std::move(notice));
    return notices;
}

protocol::State starting_state(const PlacedScene& placed, double aspect, std::vector<std::string> notices) {
    protocol::State state;
    state.scene = {.name = placed.scene->name(),
                   .nodes = placed.scene->nodes().size(),
                   .materials = placed.scene->materials().size(),
                   .geometries = placed.scene->geometries().size(),
                   .triangles = placed.scene->triangle_count(),
                   .min = placed.bounds.empty() ? glm::dvec3(0) : placed.bounds.min,
                   .max = placed.bounds.empty() ? glm::dvec3(0) : placed.bounds.max,
                   .notices = std::move(notices)};
    const std::optional<Camera> node = first_camera_node(placed);
    state.camera = state_of(node ? *node : home_camera(placed.bounds, aspect), placed.bounds);
    state.lights.items["headlight"] = {
        .name = "Headlight", .type = "point", .color = {1, 1, 1, 1}, .attenuation = {1, 0, 0}};
    add_backgrounds(placed, state.backgrounds);
    return state;
}

Camera camera_of(const protocol::CameraState& state) {
    return {state.eye, state.focus, state.up, state.center, state.fov};
}

protocol::CameraState state_of(const Camera& camera, const Bounds& bounds) {
    const ClipRange range = fit_clip_range(camera, bounds);
    return {camera.eye, camera.focus, camera.up, camera.center, camera.fov, range.near, range.far};
}

View view_of(const protocol::State& state, std::shared_ptr<const PlacedScene> placed) {
    View view;
    view.camera = camera_of(state.camera);
    const protocol::LightState& headlight = state.lights.items.at("headlight");
    view.light.color = headlight.color;
    view.light.attenuation = headlight.attenuation;
    const std::string& active = state.backgrounds.active;
    const bool plain = active == "color" || !is_shown(*placed, std::stoll(active));
    view.background = glm::dvec3(plain ? state.backgrounds.color : state.backgrounds.items.at(active).color);
    view.scene = std::move(placed);
    return view;
}

}  // namespace vrut
