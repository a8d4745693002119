#include "presentation.hpp"

#include <algorithm>

#include "codec.hpp"
#include "picking.hpp"
#include "scene_state.hpp"

namespace vrut {

using protocol::Role;
namespace code = protocol::error_code;

namespace {

constexpr std::size_t kFramesRemembered = 64;
constexpr std::size_t kLongestPath = 32;

}  // namespace

Presentation::Presentation(std::shared_ptr<const PlacedScene> scene, std::vector<std::string> notices)
    : scene_(std::move(scene)),
      starting_(starting_state(*scene_, aspect(), std::move(notices))),
      state_(starting_),
      document_(protocol::StateDocument::next({}, state_)),
      visible_(view_of(state_, scene_)),
      at_home_(!first_camera_node(*scene_)) {}

void Presentation::join(const std::string& client, Role role) { clients_[client].role = role; }

void Presentation::leave(const std::string& client) {
    document();  // what was before is the client's own doing
    clients_.erase(client);
    gestures_.lift(client, camera());
    clicks_.lift(client);
    if (steering_.release(client)) hold(std::nullopt);
    changing_.clear();
}

void Presentation::say(const std::string& client, const protocol::ClientMessage& message,
                       Clock::time_point arrival) {
    if (!clients_.contains(client)) return;  // it has left
    if (changing_ != client) document();     // a revision is one client's doing
    changing_ = client;
    std::visit([&](const auto& payload) { apply({client, message, arrival}, payload); }, message.payload);
    if (size_waits_ && !gestures_.any_pressed()) use_holders_size();
    visible_ = view_of(state_, scene_);
}

const std::shared_ptr<const protocol::StateDocument>& Presentation::document() {
    if (!document_->shows(state_)) {
        document_ = protocol::StateDocument::next(*document_, state_);
        if (changed_by_ != changing_ || changed_by_since_ == 0) changed_by_since_ = document_->revision();
        changed_by_ = changing_;
    }
    return document_;
}

// --- messages

void Presentation::apply(const Said&, const protocol::Hello&) {}       // the session's
void Presentation::apply(const Said&, const protocol::FrameGrant&) {}  // the engine's

void Presentation::apply(const Said& said, const protocol::Resize& resize) {
    clients_[said.client].wanted = resize;
    if (steering_.holder() == said.client) use_holders_size();
    answer(said);
}

void Presentation::apply(const Said& said, const protocol::Pointer& pointer) {
    // Only a press asks for control; what follows belongs to it, and hovering does nothing.
    const bool press = pointer.event == protocol::Pointer::Event::down;
    // A third finger drags nothing, but its release counts.
    const bool known = press || gestures_.is_pressed(said.client, pointer.pointer_id) ||
                       clicks_.is_pressed(said.client, pointer.pointer_id);
    if ((!known && clients_[said.client].role == Role::control) || !may_steer(said)) return;
    steer(said);
    PointerInput input;
    input.action = static_cast<PointerInput::Action>(pointer.event);
    input.client = said.client;
    input.pointer = pointer.pointer_id;
    input.device = static_cast<PointerInput::Device>(pointer.pointer_type);
    input.x = pointer.x;
    input.y = pointer.y;
    input.button = pointer.button;
    input.buttons = pointer.buttons;
    input.modifiers = {pointer.modifiers.alt, pointer.modifiers.ctrl, pointer.modifiers.shift,
                       pointer.modifiers.meta};
    const NavigationContext context = navigation_context();
    drag_camera(gestures_.pointer(input, camera(), context));
    const EventTime when{pointer.time_stamp, std::chrono::duration_cast<std::chrono::microseconds>(
                                                 said.arrival.time_since_epoch())};
    if (const std::optional<Click> click = clicks_.pointer(input, when, context.style)) {
        std::optional<Look> seen = look(click->x, click->y, pointer.frame, false);
        if (!seen) seen = look(click->x, click->y, std::nullopt, false);  // long forgotten: the newest
        apply(click->operation, seen->hit);
    }
}

void Presentation::apply(const Said& said, const protocol::Wheel& wheel) {
    if (!may_steer(said)) return;
    steer(said);
    const WheelInput input{wheel.delta_y, static_cast<WheelInput::Unit>(wheel.delta_mode)};
    move_camera(vrut::wheel(input, camera(), navigation_context()));
}

void Presentation::apply(const Said& said, const protocol::Key& key) {
    const KeyInput input{key.key, key.modifiers.shift, key.code};
    if (!key.down) return gestures_.key_up(said.client, input);
    if (!may_steer(said)) return;
    steer(said);
    gestures_.key_down(said.client, input);
    const std::optional<KeyOperation> operation = key_operation(input);
    if (!operation) return;
    if (operation->kind == KeyOperation::Kind::escape) select(kNone);
    NavigationContext context = navigation_context();
    if (operation->kind == KeyOperation::Kind::fit && state_.selection.node) {
        const Bounds selected = subtree_bounds(*scene_, scene_->scene->find_node(*state_.selection.node));
        if (!selected.empty()) context.bounds = selected;
    }
    move_camera(operated(*operation, camera(), home(), context));
}

void Presentation::apply(const Said& said, const protocol::Patch& patch) {
    if (!may_steer(said)) return;
    if (patch.if_revision && document()->last_change(*patch.patch) > *patch.if_revision)
        return refuse(said.client, {said.message.id, code::stale_revision,
                                    "what the patch touches has changed since revision " +
                                        std::to_string(*patch.if_revision)});
    auto next = protocol::patched(state_, starting_, *patch.patch);
    if (!next) return refuse(said.client, {said.message.id, next.error().code, next.error().message});
    const bool moves = next->camera != state_.camera;
    if (clients_[said.client].role == Role::host) {
        protocol::State but_camera = *next;
        but_camera.camera = state_.camera;
        but_camera.selection = state_.selection;
        if (but_camera != state_)
            return refuse(said.client, {said.message.id, code::not_allowed,
                                        "a host may patch nothing but 'camera' and 'selection'"});
    }
    const std::optional<Id> selected = next->selection.node;
    if (selected && scene_->scene->find_node(*selected) == kNone)
        return refuse(said.client, {said.message.id, code::unknown_node,
                                    "'selection.node': there is no node " + std::to_string(*selected)});
    Camera pose = camera_of(next->camera);
    if (moves && !protocol::names_camera_up(*patch.patch)) pose = with_roll_of(camera(), pose);
    if (moves && !is_valid_pose(pose, scene_->bounds.radius()))
        return refuse(
            said.client,
            {said.message.id, code::out_of_range,
             "'camera': 'eye' and 'focus' must be apart, and 'up' neither zero nor along the view"});
    if (moves) at_home_ = false;
    steer(said);
    next->camera = moves ? state_of(with_orthogonal_up(pose), scene_->bounds) : state_.camera;
    next->control = state_.control;
    state_ = *std::move(next);
    select(selected ? scene_->scene->find_node(*selected) : kNone);
    gestures_.restart(camera());
    answer(said);
}

void Presentation::apply(const Said& said, const protocol::Navigate& navigate) {
    if (!may_steer(said)) return;
    steer(said);
    Camera moved = rotated(camera(), navigate.rotate[0], navigate.rotate[1], state_.navigation.keep_upright);
    moved = panned(moved, navigate.pan[0], navigate.pan[1]);
    move_camera(zoomed(moved, navigate.zoom, scene_->bounds.radius()));
    answer(said);
}

void Presentation::apply(const Said& said, const protocol::Fit& fit) {
    if (!may_steer(said)) return;
    Bounds bounds = scene_->bounds;
    if (fit.node) {
        const Index node = scene_->scene->find_node(*fit.node);
        const std::string name = "node " + std::to_string(*fit.node);
        if (node == kNone)
            return refuse(said.client, {said.message.id, code::unknown_node, "there is no " + name});
        bounds = subtree_bounds(*scene_, node);
        if (bounds.empty())
            return refuse(said.client,
                          {said.message.id, code::failed, "nothing of " + name + " is to be seen"});
    }
    steer(said);
    move_camera(fitted(camera(), bounds, aspect()));
    answer(said);
}

void Presentation::apply(const Said& said, const protocol::Control& control) {
    if (clients_[said.client].role != Role::control)
        return refuse(said.client, {said.message.id, code::not_allowed,
                                    "only the role 'control' takes and releases control"});
    if (control.take) {
        steering_.take(said.client, said.arrival);
        hold(said.client);
    } else if (steering_.release(said.client)) {
        hold(std::nullopt);
    }
    answer(said);
}

void Presentation::apply(const Said& said, const protocol::Pick& pick) {
    using Then = protocol::Pick::Then;
    const bool steers = pick.then != Then::nothing;
    if (steers && !may_steer(said)) return;
    const std::optional<Look> seen = look(pick.x, pick.y, pick.frame, pick.through);
    if (!seen)
        return refuse(said.client, {said.message.id, code::unknown_frame,
                                    "frame " + std::to_string(*pick.frame) + " is not among the last " +
                                        std::to_string(kFramesRemembered)});
    if (steers) {
        steer(said);
        apply(pick.then == Then::select   ? Click::Operation::select
              : pick.then == Then::center ? Click::Operation::set_center
                                          : Click::Operation::look_at,
              seen->hit);
    }
    if (!said.message.id) return;
    protocol::Picked picked{*said.message.id, {}};
    if (const auto& hit = seen->hit) {
        const Node& node = scene_->scene->nodes()[static_cast<std::size_t>(hit->node)];
        picked.hit = {node.id, node.name, path_of(hit->node), hit->point, hit->normal, hit->distance};
    }
    answers_.push_back({said.client, protocol::encode(picked), document()->revision()});
}

std::optional<Presentation::Look> Presentation::look(double x, double y, std::optional<std::int64_t> frame,
                                                     bool through) const {
    Frame seen{0, camera(), view_size_};
    if (frame) {
        const auto found = std::find_if(frames_.begin(), frames_.end(),
                                        [&](const Frame& candidate) { return candidate.number == *frame; });
        if (found == frames_.end()) return std::nullopt;
        seen = *found;
    } else if (!frames_.empty()) {
        seen = frames_.back();
    }
    const protocol::Resize& size = seen.view_size;
    const glm::dvec2 point(2 * x / size.width - 1, 2 * y / size.height - 1);
    return Look{pick(*scene_,
                     {seen.camera.eye, direction_through(seen.camera, size.width / size.height, point)},
                     through)};
}

void Presentation::apply(Click::Operation operation, const std::optional<Hit>& hit) {
    if (operation == Click::Operation::select) return select(hit ? hit->node : kNone);
    if (!hit) return;
    Camera moved = camera();
    moved.center = hit->point;
    if (operation == Click::Operation::look_at) {
        moved.eye += hit->point - moved.focus;
        moved.focus = hit->point;
    }
    move_camera(moved);
}

void Presentation::remember(std::int64_t frame) {
    frames_.push_back({frame, visible_.camera, view_size_});
    if (frames_.size() > kFramesRemembered) frames_.pop_front();
}

void Presentation::select(Index node) {
    state_.selection = {};
    if (node == kNone) return;
    const Node& selected = scene_->scene->nodes()[static_cast<std::size_t>(node)];
    state_.selection = {selected.id, selected.name, path_of(node)};
}

std::vector<std::string> Presentation::path_of(Index node) const {
    std::vector<std::string> path;
    for (; node != kNone && path.size() < kLongestPath;
         node = scene_->scene->nodes()[static_cast<std::size_t>(node)].parent)
        path.push_back(scene_->scene->nodes()[static_cast<std::size_t>(node)].name);
    std::reverse(path.begin(), path.end());
    return path;
}

void Presentation::answer(const Said& said) {
    if (!said.message.id) return;
    const std::int64_t revision = document()->revision();
    answers_.push_back({said.client, protocol::encode(protocol::Ok{*said.message.id, revision}), revision});
}

void Presentation::refuse(const std::string& client, const protocol::Error& error) {
    answers_.push_back({client, protocol::encode(error), 0, true});
}

// --- who steers

bool Presentation::may_steer(const Said& said) {
    const Role role = clients_[said.client].role;
    const auto& payload = said.message.payload;
    if (role == Role::view || (role == Role::host && !std::holds_alternative<protocol::Patch>(payload))) {
        refuse(said.client, {said.message.id, code::not_allowed,
                             std::string("the role '") + name_of(role) + "' may not do this"});
        return false;
    }
    if (steering_.may_steer(said.client, said.arrival, gestures_.any_pressed())) return true;
    // A watcher's fingers are no error worth a line each.
    const bool input = std::holds_alternative<protocol::Pointer>(payload) ||
                       std::holds_alternative<protocol::Wheel>(payload) ||
                       std::holds_alternative<protocol::Key>(payload);
    if (said.message.id || !input)
        refuse(said.client, {said.message.id, code::not_in_control, "another client is in control"});
    return false;
}

void Presentation::steer(const Said& said) {
    steering_.steer(said.client, said.arrival);
    const bool press = std::holds_alternative<protocol::Pointer>(said.message.payload);
    if (press && state_.control.holder != said.client) size_waits_ = true;
    hold(said.client);
}

/// Brings the state in line with who steers now.
void Presentation::hold(const std::optional<std::string>& holder) {
    protocol::ControlState& control = state_.control;
    if (control.holder != holder) {
        if (control.holder) {
            gestures_.lift(*control.holder, camera());
            clicks_.lift(*control.holder);
        }
        control.holder = holder;
        if (!size_waits_) use_holders_size();
    }
    control.kept = steering_.kept();
}

void Presentation::use_holders_size() {
    size_waits_ = false;
    const auto holder = state_.control.holder ? clients_.find(*state_.control.holder) : clients_.end();
    if (holder == clients_.end() || !holder->second.wanted || *holder->second.wanted == view_size_) return;
    view_size_ = *holder->second.wanted;
    if (at_home_) state_.camera = state_of(home(), scene_->bounds);
    gestures_.restart(camera());
}

// --- the camera

Camera Presentation::camera() const { return camera_of(state_.camera); }

Camera Presentation::home() const {
    const std::optional<Camera> node = first_camera_node(*scene_);
    return node ? *node : home_camera(scene_->bounds, aspect());
}

NavigationContext Presentation::navigation_context() const {
    const protocol::NavigationState& navigation = state_.navigation;
    return {view_size_.width,        view_size_.height,    scene_->bounds,        navigation.keep_upright,
            navigation.rotate_speed, navigation.pan_speed, navigation.zoom_speed, NavigationStyle::vrut};
}

void Presentation::drag_camera(const Camera& moved) {
    // A move that would leave the range of double is not made.
    if (moved == camera() || !is_valid_pose(moved, 0)) return;
    state_.camera = state_of(moved, scene_->bounds);
    at_home_ = false;
}

void Presentation::move_camera(const Camera& moved) {
    drag_camera(moved);
    gestures_.restart(camera());
}

}  // namespace vrut
