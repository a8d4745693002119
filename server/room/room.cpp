#include "room/room.hpp"

#include <algorithm>
#include <cmath>

#include "codec.hpp"

namespace vrut::server::room {

using protocol::may;
using protocol::Right;
using protocol::Role;
using protocol::Steers;
namespace code = protocol::error_code;

Room::Room(scenes::LoadedScene scene, RoomOptions options)
    : options_(std::move(options)),
      loaded_(std::move(scene)),
      scene_(loaded_.placed),
      starting_(starting_state(loaded_, aspect())),
      state_(starting_),
      at_home_(!state_.camera.node),
      recordings_(options_.recordings),
      journal_(options_.journal) {
    lay_changes();
    revisions_.go_to(1, state_, true);
    visible_ = view_of(state_, scene_);
}

void Room::join(const std::string& client, Role role, SessionTime at, const std::string& name,
                const std::string& resume_key) {
    advance(at);
    document();
    revisions_.begin({});  // who holds control is the server's doing
    const std::string shown = options_.policy.by_log ? name : clients_.free_name(name, resume_key);
    clients_.add(client, {role, {}, shown, resume_key});
    state_.clients.set(clients_.listed());
    use_walls();
    recordings_.write(time_, client, protocol::LogLine::Connected{role, shown});
    journal_.write(time_, client, protocol::LogLine::Connected{role, shown, resume_key});
    if (!may(role, Right::hold_control)) return;
    if (options_.policy.by_log) return;
    steering_.join(client, resume_key);
    show_holder();
    record_holder();
}

const std::string& Room::client_name(const std::string& client) const {
    static const std::string none;
    const Client* const found = clients_.find(client);
    return found ? found->name : none;
}

void Room::leave(const std::string& client, SessionTime at) {
    advance(at);
    document();  // what was before is others' doing, or the client's own
    revisions_.begin({});
    record(client, protocol::LogLine::Disconnected{});
    gestures_.lift(client, camera());
    clicks_.lift(client);
    pointings_.stop(client);
    if (steering_.holds(client)) {
        end_flight(false);
        recorded_holder_ = {client, true};  // by that line
    }
    steering_.leave(client, time_, options_.policy.by_log);
    clients_.erase(client);
    state_.clients.set(clients_.listed());
    show_holder();
    record_holder();
    if (size_waits_ && !gestures_.any_pressed()) use_holders_size();
    use_walls();
}

void Room::pass_control(const std::string& client, SessionTime at) {
    advance(at);
    if (!options_.policy.by_log) return;  // it has, by the same rules
    if (client.empty())
        steering_.clear_holder();
    else if (clients_.contains(client))
        steering_.take(client);
    show_holder();
    use_walls();
}

bool Room::handle_message(const std::string& client, const protocol::ClientMessage& message, SessionTime at) {
    if (!clients_.contains(client)) return false;  // it has left
    const Received received{client, message};
    return handle(received, at, [&] {
        if (may_send(received, received.traits.right) &&
            (received.traits.steers != Steers::yes || may_steer(received)))
            std::visit([&](const auto& payload) { apply(received, payload); }, message.payload);
    });
}

void Room::update_visible() {
    measure();
    auto markers = visible_.markers;
    if (shown_markers_ != state_.markers || visible_.scene != scene_) {
        shown_markers_ = state_.markers;
        std::vector<plan::PlacedMarker> changed = markers_of(*shown_markers_, *scene_);
        if (changed.empty())
            markers.reset();
        else if (!markers || *markers != changed)
            markers = std::make_shared<const std::vector<plan::PlacedMarker>>(std::move(changed));
    }
    visible_ = view_of(state_, scene_);
    visible_.markers = std::move(markers);
}

template <class Apply>
bool Room::handle(const Received& received, SessionTime at, Apply apply) {
    advance(at);
    if (revisions_.changing() != received.client) document();  // a revision is one client's doing
    revisions_.begin(received.client);
    accepted_ = false;
    const bool recorded = recordings_.active() != nullptr;
    apply();
    if (size_waits_ && !gestures_.any_pressed()) use_holders_size();
    update_visible();
    use_walls();
    if (accepted_ && received.traits.recorded) {
        journal_.write(time_, received.client, received.message);
        if (recorded) recordings_.write(time_, received.client, received.message);
    }
    record_holder();
    return accepted_;
}

std::int64_t Room::answer_later(const Received& received) {
    return requests_.add({received.client, received.message});
}

std::optional<AnsweredLater> Room::take_request(std::int64_t request) {
    auto asked = requests_.take(request);
    return asked && is_here(*asked) ? asked : std::nullopt;
}

void Room::load_answered(std::int64_t request, const std::optional<protocol::Error>& rejection,
                         SessionTime at) {
    const auto asked = take_request(request);
    if (!asked) return;
    const Received received{asked->client, asked->message};
    handle(received, at, [&] {
        if (rejection) return reject(received, rejection->code.c_str(), rejection->message);
        // Whether it may be opened was judged when it was asked for; by now another may hold control.
        const bool steers = steering_.holds(received.client);
        if (steers) steer(received);
        answer(received);
        accepted_ = steers;  // what stands in a log steers
    });
}

void Room::scenes_listed(std::int64_t request, std::vector<std::string> names) {
    if (const auto asked = take_request(request))
        answer_with({asked->client, asked->message}, protocol::SceneList{0, std::move(names)});
}

void Room::use_walls() {
    const bool is_limited = state_.comfort.on && clients_.any_may(Right::drive_walls);
    walls_.use(is_limited, moves() || swings_.is_tapped(), camera(), time_);
}

void Room::step_walls() {
    if (!revisions_.changing().empty()) document();
    revisions_.begin({});  // how it follows is nobody's doing
    walls_.step(camera(), state_.comfort, state_.unit.metres);
    use_walls();
}

void Room::measure() {
    if (auto measured = measures_.changed(state_.measures, scene_)) state_.measured.set(*std::move(measured));
}

void Room::advance(SessionTime at) {
    while (const auto due = walls_.due()) {
        if (*due > at) break;
        advance_to(*due);
        step_walls();
    }
    advance_to(at);
    use_walls();
}

void Room::advance_to(SessionTime at) {
    time_ = std::max(time_, at);
    if (const auto due = steering_.deadline(); due && !options_.policy.by_log && *due <= time_) {
        document();
        revisions_.begin({});
        steering_.advance(time_);
        show_holder();
        record_holder();
    }
    swings_.use_tap(*scene_, time_);
    send_pointings();
    advance_swings();
    if (!flight_) return;
    if (!revisions_.changing().empty()) document();
    revisions_.begin({});  // what flies is nobody's doing
    const double ms = static_cast<double>((time_ - flight_->start).count()) / 1000;
    state_.camera = state_of(flight_->path.at(ms), scene_->bounds);
    at_home_ = false;
    update_visible();
    if (ms < flight_->path.duration()) return;
    // Where it was to end at a camera node, the camera stands there now.
    const std::optional<scene::Id> node = flight_->asked.keyframes.back().camera.node;
    const scene::Index index = node ? scene_->scene->find_node(*node) : scene::kNone;
    if (index != scene::kNone && scene::camera_at(*scene_, index) == camera())
        state_.camera = state_at_node(camera(), *scene_, index);
    end_flight(true);
}

void Room::show(scenes::LoadedScene scene, SessionTime at) {
    advance(at);
    document();
    revisions_.begin({});
    end_flight(false);
    swings_.clear();
    swings_.forget_tap();
    pointings_.stop_all();
    record({}, protocol::LogLine::Opened{scene.name, scene.sha256, scene.changes, scene.up_axis});
    loaded_ = std::move(scene);
    scene_ = loaded_.placed;
    measures_.forget_edges();
    starting_ = starting_state(loaded_, aspect(), cover());
    state_ = protocol::opened(starting_, state_);
    at_home_ = !state_.camera.node;
    lay_changes();
    gestures_.restart(camera());
    update_visible();
    walls_.jump();
    use_walls();
}

void Room::lay_changes() {
    if (!loaded_.changes_fault && !loaded_.changes.empty())
        if (const auto error = use_changes()) loaded_.changes_fault = error->message;
    if (loaded_.changes_fault)
        add_notice({protocol::notice_code::unusable_changes,
                    "What was kept of " + loaded_.name + " cannot be used: " + *loaded_.changes_fault});
}

std::optional<std::string> Room::unusable_changes() const {
    return loaded_.changes_fault ? std::optional(loaded_.changes) : std::nullopt;
}

std::string Room::changes() const { return protocol::kept_changes(starting_, state_); }

void Room::notice(const protocol::Notice& notice) {
    document();
    revisions_.begin({});  // the server's doing
    add_notice(notice);
}

void Room::add_notice(const protocol::Notice& notice) {
    std::erase(state_.notices, notice);
    state_.notices.push_back(notice);
    if (state_.notices.size() > protocol::kMaxNotices) state_.notices.erase(state_.notices.begin());
}

void Room::remember(std::int64_t frame) {
    frames_.add({frame, visible_.camera, view_size_});
    record({}, protocol::LogLine::Drawn{frame});
}

const std::shared_ptr<const protocol::StateDocument>& Room::document() {
    state_.walls = walls_.state(camera(), scene_->bounds, state_.unit.metres);
    return revisions_.of(state_);
}

std::vector<std::pair<std::string, Role>> Room::clients() const {
    std::vector<std::pair<std::string, Role>> here;
    for (const auto& [name, client] : clients_) here.emplace_back(name, client.role);
    return here;
}

// --- messages

void Room::apply(const Received&, const protocol::Hello&) {}       // the session's
void Room::apply(const Received&, const protocol::FrameGrant&) {}  // the engine's

void Room::apply(const Received& received, const protocol::Resize& resize) {
    clients_.at(received.client).wanted = resize;
    if (steering_.holder() == received.client) use_holders_size();
    answer(received);
}

void Room::apply(const Received& received, const protocol::Control& control) {
    using Action = protocol::Control::Action;
    const std::string& client = received.client;
    const bool holds = steering_.holds(client) || !options_.policy.judges;
    if ((control.action == Action::give || control.action == Action::decline) && !holds)
        return reject_not_in_control(received);
    if (control.action == Action::give && options_.policy.judges && !steering_.is_here(*control.client))
        return reject(received, code::out_of_range,
                      "'client': there is no control client '" + control.client->substr(0, 40) + "' here");
    switch (control.action) {
        case Action::take:
            steering_.take(client);
            break;
        case Action::release:
            if (!steering_.holds(client)) break;
            end_flight(false);
            gestures_.lift(client, camera());
            clicks_.lift(client);
            recorded_holder_ = {};  // until a line of its own says who does
            if (options_.policy.by_log)
                steering_.clear_holder();
            else
                steering_.release();
            break;
        case Action::ask:
            steering_.ask(client);
            break;
        case Action::cancel:
            steering_.decline(client);
            break;
        case Action::give:
            end_flight(false);
            steering_.take(*control.client);
            break;
        case Action::decline:
            steering_.decline(*control.client);
            break;
    }
    show_holder();
    answer(received);
}

void Room::apply(const Received& received, const protocol::Shown& shown) {
    if (options_.policy.judges && shown.revision > document()->revision())
        return reject(received, code::out_of_range,
                      "'revision': the newest is " + std::to_string(document()->revision()));
    answer(received);
}

void Room::apply(const Received& received, const protocol::Share& share) {
    if (!options_.share) return reject(received, code::failed, "there is no address to watch at");
    const auto shared = options_.share(share.page);
    if (!shared) return reject(received, shared.error().code.c_str(), shared.error().message);
    answer_with(received, *shared);
}

void Room::answer(const Received& received, std::optional<std::string> name) {
    accepted_ = true;
    if (!received.message.id) return;
    const std::int64_t revision = document()->revision();
    answers_.push_back({received.client,
                        protocol::encode(protocol::Ok{*received.message.id, revision, std::move(name)}),
                        revision});
}

void Room::reject(const Received& received, const char* code, const std::string& sentence) {
    reject(received.client, {received.message.id, code, sentence});
}

void Room::reject(const std::string& client, const protocol::Error& error) {
    answers_.push_back({client, protocol::encode(error), 0, error.message, error.code});
}

// --- who steers

bool Room::may_send(const Received& received, Right right) {
    Client& client = clients_.at(received.client);
    if (may(client.role, right)) return true;
    if (!received.is_input() || !std::exchange(client.knows_not_allowed, true))
        reject(received, code::not_allowed,
               std::string("the role '") + name_of(client.role) + "' may not do this");
    return false;
}

bool Room::may_steer(const Received& received) {
    const bool is_free = may(clients_.at(received.client).role, Right::drive_walls)
                             ? steering_.is_quiet(time_) && !gestures_.any_pressed()
                             : steering_.holds(received.client);
    if (is_free || !options_.policy.judges) return true;
    if (!received.is_input()) reject_not_in_control(received);
    return false;
}

void Room::reject_not_in_control(const Received& received) {
    const protocol::ControlState& control = state_.control;
    const std::string remedy = may(clients_.at(received.client).role, Right::drive_walls)
                                   ? "try again when that client has not steered for 1 s"
                                   : "'control' with the action 'ask' asks for it";
    reject(received, code::not_in_control,
           "'" + control.name.value_or(control.holder.value_or("")) + "' is in control; " + remedy);
}

void Room::steer(const Received& received) {
    accepted_ = true;
    const auto& payload = received.message.payload;
    const bool is_beside_flights =
        std::holds_alternative<protocol::Record>(payload) || std::holds_alternative<protocol::Swing>(payload);
    if (!is_beside_flights) end_flight(false);
    if (may(clients_.at(received.client).role, Right::drive_walls)) return;
    steering_.steer(time_);
    if (!options_.policy.by_log) return;
    if (std::holds_alternative<protocol::Pointer>(payload) && !steering_.holds(received.client))
        size_waits_ = true;
    steering_.take(received.client);
    show_holder();
}

void Room::show_holder() {
    protocol::ControlState& control = state_.control;
    if (control.holder != steering_.holder()) {
        if (control.holder) {
            gestures_.lift(*control.holder, camera());
            clicks_.lift(*control.holder);
        }
        swings_.forget_tap();
        control.holder = steering_.holder();
        control.name = control.holder ? clients_.shown_name(*control.holder) : std::nullopt;
        if (!size_waits_) use_holders_size();
        update_visible();
    }
    control.kept = control.holder.has_value();
    control.absent = steering_.is_absent();
    control.asking.clear();
    for (const std::string& client : steering_.asking())
        control.asking.push_back({client, clients_.shown_name(client)});
}

void Room::record_holder() {
    const std::pair now(state_.control.holder, state_.control.absent);
    if (std::exchange(recorded_holder_, now) == now) return;
    if (!options_.policy.by_log)
        record(state_.control.holder.value_or(""), protocol::LogLine::ControlPassed{});
}

void Room::use_holders_size() {
    size_waits_ = false;
    const Client* const holder = state_.control.holder ? clients_.find(*state_.control.holder) : nullptr;
    if (!holder || !holder->wanted || *holder->wanted == view_size_) return;
    const protocol::Resize before = std::exchange(view_size_, *holder->wanted);
    protocol::Resize same_size = before;
    same_size.inset = view_size_.inset;
    // What opens above the picture later does not move it.
    const bool fits_anew = same_size != view_size_ || before.inset == protocol::Inset{};
    if (at_home_ && fits_anew) {
        const protocol::Pose home = home_pose(*scene_, aspect(), cover(), loaded_.picking_trees.get());
        for (protocol::State* state : {&starting_, &state_}) {
            state->views.set("home", {home, {}});
            state->camera = state_of(camera_of(home), scene_->bounds);
        }
    }
    gestures_.restart(camera());
}

// --- the camera

navigation::NavigationContext Room::navigation_context(const std::optional<glm::dvec3>& touched) const {
    const protocol::NavigationState& navigation = state_.navigation;
    navigation::NavigationContext context;
    context.width = view_size_.width;
    context.height = view_size_.height;
    context.bounds = scene_->bounds;
    context.keep_upright = navigation.keep_upright;
    context.rotate_speed = navigation.rotate_speed;
    context.pan_speed = navigation.pan_speed;
    context.zoom_speed = navigation.zoom_speed;
    context.style = static_cast<navigation::NavigationStyle>(navigation.style);
    context.turn_about_touched = navigation.turn_about == protocol::NavigationState::TurnAbout::touched;
    context.surface_at = [this, touched](const scene::Camera& camera, const glm::dvec2& place) {
        if (touched) return touched;
        SeenFrame seen = present();
        seen.camera = camera;
        const std::optional<mesh::Hit> hit = hit_along(seen.ray_at(place.x, place.y), false);
        return hit ? std::optional(hit->point) : std::nullopt;
    };
    context.looks_around_from = [this](const glm::dvec3& eye) {
        return scene::looks_around_from(*scene_, eye);
    };
    return context;
}

navigation::Cover Room::cover() const {
    constexpr double kMost = 0.7;  // else nothing useful is left
    const protocol::Inset& inset = view_size_.inset;
    navigation::Cover cover;
    if (inset.left + inset.right <= kMost * view_size_.width) {
        cover.left = inset.left / view_size_.width;
        cover.right = inset.right / view_size_.width;
    }
    if (inset.top + inset.bottom <= kMost * view_size_.height) {
        cover.top = inset.top / view_size_.height;
        cover.bottom = inset.bottom / view_size_.height;
    }
    return cover;
}

void Room::drag_camera(const scene::Camera& moved) {
    // A move beyond what a patch may say, or double hold, is not made.
    const auto is_far = [](const glm::dvec3& point) {
        return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) > protocol::kFarthest;
    };
    if (moved == camera() || !scene::is_valid_pose(moved, 0)) return;
    if (is_far(moved.eye) || is_far(moved.focus) || is_far(moved.center)) return;
    state_.camera = state_of(moved, scene_->bounds);
    at_home_ = false;
}

void Room::move_camera(const scene::Camera& moved) {
    drag_camera(moved);
    gestures_.restart(camera());
}

void Room::end_flight(bool completed) {
    if (!flight_) return;
    const InFlight flight = *std::exchange(flight_, std::nullopt);
    gestures_.restart(camera());
    if (flight.id == 0) return;
    answers_.push_back(
        {flight.client, protocol::encode(protocol::Flown{flight.id, completed}), document()->revision()});
}

}  // namespace vrut::server::room
