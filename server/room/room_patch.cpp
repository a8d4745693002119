// What a patch of the state does to scene and camera: all of it, or nothing.
#include <algorithm>

#include "room/room.hpp"

namespace vrut::server::room {

using protocol::Error;
namespace code = protocol::error_code;

namespace {

/// Their names as a sentence has them.
std::string listed(protocol::Sections sections) {
    const std::vector<std::string> names = protocol::names_of(sections);
    std::string text = "'" + names.front() + "'";
    for (std::size_t i = 1; i < names.size(); ++i)
        text += (i + 1 < names.size() ? ", '" : " and '") + names[i] + "'";
    return text;
}

}  // namespace

void Room::apply(const Received& received, const protocol::Patch& patch) {
    const bool drives_walls = may(clients_.at(received.client).role, protocol::Right::drive_walls);
    if (drives_walls && !protocol::names_only(*patch.patch, protocol::Sections::for_hosts))
        return reject(received, code::not_allowed,
                      "a host may patch nothing but " + listed(protocol::Sections::for_hosts));
    if (!may_steer(received)) return;
    if (patch.if_revision && options_.policy.judges &&
        document()->last_change(*patch.patch) > *patch.if_revision)
        return reject(
            received, code::stale_revision,
            "what the patch touches has changed since revision " + std::to_string(*patch.if_revision));
    auto next = protocol::patched(state_, starting_, *patch.patch);
    if (!next) return reject(received, next.error().code.c_str(), next.error().message);
    std::shared_ptr<const scene::PlacedScene> placed = scene_;
    auto error = use_nodes(*next, placed);
    const protocol::NamedCameraMembers named = protocol::named_camera_members(*patch.patch);
    if (!error) error = use_camera(*next, *placed, named);
    if (!error) error = use_entries(*next, *placed);
    if (error) return reject(received, error->code.c_str(), error->message);

    const protocol::ViewState home = state_.views->at("home");
    if (camera_of(next->camera) != camera() || next->views->at("home") != home) at_home_ = false;
    const std::optional<scene::Id> selected = next->selection.node;
    const bool pointing_changes = next->pointing != state_.pointing;
    steer(received);  // which may bring another size, and so another home
    if (at_home_) next->camera = state_of(camera(), placed->bounds);
    if (next->views->at("home") == home) next->views.set("home", state_.views->at("home"));
    next->control = state_.control;
    protocol::sign_notes(state_, *patch.patch, clients_.shown_name(received.client), *next);
    keep_shown_cue(*next);
    swings_.end_changed(*scene_->scene, *state_.nodes, *next->nodes);
    next->swings.set(swings_.states(*scene_->scene));
    state_ = *std::move(next);
    scene_ = std::move(placed);
    select(selected ? scene_->scene->find_node(*selected) : scene::kNone);
    gestures_.restart(camera());
    measure();
    if (drives_walls && named.any()) {
        walls_.jump();
        use_walls();
    }
    if (pointing_changes) use_pointing();
    answer(received);
}

std::optional<Error> Room::use_changes() {
    const auto patch = protocol::parse_patch(loaded_.changes);
    if (!patch) return patch.error();
    if (!protocol::names_only(*patch->patch, protocol::Sections::kept))
        return Error{
            {}, code::bad_message, "it names other members than " + listed(protocol::Sections::kept)};
    auto next = protocol::patched(state_, starting_, *patch->patch);
    if (!next) return next.error();
    std::shared_ptr<const scene::PlacedScene> placed = scene_;
    auto error = use_nodes(*next, placed);
    if (!error) error = use_entries(*next, *placed);
    if (error) return error;
    state_ = *std::move(next);
    scene_ = std::move(placed);

    const protocol::ViewState& home = state_.views->at("home");
    const bool is_moved = home != starting_.views->at("home");
    const scene::Index node =
        is_moved || !state_.camera.node ? scene::kNone : scene_->scene->find_node(*state_.camera.node);
    const auto at_node = node == scene::kNone ? std::nullopt : scene::camera_at(*scene_, node);
    state_.camera =
        at_node ? state_at_node(*at_node, *scene_, node) : state_of(camera_of(home), scene_->bounds);
    at_home_ = at_home_ && !is_moved;
    return std::nullopt;
}

std::optional<Error> Room::use_nodes(protocol::State& next,
                                     std::shared_ptr<const scene::PlacedScene>& placed) {
    if (next.nodes == state_.nodes) return std::nullopt;
    auto states = node_states(*scene_->scene, next.nodes);
    if (!states) return states.error();
    if (*states != scene_->nodes)
        placed = std::make_shared<const scene::PlacedScene>(scene::place(scene_->scene, *std::move(states)));
    count_classes(next, *placed);
    return std::nullopt;
}

/// The camera node that is named first, what else is named over it. A camera that stands at a node goes on
/// to where that is moved.
std::optional<Error> Room::use_camera(protocol::State& next, const scene::PlacedScene& placed,
                                      const protocol::NamedCameraMembers& named) {
    const bool pose_named = named.eye || named.focus || named.up || named.center || named.fov;
    const auto given = [](bool is_named, const auto& value) {
        return is_named ? std::optional(value) : std::nullopt;
    };
    protocol::CameraOverlay overlay;
    if (named.node || (next.camera.node && !pose_named && &placed != scene_.get()))
        overlay.node = next.camera.node;
    overlay.eye = given(named.eye, next.camera.eye);
    overlay.focus = given(named.focus, next.camera.focus);
    overlay.up = given(named.up, next.camera.up);
    overlay.center = given(named.center, next.camera.center);
    overlay.fov = given(named.fov, next.camera.fov);
    const std::optional<scene::Id> node = next.camera.node;
    scene::Camera pose = camera();
    if (overlay.node || pose_named) {
        auto laid = overlaid(pose, overlay, placed, "camera");
        if (!laid) return laid.error();
        pose = *laid;
    }
    next.camera = state_of(pose, placed.bounds);
    if (!node) return std::nullopt;
    const scene::Index index = placed.scene->find_node(*node);
    if (index != scene::kNone && scene::camera_at(placed, index) == pose)
        next.camera = state_at_node(pose, placed, index);
    return std::nullopt;
}

std::optional<Error> Room::use_entries(protocol::State& next, const scene::PlacedScene& placed) const {
    if (auto error = use_views(next, placed)) return error;
    if (auto error = use_notes(next, placed)) return error;
    if (auto error = check_names(next)) return error;
    if (next.measures != state_.measures)
        if (auto error = Measures::problem_of(next.measures, *scene_->scene)) return error;
    return use_cues(next);
}

std::optional<Error> Room::use_views(protocol::State& next, const scene::PlacedScene& placed) const {
    if (next.views == state_.views) return std::nullopt;
    auto views = *next.views;
    for (auto& [name, view] : views) {
        const auto before = state_.views->find(name);
        if (before != state_.views->end() && before->second == view) continue;
        const scene::Camera pose = camera_of(view);
        if (!scene::is_valid_pose(pose, placed.bounds.radius()))
            return Error{{},
                         code::out_of_range,
                         "'views." + name.substr(0, 40) +
                             "': eye and focus must be apart, and up neither zero nor along the view"};
        view = {pose_of(scene::with_orthogonal_up(pose)), view.order};
    }
    next.views.set(std::move(views));
    return std::nullopt;
}

std::optional<Error> Room::check_names(const protocol::State& next) const {
    const auto unknown = [&](const std::optional<scene::Id>& node,
                             const std::string& where) -> std::optional<Error> {
        if (!node || scene_->scene->find_node(*node) != scene::kNone) return std::nullopt;
        return Error{{}, code::unknown_node, where + ": there is no node " + std::to_string(*node)};
    };
    if (auto error = unknown(next.selection.node, "'selection.node'")) return error;
    for (const auto& [name, marker] : *next.markers)
        if (auto error = unknown(marker.node, "'markers." + name.substr(0, 40) + ".node'")) return error;
    return std::nullopt;
}

}  // namespace vrut::server::room
