#include "nats/room_owner.hpp"

#include <algorithm>

#include "codec.hpp"
#include "observe/log.hpp"
#include "rights.hpp"

namespace vrut::server::nats {

namespace {

using namespace std::chrono_literals;

constexpr auto kOwnerAlive = 500ms;
constexpr auto kEdgeSilence = 5s;  // then an edge is gone
constexpr auto kOutboxPoll = 100ms;
constexpr std::size_t kAnswersKept = 1024, kAnswerBytesKept = std::size_t{4} << 20;

double ms_of(base::Clock::time_point time) {
    return std::chrono::duration<double, std::milli>(time.time_since_epoch()).count();
}

bool is_of_edge(const std::string& client, const std::string& edge) { return client.ends_with("." + edge); }

}  // namespace

bool is_of_edge(const std::string& client) { return client.find('.') != std::string::npos; }

RoomOwner::RoomOwner(const Connection& connection, const std::string& room, RoleFor role_for)
    : connection_(connection),
      room_(room),
      role_for_(std::move(role_for)),
      outbox_(std::in_place, connection, subject_from(room)) {}

RoomOwner::~RoomOwner() { end(); }

void RoomOwner::begin(engine::RoomEngine& engine, std::uint64_t lease,
                      const std::map<std::string, Known>& clients) {
    engine_ = &engine;
    inbox_.emplace(connection_, subject_to(room_));  // messages before were for another server
    const base::Clock::time_point now = base::Clock::now();
    for (const auto& [client, known] : clients) {
        if (!is_of_edge(client)) continue;
        const std::string edge = client.substr(client.find('.') + 1);
        edges_[edge] = {now, false};
        clients_[client] = {edge, known.may_steer, known.sequence, known.sequence};
    }
    outbox_->post([this, lease]() -> std::optional<Packet> {
        lease_ = lease;
        number_ = 0;
        return {};
    });
    thread_ = std::jthread([this](const std::stop_token& stop) { receive(stop); });
}

void RoomOwner::skip() {
    outbox_->post([this]() -> std::optional<Packet> {
        ++number_;
        skips_ = true;
        return {};
    });
}

void RoomOwner::end() {
    if (!outbox_) return;
    if (thread_.joinable()) {
        thread_.request_stop();
        thread_.join();
        outbox_->post([this] { return packet_of(protocol::RoomLeft{}); });
    }
    outbox_.reset();
    newest_.reset();
    sent_.reset();
}

// --- to edges

void RoomOwner::send(engine::EngineOutput output) {
    outbox_->post([this, moved = std::move(output)]() mutable { return output_packet(std::move(moved)); });
}

/// Of frames the newest counts.
void RoomOwner::send(std::shared_ptr<const engine::EncodedPicture> picture) {
    if (!picture->client.empty()) {
        if (is_of_edge(picture->client)) outbox_->post([this, picture] { return picture_packet(*picture); });
        return;
    }
    {
        const std::lock_guard lock(newest_mutex_);
        if (std::exchange(newest_, std::move(picture))) return;  // that one's turn is this one's
    }
    outbox_->post([this] {
        {
            const std::lock_guard lock(newest_mutex_);
            sent_ = std::exchange(newest_, nullptr);
        }
        return picture_packet(*sent_);
    });
}

std::optional<Packet> RoomOwner::packet_of(decltype(protocol::RoomMessage::what) what) {
    if (lease_ == 0 || std::exchange(skips_, false)) return {};
    return Packet{protocol::encode(protocol::RoomMessage{lease_, ++number_, std::move(what)})};
}

std::vector<protocol::RoomAnswer> RoomOwner::keep_answers(const std::vector<room::Answer>& answers) {
    std::vector<protocol::RoomAnswer> of_edges;
    for (const room::Answer& answer : answers) {
        if (!is_of_edge(answer.client)) continue;
        of_edges.push_back({answer.client, answer.text, answer.revision});
        answers_.push_back(of_edges.back());
        answer_bytes_ += answer.text.size();
        while (answers_.size() > kAnswersKept || answer_bytes_ > kAnswerBytesKept) {
            answer_bytes_ -= answers_.front().text.size();
            answers_.pop_front();
        }
    }
    return of_edges;
}

std::optional<Packet> RoomOwner::output_packet(engine::EngineOutput output) {
    protocol::RoomOutput said;
    said.again = output.again;
    if (output.document) {
        const auto known = std::exchange(document_, std::move(output.document));
        const bool is_patch = known && document_->has_scene_of(*known);
        said.state = is_patch ? document_->encode_patch_from(*known, "") : document_->encode();
        if (is_patch) said.from = known->revision();
        said.by = by_ = output.by;
        said.by_since = by_since_ = output.by_since;
    }
    said.answers = keep_answers(output.answers);
    for (const std::string& picture : output.failed_pictures)
        if (is_of_edge(picture)) said.failed_pictures.push_back(picture);
    for (const auto& [client, handled] : output.handled) {
        if (!is_of_edge(client)) continue;
        handled_[client] = handled.sequence;
        said.handled.push_back({client, handled.sequence});
    }
    if (output.size) {
        size_ = output.size;
        said.width = size_->width;
        said.height = size_->height;
    }
    if (output.present_frame) said.present_frame = present_frame_ = output.present_frame;
    if (output.stats) said.stats = stats_ = *output.stats;
    if (output.loading) {
        said.loading = loading_ = *output.loading;
        said.loads = loads_ = output.loads;
    }
    for (const auto& [client, text] : output.pointed) said.pointed.push_back({client, *text});
    const bool is_empty = said.state.empty() && said.answers.empty() && said.failed_pictures.empty() &&
                          said.handled.empty() && !said.width && !said.present_frame && said.stats.empty() &&
                          said.loading.empty() && said.pointed.empty();
    if (is_empty) return {};
    return packet_of(std::move(said));
}

/// All that an edge has to know.
std::optional<Packet> RoomOwner::whole_packet(const std::string& edge) {
    protocol::RoomOutput said;
    said.edge = edge;
    if (document_) {
        said.state = document_->encode();
        said.by = by_;
        said.by_since = by_since_;
    }
    for (const protocol::RoomAnswer& answer : answers_)
        if (is_of_edge(answer.client, edge)) said.answers.push_back(answer);
    for (const auto& [client, sequence] : handled_)
        if (is_of_edge(client, edge)) said.handled.push_back({client, sequence});
    if (size_) {
        said.width = size_->width;
        said.height = size_->height;
    }
    said.present_frame = present_frame_;
    said.stats = stats_;
    said.loading = loading_;
    said.loads = loads_;
    applied_.clear();  // the next frame names all
    return packet_of(std::move(said));
}

std::optional<Packet> RoomOwner::picture_packet(const engine::EncodedPicture& picture) {
    protocol::RoomPicture said;
    said.frame = picture.header.frame;
    said.revision = picture.header.revision;
    said.handled = picture.header.handled;
    said.snapshot = picture.header.snapshot;
    said.client = picture.client;
    said.format = picture.format;
    said.header = picture.encoded_header.text();
    said.header_offset = static_cast<std::int64_t>(picture.header_offset);
    // What did not change since the last frame is known.
    if (picture.client.empty())
        for (const auto& [client, applied] : picture.applied) {
            if (!is_of_edge(client)) continue;
            engine::Applied& known = applied_[client];
            if (known.id == applied.id && known.sequence == applied.sequence) continue;
            known = applied;
            said.applied.push_back({client, applied.id, applied.sequence});
        }
    if (picture.newest_input) said.newest_input_ms = ms_of(*picture.newest_input);
    said.idle_since_ms = ms_of(picture.idle_since);
    said.sent_ms = ms_of(base::Clock::now());
    if (picture.depth) {
        said.depth_frame = picture.depth->frame;
        said.depth_bytes = static_cast<std::int64_t>(picture.depth->bytes.size());
    }
    auto packet = packet_of(std::move(said));
    if (!packet) return packet;
    packet->bytes = picture.file;
    if (picture.depth)
        packet->bytes.insert(packet->bytes.end(), picture.depth->bytes.begin(), picture.depth->bytes.end());
    return packet;
}

// --- from edges

void RoomOwner::receive(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        const base::Clock::time_point now = base::Clock::now();
        if (now - alive_at_ >= kOwnerAlive) send_alive();
        forget_silent_edges(now);
        const auto packet = inbox_->next(kOutboxPoll);
        if (!packet) continue;
        auto message = protocol::parse_edge_message(packet->json);
        if (!message) {
            if (now - complained_at_ < kEdgeSilence) continue;
            complained_at_ = now;
            observe::log_warning("invalid_relay", {{"reason", message.error()}});
            continue;
        }
        const auto edge = edges_.find(message->edge);
        const bool asks = std::holds_alternative<protocol::EdgeSync>(message->what) ||
                          std::holds_alternative<protocol::EdgeAdmission>(message->what);
        if (edge == edges_.end() && !asks) continue;  // it learns from `alive` that it is not known
        if (edge != edges_.end()) edge->second.heard = now;
        std::visit([&](const auto& what) { handle(message->edge, what); }, message->what);
    }
}

void RoomOwner::send_alive() {
    alive_at_ = base::Clock::now();
    protocol::RoomAlive alive;
    for (const auto& [id, edge] : edges_)
        if (edge.in_step) alive.edges.push_back(id);
    alive.renderer = engine_->description();
    alive.max_pixels = engine_->limits().max_pixels;
    alive.max_side = engine_->limits().max_side;
    alive.unready = engine_->why_unready().value_or("");
    outbox_->post([this, alive] { return packet_of(alive); });
}

void RoomOwner::forget_silent_edges(base::Clock::time_point now) {
    for (auto edge = edges_.begin(); edge != edges_.end();) {
        if (now - edge->second.heard < kEdgeSilence) {
            ++edge;
            continue;
        }
        observe::log_warning("edge_lost", {{"edge", edge->first}});
        std::vector<std::string> gone;
        for (const auto& [client, known] : clients_)
            if (known.edge == edge->first) gone.push_back(client);
        for (const std::string& client : gone) leave(client);
        edge = edges_.erase(edge);
    }
}

RoomOwner::Client* RoomOwner::find(const std::string& edge, const std::string& client) {
    const auto found = clients_.find(client);
    return found == clients_.end() || found->second.edge != edge ? nullptr : &found->second;
}

void RoomOwner::join(const std::string& edge, const protocol::EdgeClient& client) {
    const auto role = role_for_(client.role, client.token);
    if (!role || clients_.contains(client.client) || !is_of_edge(client.client, edge)) return;
    const std::uint64_t handled = std::max(client.handled, engine::kHelloSequence);
    clients_[client.client] = {edge, may(*role, protocol::Right::hold_control), handled};
    engine_->push(
        engine::ClientJoined{client.client, *role, client.name, client.id, client.resume, {}, handled});
}

void RoomOwner::leave(const std::string& client) {
    clients_.erase(client);
    engine_->push(engine::ClientLeft{client});
    outbox_->post([this, client]() -> std::optional<Packet> {
        handled_.erase(client);
        applied_.erase(client);
        return {};
    });
}

void RoomOwner::handle(const std::string& edge, const protocol::EdgeSync& sync) {
    if (sync.version != protocol::kRelayVersion) {
        observe::log_warning("edge_refused",
                             {{"edge", edge},
                              {"reason", "it speaks version " + std::to_string(sync.version) +
                                             ", this server " + std::to_string(protocol::kRelayVersion)}});
        return;
    }
    if (!edges_.contains(edge)) observe::log_info("edge_joined", {{"edge", edge}});
    edges_[edge] = {base::Clock::now(), true};
    std::set<std::string> here;
    for (const protocol::EdgeClient& client : sync.clients) here.insert(client.client);
    std::vector<std::string> gone;
    for (const auto& [client, known] : clients_)
        if (known.edge == edge && !here.contains(client)) gone.push_back(client);
    for (const std::string& client : gone) leave(client);
    for (const protocol::EdgeClient& client : sync.clients) {
        join(edge, client);
        if (Client* const known = find(edge, client.client))
            known->sequence = std::max(known->sequence, client.handled);
    }
    send_alive();
    outbox_->post([this, edge] { return whole_packet(edge); });
    outbox_->post([this] { return sent_ ? picture_packet(*sent_) : std::nullopt; });
}

void RoomOwner::handle(const std::string&, const protocol::EdgeAlive&) {}

void RoomOwner::handle(const std::string& edge, const protocol::EdgeAdmission& asked) {
    protocol::RoomAdmitted admitted{edge, asked.number, role_for_(asked.role, asked.token), {}};
    if (!admitted.role)
        admitted.why = asked.token.empty() ? "this server asks for a token" : "the token is wrong";
    outbox_->post([this, admitted] { return packet_of(admitted); });
}

void RoomOwner::handle(const std::string& edge, const protocol::EdgeJoined& joined) {
    join(edge, joined.client);
}

void RoomOwner::handle(const std::string& edge, const protocol::EdgeLeft& left) {
    if (find(edge, left.client)) leave(left.client);
}

void RoomOwner::handle(const std::string& edge, const protocol::EdgeSaid& said) {
    Client* const client = find(edge, said.client);
    if (!client) return;
    if (said.sequence > client->sequence + 1) {  // one was lost
        edges_[edge].in_step = false;
        return;
    }
    engine::MessageReceived received{said.client, protocol::decode(said.text), base::Clock::now(),
                                     said.text.size()};
    if (said.sequence <= client->sequence) {
        // What the log does not have may not have been answered by the server before.
        const bool is_in_log = received.message && protocol::traits_of(*received.message).recorded;
        if (!said.again || said.sequence > client->followed || is_in_log) return;
    }
    client->sequence = std::max(client->sequence, said.sequence);
    received.may_steer = client->may_steer;
    received.sequence = said.sequence;
    engine_->push(std::move(received));
}

void RoomOwner::handle(const std::string& edge, const protocol::EdgeWanted& wanted) {
    if (!find(edge, wanted.client)) return;
    engine::FramesWanted frames{wanted.client, wanted.newer_than, wanted.count, wanted.since_sequence, {},
                                wanted.depth,  wanted.only_warped};
    if (wanted.bytes_per_second && wanted.round_trip_ms)
        frames.link = engine::Link{*wanted.bytes_per_second,
                                   std::chrono::duration_cast<base::Clock::duration>(
                                       std::chrono::duration<double, std::milli>(*wanted.round_trip_ms))};
    engine_->push(frames);
}

void RoomOwner::handle(const std::string& edge, const protocol::EdgeSnapshotSent& sent) {
    if (find(edge, sent.client)) engine_->push(engine::SnapshotSent{sent.client});
}

void RoomOwner::handle(const std::string& edge, const protocol::EdgePicture& picture) {
    if (is_of_edge(picture.name, edge))
        engine_->push(engine::PictureAsked{picture.name, picture.width, picture.height, picture.view});
}

}  // namespace vrut::server::nats
