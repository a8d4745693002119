#include "room/scene_state.hpp"

#include <charconv>
#include <cmath>

#include "mesh/support_function.hpp"
#include "plan/frame_plan.hpp"

namespace vrut::server::room {

namespace code = protocol::error_code;
using protocol::Error;

namespace {

std::optional<std::string> picture_of(const scene::BackgroundData& data, const scene::Scene& scene) {
    if (data.cube_map && !data.only_reflected) return (*data.cube_map)[0];
    const std::string& image = scene.material(data.material).image;
    return image.empty() ? std::nullopt : std::optional(image);
}

/// A little larger, so that it cuts nothing, and has a size in each direction.
protocol::SectionBoxState box_around(const math::Bounds& bounds) {
    const glm::dvec3 farthest = glm::max(glm::abs(bounds.min), glm::abs(bounds.max));
    const double margin =
        1e-3 * std::max(bounds.radius(), 1e-6 * std::max({farthest.x, farthest.y, farthest.z}));
    protocol::SectionBoxState box;
    box.min = bounds.min - (margin > 0 ? margin : 1);
    box.max = bounds.max + (margin > 0 ? margin : 1);
    return box;
}

void add_backgrounds(const scene::PlacedScene& placed, const glm::dvec3& eye,
                     protocol::BackgroundsState& backgrounds) {
    auto items = *backgrounds.items;
    scene::Id first = -1;
    for (std::size_t i = 0; i < placed.nodes.size(); ++i) {
        const scene::Node& node = placed.scene->nodes()[i];
        const auto* data = std::get_if<scene::BackgroundData>(&node.data);
        if (!data) continue;
        const glm::dvec4 color = glm::min(placed.scene->material(data->material).diffuse, glm::dvec4(1));
        items[std::to_string(node.id)] = {node.name, color, picture_of(*data, *placed.scene)};
        if (scene::is_shown(placed, static_cast<scene::Index>(i), eye) && (first < 0 || node.id < first))
            first = node.id;
    }
    backgrounds.items.set(std::move(items));
    if (first >= 0) backgrounds.active = std::to_string(first);
}

const char* name_of(scene::LightData::Type type) {
    switch (type) {
        case scene::LightData::Type::point:
            return "point";
        case scene::LightData::Type::directional:
            return "directional";
        case scene::LightData::Type::spot:
            return "spot";
    }
    return "";
}

void add_lights(const scene::Scene& scene, protocol::LightsState& lights) {
    auto items = *lights.items;
    items["headlight"] = {"Headlight", "point", {1, 1, 1, 1}, {1, 0, 0}};
    for (const scene::Node& node : scene.nodes())
        if (const auto* data = std::get_if<scene::LightData>(&node.data))
            items[std::to_string(node.id)] = {node.name, name_of(data->type), data->color, data->attenuation};
    lights.items.set(std::move(items));
}

protocol::Shared<protocol::Names> camera_names(const scene::Scene& scene) {
    protocol::Names names;
    for (const scene::Node& node : scene.nodes())
        if (node.type == scene::NodeType::camera) names[std::to_string(node.id)] = {node.name};
    return {std::make_shared<const protocol::Names>(std::move(names))};
}

protocol::Shared<protocol::Names> material_names(const scene::Scene& scene) {
    protocol::Names names;
    for (const scene::Material& material : scene.materials())
        names[std::to_string(material.id)] = {material.name};
    return {std::make_shared<const protocol::Names>(std::move(names))};
}

}  // namespace

scene::Index find_node(const scene::Scene& scene, const std::string& key) {
    scene::Id id = -1;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), id);
    const bool canonical =
        error == std::errc() && end == key.data() + key.size() && std::to_string(id) == key;
    return canonical ? scene.find_node(id) : scene::kNone;
}

namespace {

scene::Index find_material(const scene::Scene& scene, scene::Id id) {
    const auto& materials = scene.materials();
    const auto found = std::find_if(materials.begin(), materials.end(),
                                    [&](const scene::Material& material) { return material.id == id; });
    return found == materials.end() ? scene::kNone : static_cast<scene::Index>(found - materials.begin());
}

/// One node's override, checked and put into its state; what equals the file's is cleared.
std::optional<Error> apply(protocol::NodeOverride& change, const scene::Scene& scene, const scene::Node& node,
                           scene::NodeState& state) {
    const std::string path = "'nodes." + std::to_string(node.id) + ".";
    const auto use = [](auto& wanted, auto& value) {
        if (!wanted) return;
        if (value == static_cast<std::decay_t<decltype(value)>>(*wanted)) wanted.reset();
    };
    if (change.active_child) {
        const bool is_switch = std::holds_alternative<scene::SwitchData>(node.data);
        if (!is_switch || *change.active_child >= static_cast<int>(node.children.size()))
            return Error{{},
                         code::out_of_range,
                         path + "activeChild': " +
                             (is_switch ? "the switch has " + std::to_string(node.children.size()) +
                                              " children, counted from 0"
                                        : "the node is no switch")};
    }
    scene::Index material = state.material;
    if (change.material) {
        if (!std::holds_alternative<scene::GeometryData>(node.data))
            return Error{{}, code::out_of_range, path + "material': the node has no geometry"};
        material = find_material(scene, *change.material);
        if (material == scene::kNone)
            return Error{{},
                         code::unknown_node,
                         path + "material': there is no material " + std::to_string(*change.material)};
    }
    if (change.matrix) {
        const glm::dmat4& m = *change.matrix;
        if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
            return Error{{}, code::out_of_range, path + "matrix': the last row must be 0 0 0 1"};
    }
    use(change.active, state.active);
    use(change.active_child, state.active_child);
    use(change.matrix, state.matrix);
    if (material == state.material) change.material.reset();
    if (change.active) state.active = *change.active;
    if (change.active_child) state.active_child = *change.active_child;
    if (change.matrix) state.matrix = *change.matrix;
    state.material = material;
    return std::nullopt;
}

std::vector<protocol::SceneState::Seat> seats_of(const scene::PlacedScene& placed) {
    std::vector<protocol::SceneState::Seat> seats;
    for (const scene::Seat& seat : scene::seats(placed)) seats.push_back({seat.eye, seat.radius});
    return seats;
}

}  // namespace

protocol::State starting_state(const scenes::LoadedScene& loaded, double aspect,
                               const navigation::Cover& cover) {
    protocol::State state;
    const scene::PlacedScene& placed = *loaded.placed;
    const scene::Scene& scene = *placed.scene;
    state.scene.value = std::make_shared<const protocol::SceneState>(
        protocol::SceneState{.name = scene.name(),
                             .file = loaded.name,
                             .up_axis = loaded.up_axis,
                             .nodes = scene.nodes().size(),
                             .materials = scene.materials().size(),
                             .geometries = scene.geometries().size(),
                             .triangles = scene.triangle_count(),
                             .bounds = {placed.bounds.empty() ? glm::dvec3(0) : placed.bounds.min,
                                        placed.bounds.empty() ? glm::dvec3(0) : placed.bounds.max},
                             .seats = seats_of(placed),
                             .notices = loaded.notices});
    state.cameras = camera_names(scene);
    state.materials = material_names(scene);
    state.views.set("home", {home_pose(placed, aspect, cover, loaded.picking_trees.get()), {}});
    const scene::Index node = scene::first_camera_node(placed);
    state.camera = node != scene::kNone ? state_at_node(*scene::camera_at(placed, node), placed, node)
                                        : state_of(camera_of(state.views->at("home")), placed.bounds);
    add_lights(scene, state.lights);
    add_backgrounds(placed, state.camera.eye, state.backgrounds);
    if (!placed.bounds.empty()) state.section_box = box_around(placed.bounds);
    state.unit.metres = placed.scene->unit().value_or(state.unit.metres);
    count_classes(state, placed);
    return state;
}

void count_classes(protocol::State& state, const scene::PlacedScene& placed) {
    const plan::ClassCounts counts = plan::count_classes(placed);
    state.renderer.solid = counts.solid;
    state.renderer.transparent = counts.transparent;
    state.renderer.reflective = counts.reflective;
}

protocol::Pose home_pose(const scene::PlacedScene& placed, double aspect, const navigation::Cover& cover,
                         const mesh::PickingTrees* trees) {
    const scene::Index node = scene::first_camera_node(placed);
    return pose_of(node != scene::kNone
                       ? *scene::camera_at(placed, node)
                       : navigation::home_camera(fit_target(placed, 0, trees), aspect, cover));
}

navigation::FitTarget fit_target(const scene::PlacedScene& placed, scene::Index node,
                                 const mesh::PickingTrees* trees,
                                 std::span<const scene::ClipPlane> clip_planes) {
    const mesh::SupportFunction support(placed, node, trees, clip_planes);
    if (support.bounds().empty() && !clip_planes.empty()) return fit_target(placed, node, trees);
    return {support.bounds(), support};
}

scene::Camera camera_of(const protocol::Pose& pose) {
    return {pose.eye, pose.focus, pose.up, pose.center, pose.fov};
}

protocol::Pose pose_of(const scene::Camera& camera) {
    return {camera.eye, camera.focus, camera.up, camera.center, camera.fov};
}

protocol::CameraState state_of(const scene::Camera& camera, const math::Bounds& bounds) {
    const scene::ClipRange range = scene::fit_clip_range(camera, bounds);
    return {pose_of(camera), {}, {}, range.near, range.far};
}

protocol::CameraState state_at_node(const scene::Camera& camera, const scene::PlacedScene& placed,
                                    scene::Index node) {
    protocol::CameraState state = state_of(camera, placed.bounds);
    const scene::Node& camera_node = placed.scene->nodes()[static_cast<std::size_t>(node)];
    state.node = camera_node.id;
    state.name = camera_node.name;
    return state;
}

tl::expected<scene::Camera, Error> node_camera(const scene::PlacedScene& placed, scene::Id node,
                                               const std::string& what) {
    const scene::Index index = placed.scene->find_node(node);
    if (index == scene::kNone ||
        placed.scene->nodes()[static_cast<std::size_t>(index)].type != scene::NodeType::camera)
        return tl::unexpected(
            Error{{}, code::unknown_node, what + ": there is no camera node " + std::to_string(node)});
    const std::optional<scene::Camera> camera = scene::camera_at(placed, index);
    if (!camera)
        return tl::unexpected(
            Error{{}, code::failed, what + ": camera node " + std::to_string(node) + " sees nothing"});
    return *camera;
}

tl::expected<scene::Camera, Error> overlaid(const scene::Camera& base, const protocol::CameraOverlay& overlay,
                                            const scene::PlacedScene& placed, const std::string& what) {
    scene::Camera camera = base;
    if (overlay.node) {
        auto at_node = node_camera(placed, *overlay.node, what + ".node");
        if (!at_node) return at_node;
        camera = *at_node;
    }
    const scene::Camera before = camera;
    camera.eye = overlay.eye.value_or(camera.eye);
    camera.focus = overlay.focus.value_or(camera.focus);
    camera.up = overlay.up.value_or(camera.up);
    camera.center = overlay.center.value_or(camera.center);
    camera.fov = overlay.fov.value_or(camera.fov);
    if (!overlay.up && (overlay.eye || overlay.focus)) camera = scene::with_roll_of(before, camera);
    if (!scene::is_valid_pose(camera, placed.bounds.radius()))
        return tl::unexpected(
            Error{{},
                  code::out_of_range,
                  what + ": eye and focus must be apart, and up neither zero nor along the view"});
    return scene::with_orthogonal_up(camera);
}

tl::expected<navigation::CameraPath, Error> flight_path(const protocol::Fly& fly, const scene::Camera& from,
                                                        const scene::PlacedScene& placed) {
    std::vector<navigation::CameraKeyframe> keyframes;
    scene::Camera before = from;
    for (const protocol::Fly::Keyframe& keyframe : fly.keyframes) {
        auto laid = overlaid(before, keyframe.camera, placed,
                             "keyframes[" + std::to_string(keyframes.size()) + "].camera");
        if (!laid) return tl::unexpected(laid.error());
        keyframes.push_back({keyframe.at, *laid});
        before = *laid;
    }
    return navigation::CameraPath(from, keyframes, static_cast<navigation::Easing>(fly.easing));
}

namespace {

Error no_node(const std::string& key) {
    return {{}, code::unknown_node, "'nodes': there is no node " + key.substr(0, 40)};
}

}  // namespace

std::vector<Error> node_problems(const scene::Scene& scene,
                                 const protocol::SharedMap<protocol::NodeOverride>& overrides) {
    std::vector<Error> problems;
    for (const auto& [key, override] : *overrides) {
        const scene::Index index = find_node(scene, key);
        if (index == scene::kNone) {
            problems.push_back(no_node(key));
            continue;
        }
        const scene::Node& node = scene.nodes()[static_cast<std::size_t>(index)];
        scene::NodeState state = scene::file_state(node);
        protocol::NodeOverride change = override;
        if (auto error = apply(change, scene, node, state)) problems.push_back(*std::move(error));
    }
    return problems;
}

tl::expected<std::vector<scene::NodeState>, Error> node_states(
    const scene::Scene& scene, protocol::SharedMap<protocol::NodeOverride>& overrides) {
    std::vector<scene::NodeState> states = scene::file_states(scene);
    auto changes = *overrides;
    for (auto& [key, change] : changes) {
        const scene::Index index = find_node(scene, key);
        if (index == scene::kNone) return tl::unexpected(no_node(key));
        const auto place = static_cast<std::size_t>(index);
        if (auto error = apply(change, scene, scene.nodes()[place], states[place]))
            return tl::unexpected(*std::move(error));
    }
    std::erase_if(changes, [](const auto& entry) { return entry.second == protocol::NodeOverride{}; });
    overrides.set(std::move(changes));
    return states;
}

namespace {

/// The active one, if it is shown; its colour is the state's.
plan::Background seen_background(const protocol::BackgroundsState& backgrounds,
                                 const scene::PlacedScene& placed, const glm::dvec3& eye) {
    const scene::Index node = find_node(*placed.scene, backgrounds.active);
    if (!scene::is_shown(placed, node, eye)) return {glm::dvec3(backgrounds.color), scene::kNone, {}, false};
    const auto& data =
        std::get<scene::BackgroundData>(placed.scene->nodes()[static_cast<std::size_t>(node)].data);
    return {glm::dvec3(backgrounds.items->at(backgrounds.active).color),
            placed.scene->material(data.material).texture, data.cube_textures, data.only_reflected};
}

/// Before one without a cube map surfaces reflect the first that is only reflected, if it is shown.
plan::Background background_of(const protocol::BackgroundsState& backgrounds,
                               const scene::PlacedScene& placed, const glm::dvec3& eye) {
    plan::Background background = seen_background(backgrounds, placed, eye);
    for (const scene::Index node : placed.scene->reflected_backgrounds()) {
        if (background.cube_map || !scene::is_shown(placed, node, eye)) continue;
        background.cube_map =
            std::get<scene::BackgroundData>(placed.scene->nodes()[static_cast<std::size_t>(node)].data)
                .cube_textures;
        background.only_reflected = true;
    }
    return background;
}

}  // namespace

std::vector<plan::PlacedMarker> markers_of(const std::map<std::string, protocol::Marker>& markers,
                                           const scene::PlacedScene& placed) {
    std::vector<plan::PlacedMarker> result;
    for (const auto& [name, marker] : markers) {
        glm::dvec3 point = marker.point;
        if (marker.node) {
            const scene::Index node = placed.scene->find_node(*marker.node);
            if (!scene::is_shown(placed, node, std::nullopt)) continue;
            point = glm::dvec3(placed.world[static_cast<std::size_t>(node)] * glm::dvec4(point, 1));
        }
        const bool finite = std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
        if (finite) result.push_back({point, name});
    }
    return result;
}

std::vector<scene::ClipPlane> clip_planes_of(const protocol::State& state) {
    std::vector<scene::ClipPlane> planes;
    planes.reserve(scene::kMostClipPlanes);
    for (const auto& [name, section] : *state.sections)
        if (section.on) planes.push_back({section.normal, section.distance, section.caps, section.hatched});
    const protocol::SectionBoxState& box = state.section_box;
    if (!box.on) return planes;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 along(0);
        along[axis] = 1;
        planes.push_back({along, box.max[axis], box.caps, box.hatched});
        planes.push_back({-along, -box.min[axis], box.caps, box.hatched});
    }
    return planes;
}

plan::View view_of(const protocol::State& state, std::shared_ptr<const scene::PlacedScene> placed) {
    plan::View view;
    view.camera = camera_of(state.camera);
    const protocol::LightState& light = state.lights.items->at(state.lights.active);
    if (const scene::Index node = find_node(*placed->scene, state.lights.active); node != scene::kNone)
        view.light = scene::light_of(*placed, node);
    view.light.color = light.color;
    view.light.attenuation = light.attenuation;
    view.mode = static_cast<plan::DrawMode>(state.renderer.mode);
    view.wireframe = state.renderer.wireframe;
    if (state.renderer.show_selection && state.selection.node)
        view.selected = placed->scene->find_node(*state.selection.node);
    view.background = background_of(state.backgrounds, *placed, view.camera.eye);
    view.clip_planes = clip_planes_of(state);
    view.scene = std::move(placed);
    return view;
}

protocol::FrameHeader header_of(const protocol::State& state, const plan::View& view,
                                const protocol::Resize& view_size) {
    protocol::FrameHeader header;
    header.camera.pose = state.camera;
    header.camera.pose.name.reset();  // of any length; the node's id says it
    header.camera.view_matrix = scene::view_from_world(view.camera);
    header.camera.projection_matrix =
        math::clip_from_view(plan::projection_of(view), state.camera.near, state.camera.far);
    header.width = view.width;
    header.height = view.height;
    header.view = view_size;
    header.renderer = {state.renderer.mode, state.renderer.wireframe, state.renderer.show_selection};
    if (view.markers)
        for (const plan::PlacedMarker& marker : *view.markers) header.markers[marker.name] = marker.point;
    return header;
}

}  // namespace vrut::server::room
