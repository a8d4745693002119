#include "nats/remote_room.hpp"

#include <algorithm>

#include "codec.hpp"
#include "engine/encoder.hpp"
#include "observe/log.hpp"
#include "rights.hpp"

namespace vrut::server::nats {

namespace {

using namespace std::chrono_literals;

constexpr auto kInboxPoll = 50ms;
constexpr auto kEdgeAlive = 1s;
constexpr auto kRoomSilence = 2s;        // then the room has no server
constexpr auto kAdmissionPatience = 3s;  // of a client that asks to come in
constexpr auto kPicturePatience = 30s;
constexpr auto kSyncAgain = 300ms;  // at the earliest
constexpr std::size_t kAnswersKnown = 256;

base::Clock::duration ms(double value) {
    return std::chrono::duration_cast<base::Clock::duration>(
        std::chrono::duration<double, std::milli>(value));
}

bool is_viewer(const protocol::EdgeClient& client) { return !may(client.role, protocol::Right::present); }

}  // namespace

RemoteRoom::RemoteRoom(const Connection& connection, std::string room, std::string edge,
                       observe::Metrics& metrics, engine::EngineCallbacks callbacks)
    : connection_(connection),
      room_(std::move(room)),
      edge_(std::move(edge)),
      metrics_(metrics),
      callbacks_(std::move(callbacks)),
      inbox_(connection, subject_from(room_)),
      outbox_(connection, subject_to(room_)),
      thread_([this](const std::stop_token& stop) { receive(stop); }) {}

RemoteRoom::~RemoteRoom() {
    thread_.request_stop();
    thread_.join();
    const std::lock_guard lock(mutex_);
    clients_.clear();
    say(protocol::EdgeSync{});
}

void RemoteRoom::say(decltype(protocol::EdgeMessage::what) what) {
    outbox_.post([message = protocol::EdgeMessage{edge_, std::move(what)}] {
        return Packet{protocol::encode(message)};
    });
}

// --- from the edge's connections

void RemoteRoom::admit(const engine::Admission& asked, Admitted done) {
    const std::lock_guard lock(mutex_);
    const std::int64_t number = next_asked_++;
    asked_[number] = {std::move(done), base::Clock::now() + kAdmissionPatience};
    say(protocol::EdgeAdmission{number, asked.role, asked.token});
}

void RemoteRoom::push(engine::EngineEvent event) {
    const std::lock_guard lock(mutex_);
    std::visit([&](const auto& what) { handle(what); }, event);
}

void RemoteRoom::handle(const engine::ClientJoined& joined) {
    protocol::EdgeClient who{joined.client,     joined.role, joined.token,          joined.name,
                             joined.resume_key, joined.id,   engine::kHelloSequence};
    clients_[joined.client].who = who;
    say(protocol::EdgeJoined{who});
}

void RemoteRoom::handle(const engine::ClientLeft& left) {
    const auto found = clients_.find(left.client);
    if (found == clients_.end()) return;
    if (is_viewer(found->second.who)) count_viewer(found->second.wanted, false);
    clients_.erase(found);
    say(protocol::EdgeLeft{left.client});
    if (viewer_ != left.client) return;
    viewer_.clear();
    viewers_want_ = {};
    want_for_viewers();
}

void RemoteRoom::handle(const engine::MessageReceived& received) {
    const auto found = clients_.find(received.client);
    if (found == clients_.end()) return;
    protocol::EdgeSaid said{received.client, received.sequence,
                            received.message ? received.message->text : received.unreadable};
    found->second.unhandled.push_back({said, received.is_request()});
    say(std::move(said));
}

/// Viewers want frames as one: none is drawn for one of them that another does not get, too.
void RemoteRoom::handle(const engine::FramesWanted& wanted) {
    const auto found = clients_.find(wanted.client);
    if (found == clients_.end()) return;
    const engine::FramesWanted before = std::exchange(found->second.wanted, wanted);
    if (!is_viewer(found->second.who)) return say_wanted(wanted);
    count_viewer(before, false);
    count_viewer(wanted, true);
    want_for_viewers();
}

void RemoteRoom::count_viewer(const engine::FramesWanted& wanted, bool wants) {
    if (wanted.count == 0) return;
    if (wants) {
        ++viewers_wanting_[wanted.newer_than];
    } else if (--viewers_wanting_[wanted.newer_than] == 0) {
        viewers_wanting_.erase(wanted.newer_than);
    }
}

/// A frame newer than the newest that any has who wants one.
void RemoteRoom::want_for_viewers() {
    if (viewer_.empty()) {
        const auto found =
            std::ranges::find_if(clients_, [](const auto& entry) { return is_viewer(entry.second.who); });
        if (found == clients_.end()) return;
        viewer_ = found->first;
    }
    engine::FramesWanted all{viewer_, 0, 0, clients_.at(viewer_).wanted.since_sequence, {}};
    all.only_warped = true;
    for (const auto& [name, client] : clients_) {
        if (!is_viewer(client.who) || client.wanted.client.empty()) continue;
        all.depth |= client.wanted.depth;
        all.only_warped &= client.wanted.only_warped;
    }
    if (!viewers_wanting_.empty()) {
        all.newer_than = viewers_wanting_.rbegin()->first;
        all.count = 1;
    }
    if (all == viewers_want_) return;
    viewers_want_ = all;
    say_wanted(all);
}

void RemoteRoom::say_wanted(const engine::FramesWanted& wanted) {
    protocol::EdgeWanted said{wanted.client, wanted.newer_than,  wanted.count, wanted.since_sequence,
                              wanted.depth,  wanted.only_warped, {},           {}};
    if (wanted.link) {
        said.bytes_per_second = std::min(wanted.link->bytes_per_second, protocol::kFastestLink);
        said.round_trip_ms = std::chrono::duration<double, std::milli>(wanted.link->round_trip).count();
    }
    say(said);
}

void RemoteRoom::handle(const engine::SnapshotSent& sent) { say(protocol::EdgeSnapshotSent{sent.client}); }

void RemoteRoom::handle(const engine::PictureAsked& asked) {
    const protocol::EdgePicture picture{asked.name, asked.width, asked.height, asked.view};
    pictures_[asked.name] = {picture, base::Clock::now() + kPicturePatience};
    say(picture);
}

engine::PictureLimits RemoteRoom::limits() const {
    const std::lock_guard lock(mutex_);
    engine::PictureLimits limits;
    if (alive_) limits = {alive_->max_pixels, alive_->max_side};
    return limits;
}

std::string RemoteRoom::description() const {
    const std::lock_guard lock(mutex_);
    return alive_ ? alive_->renderer : "";
}

bool RemoteRoom::is_lost(base::Clock::time_point now) const {
    return !heard_ || now - *heard_ > kRoomSilence;
}

std::optional<std::string> RemoteRoom::why_unready() const {
    if (!connection_.is_connected()) return "the NATS server cannot be reached";
    const std::lock_guard lock(mutex_);
    if (is_lost(base::Clock::now())) return "no server draws the room '" + room_ + "' now";
    if (alive_ && !alive_->unready.empty()) return alive_->unready;
    return std::nullopt;
}

std::size_t RemoteRoom::events_waiting() const {
    const std::lock_guard lock(mutex_);
    std::size_t waiting = 0;
    for (const auto& [name, client] : clients_) waiting += client.unhandled.size();
    return waiting;
}

// --- from the room's server

void RemoteRoom::receive(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        poll(base::Clock::now());
        if (auto packet = inbox_.next(kInboxPoll)) take(*std::move(packet));
    }
}

/// Says that it is there, asks for what it missed, and gives up what is not answered.
void RemoteRoom::poll(base::Clock::time_point now) {
    std::vector<Admitted> unanswered;
    engine::EngineOutput output;
    {
        const std::lock_guard lock(mutex_);
        if (now - said_alive_at_ >= kEdgeAlive) {
            said_alive_at_ = now;
            say(protocol::EdgeAlive{});
        }
        if (!in_step_) sync(now);
        for (auto asked = asked_.begin(); asked != asked_.end();) {
            if (asked->second.until > now) {
                ++asked;
                continue;
            }
            unanswered.push_back(std::move(asked->second.done));
            asked = asked_.erase(asked);
        }
        const bool was_lost = std::exchange(was_lost_, is_lost(now));
        if (was_lost_ && !was_lost && document_) {
            observe::log_warning("room_lost", {{"room", room_}});
            const std::string text = protocol::encode(protocol::Error{
                {},
                protocol::error_code::failed,
                "no server draws the room '" + room_ + "' now: what you do is done when one does again"});
            for (const auto& [name, client] : clients_) output.answers.push_back({name, text, 0});
        }
        for (auto picture = pictures_.begin(); picture != pictures_.end();) {
            if (picture->second.until > now) {
                ++picture;
                continue;
            }
            output.failed_pictures.push_back(picture->first);
            picture = pictures_.erase(picture);
        }
    }
    if (!output.empty()) callbacks_.on_output(std::move(output));
    for (const Admitted& done : unanswered)
        done(
            tl::unexpected(protocol::Error{{},
                                           protocol::error_code::failed,
                                           "no server draws the room '" + room_ + "' now: try again later"}));
}

void RemoteRoom::sync(base::Clock::time_point now) {
    if (now - synced_at_ < kSyncAgain) return;
    synced_at_ = now;
    protocol::EdgeSync all;
    for (const auto& [name, client] : clients_) all.clients.push_back(client.who);
    say(std::move(all));
    for (auto& [name, client] : clients_) {
        for (Said& said : client.unhandled) {
            said.message.again = true;
            say(said.message);
        }
        if (!is_viewer(client.who) && !client.wanted.client.empty()) say_wanted(client.wanted);
    }
    for (const auto& [name, picture] : pictures_) say(picture.what);
    viewers_want_ = {};
    want_for_viewers();
}

void RemoteRoom::take(Packet packet) {
    const base::Clock::time_point now = base::Clock::now();
    auto message = protocol::parse_room_message(packet.json);
    if (!message) {
        if (now - complained_at_ < kAdmissionPatience) return;
        complained_at_ = now;
        return observe::log_warning("invalid_relay", {{"room", room_}, {"reason", message.error()}});
    }
    std::optional<engine::EngineOutput> output;
    std::shared_ptr<const engine::EncodedPicture> picture;
    std::function<void()> admitted;
    {
        const std::lock_guard lock(mutex_);
        if (message->lease < lease_) return;  // of a server that has lost the room
        learn(*message, now);
        if (const auto* said = std::get_if<protocol::RoomOutput>(&message->what)) output = output_of(*said);
        if (const auto* said = std::get_if<protocol::RoomPicture>(&message->what))
            picture = picture_of(*said, std::move(packet.bytes));
        if (const auto* said = std::get_if<protocol::RoomAdmitted>(&message->what);
            said && said->edge == edge_)
            if (auto asked = asked_.extract(said->question)) {
                tl::expected<protocol::Role, protocol::Error> role =
                    tl::unexpected(protocol::Error{{}, protocol::error_code::not_allowed, said->why});
                if (said->role) role = *said->role;
                admitted = [done = std::move(asked.mapped().done), role] { done(role); };
            }
    }
    if (admitted) admitted();
    if (output && !output->empty()) callbacks_.on_output(*std::move(output));
    if (picture) callbacks_.on_encoded(std::move(picture));
}

/// Who draws the room, and whether something was missed.
void RemoteRoom::learn(const protocol::RoomMessage& message, base::Clock::time_point now) {
    const auto* alive = std::get_if<protocol::RoomAlive>(&message.what);
    if (message.lease > lease_) {
        observe::log_info("room_taken_over", {{"room", room_}, {"lease", message.lease}});
        lease_ = message.lease;
        number_ = message.number - 1;
        in_step_ = false;
        clock_difference_ = base::Clock::duration::max();
        // All that was handled is in the room's log, and so in each frame of this server.
        for (const auto& [name, client] : clients_) applies(name, {0, client.who.handled});
    }
    if (message.number != number_ + 1) in_step_ = false;
    number_ = message.number;
    heard_ = now;
    if (std::holds_alternative<protocol::RoomLeft>(message.what)) heard_.reset();
    if (!alive) return;
    alive_ = *alive;
    if (std::ranges::find(alive->edges, edge_) == alive->edges.end()) in_step_ = false;
}

std::optional<engine::EngineOutput> RemoteRoom::output_of(const protocol::RoomOutput& said) {
    const bool is_whole = !said.edge.empty();
    if (is_whole && said.edge != edge_) return {};
    if (is_whole) in_step_ = true;
    if (!in_step_) return {};  // it comes with the whole
    engine::EngineOutput output;
    if (!said.state.empty()) take_state(said, output);
    take_answers(said, is_whole || said.again, output);
    output.failed_pictures = said.failed_pictures;
    for (const std::string& picture : output.failed_pictures) pictures_.erase(picture);
    take_handled(said, output);
    if (said.width && said.height) output.size = engine::PictureSize{*said.width, *said.height};
    output.present_frame = said.present_frame;
    if (!said.stats.empty()) output.stats = std::make_shared<const std::string>(said.stats);
    take_loading(said, output);
    for (const protocol::RoomPointed& pointed : said.pointed)
        output.pointed[pointed.client] = std::make_shared<const std::string>(pointed.text);
    return output;
}

/// The whole has the last that was said of a loading, which is passed on only if that has not ended here.
void RemoteRoom::take_loading(const protocol::RoomOutput& said, engine::EngineOutput& output) {
    const bool is_whole = !said.edge.empty();
    std::string loading = said.loading;
    if (is_whole && !said.loads && (loading_.empty() || loading.empty()))
        loading = protocol::given_up_loading(loading_);  // none where none is under way
    output.loads = said.loads;
    if (loading.empty()) return;
    loading_ = said.loads ? loading : "";
    output.loading = std::make_shared<const std::string>(std::move(loading));
}

/// `may_be_known`: some of the answers may have come before.
void RemoteRoom::take_answers(const protocol::RoomOutput& said, bool may_be_known,
                              engine::EngineOutput& output) {
    for (const protocol::RoomAnswer& answer : said.answers) {
        const auto found = clients_.find(answer.client);
        if (found == clients_.end()) continue;
        std::deque<std::string>& known = found->second.answers;
        std::string key = protocol::answer_key(answer.text);
        if (may_be_known)
            if (key.empty() || std::ranges::find(known, key) != known.end()) continue;
        known.push_back(std::move(key));
        if (known.size() > kAnswersKnown) known.pop_front();
        output.answers.push_back({answer.client, answer.text, answer.revision});
    }
}

void RemoteRoom::take_handled(const protocol::RoomOutput& said, engine::EngineOutput& output) {
    for (const protocol::RoomHandled& handled : said.handled) {
        const auto found = clients_.find(handled.client);
        if (found == clients_.end()) continue;
        Client& client = found->second;
        client.who.handled = std::max(client.who.handled, handled.sequence);
        engine::EngineOutput::Handled& all = output.handled[handled.client];
        all.sequence = client.who.handled;
        while (!client.unhandled.empty() && client.unhandled.front().message.sequence <= all.sequence) {
            all.bytes += client.unhandled.front().message.text.size();
            all.requests += client.unhandled.front().is_request;
            client.unhandled.pop_front();
        }
    }
}

void RemoteRoom::take_state(const protocol::RoomOutput& said, engine::EngineOutput& output) {
    const bool is_patch = said.from > 0;
    if (is_patch && (!document_ || document_->revision() != said.from)) {
        in_step_ = false;
        return;
    }
    auto document = protocol::StateDocument::received(said.state, document_.get());
    if (!document) {
        in_step_ = false;
        return observe::log_warning("invalid_relay", {{"room", room_}, {"reason", document.error()}});
    }
    // A server that takes the room over goes on with the revisions of the one before. Where it does not,
    // nobody has drawn the room for so long that it was forgotten.
    if (document_ && !is_patch && (*document)->revision() < document_->revision()) output.begins_anew = true;
    if (document_ && (*document)->revision() == document_->revision()) return;
    document_ = *std::move(document);
    output.document = document_;
    output.by = said.by;
    output.by_since = said.by_since;
}

/// A server that has taken the room over may not know all that frames of the one before showed.
void RemoteRoom::applies(const std::string& client, const engine::Applied& applied) {
    engine::Applied& known = applied_[client];
    known.id = std::max(known.id, applied.id);
    known.sequence = std::max(known.sequence, applied.sequence);
}

std::shared_ptr<const engine::EncodedPicture> RemoteRoom::picture_of(const protocol::RoomPicture& said,
                                                                     std::vector<std::uint8_t> bytes) {
    if (said.header_offset < 0 || static_cast<std::size_t>(said.header_offset) > bytes.size()) return nullptr;
    clock_difference_ = std::min(clock_difference_, base::Clock::now().time_since_epoch() - ms(said.sent_ms));
    const auto time = [&](double sent) { return base::Clock::time_point(ms(sent) + clock_difference_); };
    std::shared_ptr<engine::EncodedPicture> picture = engine::counted_picture(metrics_);
    try {
        picture->encoded_header = protocol::EncodedFrameHeader(said.header);
    } catch (const std::exception& error) {
        observe::log_warning("invalid_relay", {{"room", room_}, {"reason", error.what()}});
        return nullptr;
    }
    if (said.depth_bytes > 0 && static_cast<std::size_t>(said.depth_bytes) <= bytes.size()) {
        const auto depth = bytes.end() - said.depth_bytes;
        picture->depth = std::make_shared<const engine::EncodedDepth>(
            engine::EncodedDepth{said.depth_frame, {depth, bytes.end()}});
        bytes.erase(depth, bytes.end());
    }
    picture->file = std::move(bytes);
    metrics_.bytes_held += picture->file.capacity();
    picture->header_offset = static_cast<std::size_t>(said.header_offset);
    picture->header.frame = said.frame;
    picture->header.revision = said.revision;
    picture->header.handled = said.handled;
    picture->header.snapshot = said.snapshot;
    picture->client = said.client;
    picture->format = said.format;
    picture->idle_since = time(said.idle_since_ms);
    if (said.newest_input_ms) picture->newest_input = time(*said.newest_input_ms);
    if (!said.client.empty()) {
        const auto asked = clients_.find(said.client);
        if (asked == clients_.end()) {  // an image for who is no client
            pictures_.erase(said.client);
            return picture;
        }
        std::deque<std::int64_t>& known = asked->second.snapshots;
        if (std::ranges::find(known, said.snapshot.value_or(0)) != known.end()) return nullptr;
        known.push_back(said.snapshot.value_or(0));
        if (known.size() > kAnswersKnown) known.pop_front();
        return picture;
    }
    for (const protocol::RoomApplied& applied : said.applied)
        if (clients_.contains(applied.client)) applies(applied.client, {applied.id, applied.sequence});
    std::erase_if(applied_, [&](const auto& entry) { return !clients_.contains(entry.first); });
    picture->applied = applied_;
    return picture;
}

}  // namespace vrut::server::nats
