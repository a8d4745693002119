#include "presentation.hpp"

#include "codec.hpp"
#include "scene_state.hpp"

namespace vrut {

using protocol::Role;
namespace code = protocol::error_code;

Presentation::Presentation(std::shared_ptr<const PlacedScene> scene, std::vector<std::string> notices)
    : scene_(std::move(scene)),
      starting_(starting_state(*scene_, aspect(), std::move(notices))),
      state_(starting_),
      document_(protocol::StateDocument::next({}, state_)),
      visible_(view_of(state_, *scene_)),
      at_home_(!first_camera_node(*scene_)) {}

void Presentation::join(const std::string& client, Role role) { clients_[client].role = role; }

void Presentation::leave(const std::string& client) {
    document();  // what was before is the client's own doing
    clients_.erase(client);
    gestures_.lift(client, camera());
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
    visible_ = view_of(state_, *scene_);
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
    const bool known = press || gestures_.is_pressed(said.client, pointer.pointer_id);
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
    drag_camera(gestures_.pointer(input, camera(), navigation_context()));
}

void Presentation::apply(const Said& said, const protocol::Wheel& wheel) {
    if (!may_steer(said)) return;
    steer(said);
    const WheelInput input{wheel.delta_y, static_cast<WheelInput::Unit>(wheel.delta_mode)};
    move_camera(vrut::wheel(input, camera(), navigation_context()));
}

void Presentation::apply(const Said& said, const protocol::Key& key) {
    if (!key.down || !may_steer(said)) return;
    steer(said);
    move_camera(key_down({key.key, key.modifiers.shift}, camera(), home(), navigation_context()));
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
        if (but_camera != state_)
            return refuse(said.client,
                          {said.message.id, code::not_allowed, "a host may patch nothing but 'camera'"});
    }
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
        const Index node = scene_->scene.find_node(*fit.node);
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
        if (control.holder) gestures_.lift(*control.holder, camera());
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
    return {view_size_.width,        view_size_.height,    scene_->bounds,       navigation.keep_upright,
            navigation.rotate_speed, navigation.pan_speed, navigation.zoom_speed};
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
