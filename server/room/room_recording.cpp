// What is recorded, and how it begins and ends.
#include <algorithm>

#include "room/room.hpp"

namespace vrut::server::room {

namespace code = protocol::error_code;

void Room::apply(const Received& received, const protocol::Record& record) {
    if (!options_.policy.judges) {
        steer(received);
        end_swings();
        swings_.forget_tap();
        return answer(received);
    }
    if (!recordings_.has_sink())
        return reject(received, code::not_allowed,
                      "this server has no folder for recordings: start it with --record");
    if (record.action == protocol::Record::Action::start)
        start_recording(received, record.name);
    else
        stop_recording(received);
}

/// From here on there are lines, whenever its file is open.
void Room::start_recording(const Received& received, const std::string& name) {
    if (const Recording* active = recordings_.active())
        return reject(received, code::busy,
                      active->name.empty()
                          ? "a recording is being begun already"
                          : "the recording '" + active->name + "' is going on: stop it first");
    steer(received);
    end_swings();  // a log's header knows nothing of them
    swings_.forget_tap();
    recordings_.begin(name, log_header(), time_, {received.client, received.message});
    press_anew(received.client);
}

void Room::recording_opened(std::int64_t recording, const tl::expected<std::string, std::string>& name,
                            SessionTime at) {
    Recording* const found = recordings_.find(recording);
    if (!found) return;
    advance(at);
    const auto [client, message] = found->start;
    const auto stop = found->stop;
    const Received received{client, message};
    if (!name) {
        recordings_.take(recording);
        if (clients_.contains(client)) reject(received, code::failed, name.error());
        if (stop && is_here(*stop))
            reject({stop->client, stop->message}, code::failed, "nothing has been recorded");
        return;
    }
    document();
    revisions_.begin(client);
    found->name = *name;
    if (!stop) state_.recording = protocol::RecordingState{*name};
    if (clients_.contains(client)) answer(received, *name);
}

void Room::stop_recording(const Received& received) {
    if (!recordings_.active()) return reject(received, code::failed, "nothing is being recorded");
    steer(received);
    recordings_.write(time_, received.client, received.message);
    recordings_.end({received.client, received.message});
    state_.recording.reset();
}

void Room::recording_ended(std::int64_t recording, const std::optional<std::string>& why, SessionTime at) {
    const auto ended = recordings_.take(recording);
    if (!ended) return;
    advance(at);
    const std::string& name = ended->name;
    const auto& stop = ended->stop;
    if (why) {
        notice({protocol::notice_code::recording_ended, "The recording '" + name + "' has ended: " + *why});
        if (!stop) state_.recording.reset();
    }
    if (!stop || !is_here(*stop)) return;
    const Received received{stop->client, stop->message};
    if (why)
        reject(received, code::failed, "the end of '" + name + "' is missing: " + *why);
    else
        answer(received, name);
}

/// What is held begins anew, here and in the log, which knows nothing of how it began. All of it is the
/// holder's, `client`'s.
void Room::press_anew(const std::string& client) {
    clicks_ = {};
    const auto again = [&](const auto& payload) {
        const protocol::ClientMessage message{{}, payload};
        record(client, message);
        apply({client, message}, payload);
    };
    for (const navigation::Gestures::HeldKey& held : gestures_.held_keys()) {
        const navigation::KeyInput input = held.input();
        protocol::Key key;
        key.key = input.key;
        key.code = input.code;
        again(key);
    }
    for (const navigation::PointerInput& pressed : gestures_.pressed()) {
        protocol::Pointer pointer;
        pointer.event = protocol::Pointer::Event::down;
        pointer.pointer_id = pressed.pointer;
        pointer.pointer_type = static_cast<protocol::Pointer::Type>(pressed.device);
        pointer.x = pressed.x;
        pointer.y = pressed.y;
        pointer.button = pressed.button;
        pointer.buttons = pressed.buttons;
        const navigation::ModifierKeys& keys = pressed.modifiers;
        pointer.modifiers = {keys.ctrl, keys.shift, keys.alt, keys.meta};
        again(pointer);
    }
}

void Room::record(const std::string& client, decltype(protocol::LogLine::what) what) {
    journal_.write(time_, client, what);
    recordings_.write(time_, client, std::move(what));
}

protocol::LogHeader Room::header_of_now() const {
    protocol::LogHeader header;
    header.scene = loaded_.name;
    header.scene_sha256 = loaded_.sha256;
    header.up_axis = loaded_.up_axis;
    const auto add = [&](const std::string& name) {
        const Client& client = clients_.at(name);
        header.clients.push_back({name, client.role, client.wanted, client.name});
    };
    // Those to whom control would pass on come last, in that order.
    const std::vector<std::string> next = steering_.candidates();
    for (const auto& [name, client] : clients_)
        if (std::ranges::find(next, name) == next.end()) add(name);
    for (const std::string& name : next)
        if (clients_.contains(name)) add(name);
    header.view = view_size_;
    header.at_home = at_home_;
    header.home = starting_.views->at("home");
    for (const SeenFrame& frame : frames_.all())
        header.frames.push_back({frame.number, state_of(frame.camera, scene_->bounds), frame.view_size});
    if (flight_)
        header.flight = {flight_->client, flight_->id,
                         static_cast<double>((time_ - flight_->start).count()) / 1000, flight_->from,
                         flight_->asked};
    header.walls = walls_.logged(time_);
    return header;
}

RecordingSink::Header Room::log_header() const {
    return [header = header_of_now(), state = state_](const std::string& name,
                                                      const std::string& started) mutable {
        header.started = started;
        state.recording = protocol::RecordingState{name};
        header.state = protocol::document_of(state);
        return protocol::encode(header);
    };
}

// --- the journal, which another server follows

std::optional<Checkpoint> Room::checkpoint() {
    const bool is_quiet = swings_.empty() && !swings_.is_tapped() && !gestures_.any_pressed() &&
                          gestures_.held_keys().empty() && requests_.empty() && recordings_.empty() &&
                          !steering_.deadline() && !walls_.due();
    if (!is_quiet) return std::nullopt;
    Checkpoint now{header_of_now(), {document()->revision(), state_.notices, ""}};
    now.header.state = protocol::document_of(state_);
    now.header.revision = document()->revision();
    for (protocol::LogHeader::Client& client : now.header.clients)
        client.resume = clients_.at(client.client).resume_key;
    return now;
}

void Room::write_revision() { journal_.write_revision(time_, document()->revision(), state_); }

void Room::follow(const protocol::LogLine::Revised& revised, SessionTime at) {
    advance(at);
    if (revised.notices) state_.notices = *revised.notices;
    if (revised.recording) {
        state_.recording.reset();
        if (!revised.recording->empty()) state_.recording = protocol::RecordingState{*revised.recording};
    }
    state_.walls = walls_.state(camera(), scene_->bounds, state_.unit.metres);
    if (revised.revision > revisions_.newest().revision()) revisions_.go_to(revised.revision, state_);
}

void Room::go_on(RoomOptions options) {
    options_ = std::move(options);
    options_.policy = kLive;
    recordings_ = Recordings(options_.recordings);
    journal_.use(options_.journal);
    state_.recording.reset();  // its file was another server's
}

}  // namespace vrut::server::room
