#include "engine.hpp"

#include <spdlog/spdlog.h>

#include <cmath>
#include <future>

#include "codec.hpp"
#include "renderer.hpp"
#include "scene_state.hpp"

namespace vrut {

using protocol::ClientMessage;
using protocol::Role;
namespace code = protocol::error_code;

PainterFactory gl_painter(std::optional<int> device) {
    return [device](std::shared_ptr<const PlacedScene> scene) {
        auto renderer = std::make_shared<Renderer>(device);
        for (const std::string& sentence : renderer->rejected()) spdlog::warn("passed over {}", sentence);
        spdlog::info("drawing on {}", renderer->description());
        renderer->set_scene(std::move(scene));
        return Painter{renderer->description(), renderer->software(), renderer->max_size(),
                       [renderer](const View& view, Image& image, FrameStats& stats,
                                  const std::function<bool()>& interrupted) {
                           return renderer->render(view, image, stats, interrupted);
                       }};
    };
}

Engine::Engine(std::shared_ptr<const PlacedScene> scene, const PainterFactory& factory, Metrics& metrics,
               EngineCallbacks callbacks)
    : scene_(std::move(scene)),
      metrics_(metrics),
      callbacks_(std::move(callbacks)),
      encoder_(
          metrics, callbacks_.on_encoded, [this] { mailbox_.wake(); }, callbacks_.on_failure) {
    std::promise<void> started;
    std::future<void> start = started.get_future();
    thread_ = std::thread([this, &factory, &started] {
        Painter painter;
        try {
            painter = factory(scene_);
            description_ = painter.description;
            limits_.max_side = std::min(painter.max_size, limits_.max_side);
            started.set_value();
        } catch (...) {
            started.set_exception(std::current_exception());
            return;
        }
        try {
            run(std::move(painter));
        } catch (const std::exception& error) {
            callbacks_.on_failure(error.what());
        }
    });
    try {
        start.get();
    } catch (...) {
        thread_.join();
        throw;
    }
}

Engine::~Engine() {
    mailbox_.close();
    thread_.join();
}

void Engine::run(Painter painter) {
    painter_ = std::move(painter);
    std::vector<std::string> notices = all_notices(scene_->scene);
    if (painter_.software)
        notices.push_back("Drawn in software, without a graphics card: expect fewer pictures a second");
    starting_ = state_ = starting_state(*scene_, aspect(), std::move(notices));
    at_home_ = !first_camera_node(*scene_);
    visible_ = view_of(state_, *scene_);
    document_ = protocol::StateDocument::next({}, state_);
    output_.document = document_;

    // Drivers compile programs and states when they are first used; better now than under the first finger.
    Image image;
    FrameStats stats;
    View small = visible_;
    small.width = small.height = 64;
    painter_.paint(small, image, stats, {});

    while (!mailbox_.closed()) {
        commit({});
        serve_newest();
        if (!output_.empty()) callbacks_.on_output(std::exchange(output_, {}));
        const PacingDecision decision = pace();
        if (decision.action != PacingDecision::Action::wait) {
            draw(decision.action == PacingDecision::Action::draw_still);
            continue;
        }
        for (const EngineEvent& event : mailbox_.wait(decision.until))
            std::visit([&](const auto& what) { handle(what); }, event);
    }
    painter_ = {};
}

// --- events

void Engine::handle(const ClientJoined& joined) { clients_[joined.client].role = joined.role; }

void Engine::handle(const ClientLeft& left) {
    clients_.erase(left.client);
    gestures_.lift(left.client, camera_of(state_.camera));
    if (steering_.leave(left.client)) state_.control.holder.reset();
}

void Engine::handle(const GrantsReturned& returned) {
    const auto client = clients_.find(returned.client);
    if (client != clients_.end())
        client->second.grants = std::min(client->second.grants + returned.count, protocol::kMaxGrants);
}

void Engine::handle(const ClientSaid& said) {
    const auto client = clients_.find(said.client);
    if (client == clients_.end()) return;  // it has left
    arrival_ = said.arrival;
    output_.handled_bytes[said.client] += said.bytes;
    std::visit([&](const auto& payload) { apply(said.client, said.message, payload); }, said.message.payload);
    if (said.message.id) client->second.handled = std::max(client->second.handled, *said.message.id);
}

void Engine::apply(const std::string&, const ClientMessage&, const protocol::Hello&) {
    // The session takes the first one and ends at a second.
}

void Engine::apply(const std::string& client, const ClientMessage& message, const protocol::Resize& payload) {
    clients_[client].wanted = payload;
    if (steering_.holder() == client) set_holder_view();
    commit({});
    answer(client, message);
}

void Engine::apply(const std::string& client, const ClientMessage&, const protocol::FrameGrant&) {
    ++metrics_.frames_granted;
    int& grants = clients_[client].grants;
    grants = std::min(grants + 1, protocol::kMaxGrants);
}

void Engine::apply(const std::string& client, const ClientMessage& message,
                   const protocol::Pointer& payload) {
    // Only a press asks for control; what follows belongs to it, and hovering does nothing.
    const bool press = payload.event == protocol::Pointer::Event::down;
    if (!press && !gestures_.is_pressed(client, payload.pointer_id) && clients_[client].role == Role::control)
        return;
    if (!may_steer(client, message)) return;
    PointerInput input;
    input.action = static_cast<PointerInput::Action>(payload.event);
    input.client = client;
    input.pointer = payload.pointer_id;
    input.device = static_cast<PointerInput::Device>(payload.pointer_type);
    input.x = payload.x;
    input.y = payload.y;
    input.button = payload.button;
    input.buttons = payload.buttons;
    move_camera(gestures_.pointer(input, camera_of(state_.camera), navigation_context()));
}

void Engine::apply(const std::string& client, const ClientMessage& message, const protocol::Wheel& payload) {
    if (!may_steer(client, message)) return;
    const WheelInput input{payload.delta_y, static_cast<WheelInput::Unit>(payload.delta_mode)};
    move_camera(wheel(input, camera_of(state_.camera), navigation_context()));
    gestures_.restart(camera_of(state_.camera));
}

void Engine::apply(const std::string& client, const ClientMessage& message, const protocol::Key& payload) {
    if (!payload.down || !may_steer(client, message)) return;
    const KeyInput input{payload.key, payload.modifiers.shift};
    const std::optional<Camera> node = first_camera_node(*scene_);
    const Camera home = node ? *node : home_camera(scene_->bounds, aspect());
    move_camera(key_down(input, camera_of(state_.camera), home, navigation_context()));
    gestures_.restart(camera_of(state_.camera));
}

void Engine::apply(const std::string& client, const ClientMessage& message, const protocol::Patch& payload) {
    if (!may_steer(client, message)) return;
    commit({});  // what went before has revisions of its own
    if (payload.if_revision && document_->last_change(*payload.patch) > *payload.if_revision)
        return refuse(
            client, message,
            {{},
             code::stale_revision,
             "what the patch touches has changed since revision " + std::to_string(*payload.if_revision)});
    auto next = protocol::patched(state_, starting_, *payload.patch);
    if (!next) return refuse(client, message, next.error());
    if (clients_[client].role == Role::host) {
        protocol::State but_camera = *next;
        but_camera.camera = state_.camera;
        if (but_camera != state_)
            return refuse(client, message, {{}, code::not_allowed, "a host may patch nothing but 'camera'"});
    }
    if (next->camera != state_.camera) {
        const Camera camera = camera_of(next->camera);
        if (!is_valid_pose(camera, scene_->bounds.radius()))
            return refuse(
                client, message,
                {{},
                 code::out_of_range,
                 "'camera': 'eye' and 'focus' must be apart, and 'up' neither zero nor along the view"});
        next->camera = state_of(with_orthogonal_up(camera), scene_->bounds);
        at_home_ = false;
    }
    state_ = *std::move(next);
    gestures_.restart(camera_of(state_.camera));
    note_change();
    commit(client);
    answer(client, message);
}

// --- state

bool Engine::may_steer(const std::string& client, const ClientMessage& message) {
    const Role role = clients_[client].role;
    const bool is_patch = std::holds_alternative<protocol::Patch>(message.payload);
    if (role == Role::view || (role == Role::host && !is_patch)) {
        refuse(client, message,
               {{}, code::not_allowed, std::string("the role '") + name_of(role) + "' may not do this"});
        return false;
    }
    const std::optional<std::string> before = steering_.holder();
    if (!steering_.steer(client, arrival_, gestures_.any_pressed())) {
        refuse(client, message, {{}, code::not_in_control, "another client is in control"});
        return false;
    }
    if (before != steering_.holder()) {
        commit({});
        if (before) gestures_.lift(*before, camera_of(state_.camera));
        state_.control.holder = client;
        set_holder_view();
        commit({});
    }
    return true;
}

void Engine::set_holder_view() {
    const auto holder = steering_.holder() ? clients_.find(*steering_.holder()) : clients_.end();
    if (holder != clients_.end() && holder->second.wanted) set_view(*holder->second.wanted);
}

void Engine::set_view(const protocol::Resize& view) {
    if (view == view_size_) return;
    view_size_ = view;
    if (at_home_) state_.camera = state_of(home_camera(scene_->bounds, aspect()), scene_->bounds);
    gestures_.restart(camera_of(state_.camera));
    last_change_ = Clock::now();
    note_change();
}

void Engine::move_camera(const Camera& camera) {
    // A move that would leave the range of double is not made.
    if (camera == camera_of(state_.camera) || !is_valid_pose(camera, 0)) return;
    state_.camera = state_of(camera, scene_->bounds);
    at_home_ = false;
    note_change();
}

NavigationContext Engine::navigation_context() const {
    const protocol::NavigationState& navigation = state_.navigation;
    return {view_size_.width,        view_size_.height,    scene_->bounds,       navigation.keep_upright,
            navigation.rotate_speed, navigation.pan_speed, navigation.zoom_speed};
}

void Engine::commit(const std::string& by) {
    if (document_->shows(state_)) return;
    document_ = protocol::StateDocument::next(*document_, state_);
    output_.document = document_;
    output_.by = by.empty() ? steering_.holder().value_or("") : by;
}

void Engine::answer(const std::string& client, const ClientMessage& message) {
    if (!message.id) return;
    const std::int64_t revision = document_->revision();
    output_.answers.push_back({client, protocol::encode(protocol::Ok{*message.id, revision}), revision});
}

void Engine::refuse(const std::string& client, const ClientMessage& message, protocol::Error error) {
    const bool input = std::holds_alternative<protocol::Pointer>(message.payload) ||
                       std::holds_alternative<protocol::Wheel>(message.payload) ||
                       std::holds_alternative<protocol::Key>(message.payload);
    ++metrics_.messages_refused;
    // A watcher's fingers are no error worth a line each.
    if (input && !message.id && error.code == code::not_in_control) return;
    error.id = message.id;
    output_.answers.push_back({client, protocol::encode(error), 0});
}

// --- pictures

void Engine::note_change() {
    const View now = view_of(state_, *scene_);
    if (now == visible_) return;
    visible_ = now;
    last_change_ = Clock::now();
    newest_input_ = arrival_;
}

bool Engine::shows_present() const {
    return drawn_.frame != 0 && visible_ == drawn_.visible && view_size_ == drawn_.view_size;
}

bool Engine::waits_for_newer(const Client& client) const {
    if (client.grants == 0) return false;
    return !shows_present() || client.last_frame != drawn_.frame || !drawn_.still;
}

/// Clients that have not got the newest picture, which shows what is to be seen, get that; no drawing is
/// needed.
void Engine::serve_newest() {
    if (!shows_present()) return;
    for (auto& [name, client] : clients_) {
        if (client.grants == 0 || client.last_frame == drawn_.frame) continue;
        --client.grants;
        client.last_frame = drawn_.frame;
        output_.owed.push_back({name, drawn_.frame});
    }
}

PacingDecision Engine::pace() {
    PacingInput input;
    for (const auto& [name, client] : clients_)
        input.somebody_waits = input.somebody_waits || waits_for_newer(client);
    input.changed = !shows_present();
    input.newest_is_still = drawn_.still;
    input.encoder_free = encoder_.is_free();
    input.last_change = last_change_;
    input.now = Clock::now();
    return decide(input);
}

void Engine::draw(bool still) {
    const protocol::Quality quality =
        still ? still_quality(view_size_, limits_) : moving_quality(view_size_, limits_);
    const PictureSize size = picture_size(view_size_, quality.scale);
    View view = visible_;
    view.width = size.width;
    view.height = size.height;
    view.samples = quality.samples;

    Image image = encoder_.take_spare();
    FrameStats stats;
    if (!painter_.paint(view, image, stats, [&] { return mailbox_.has_input(); })) {
        ++metrics_.frames_interrupted;
        // What interrupted it is handled before the next decision.
        for (const EngineEvent& event : mailbox_.wait(Clock::now()))
            std::visit([&](const auto& what) { handle(what); }, event);
        return;
    }
    ++(still ? metrics_.frames_rendered_still : metrics_.frames_rendered_moving);
    drawn_ = {drawn_.frame + 1, visible_, view_size_, still};

    Picture picture;
    protocol::FrameHeader& header = picture.header;
    header.frame = drawn_.frame;
    header.revision = document_->revision();
    header.camera = state_.camera;
    header.view_matrix = view_from_world(view.camera);
    header.projection_matrix = clip_from_view(view.camera, static_cast<double>(size.width) / size.height,
                                              {state_.camera.near, state_.camera.far});
    header.width = size.width;
    header.height = size.height;
    header.view = view_size_;
    header.quality = quality;
    header.render_ms = stats.render_ms;
    header.readback_ms = stats.readback_ms;
    picture.newest_input = newest_input_;
    for (auto& [name, client] : clients_) {
        picture.handled[name] = client.handled;
        if (client.grants == 0) continue;
        --client.grants;
        client.last_frame = drawn_.frame;
        output_.owed.push_back({name, drawn_.frame});
    }
    encoder_.offer(std::move(picture), std::move(image));
}

}  // namespace vrut
