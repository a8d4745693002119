// What a client is sent, and when.
#include "codec.hpp"
#include "net/connection.hpp"
#include "observe/log.hpp"
#include "rights.hpp"

namespace vrut::server::net {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using namespace std::chrono_literals;

namespace {

constexpr auto kLongestBroadcast = 3s;  // statistics wait behind states that change all the time
constexpr std::size_t kInputsRemembered = 64;

}  // namespace

void Connection::answer(room::Answer answer) {
    answer_bytes_ += answer.text.size();
    answers_.push_back({held_text(std::move(answer.text), *registry_.metrics), answer.revision});
    pump();
}

/// Credits are counted here, and what a frame must show is: what the messages before its grant did.
void Connection::on_grant(const protocol::FrameGrant& grant, std::optional<std::int64_t> id) {
    const base::Clock::time_point now = base::Clock::now();
    if (grant.shown && !flow_.grant(*grant.shown, now)) {
        const protocol::Error error{
            id, protocol::error_code::out_of_range,
            "'shown': frame " + std::to_string(*grant.shown) + " was never sent to this client"};
        ++registry_.metrics->errors[error.code];
        return answer({client_, protocol::encode(error), 0, error.message});
    }
    if (!grant.shown) flow_.grant();
    ++registry_.metrics->frames_granted;
    granted_at_ = shown_sequence_;
    if (const auto input = inputs_.find(grant.shown.value_or(0)); input != inputs_.end()) {
        registry_.metrics->input_to_grant.observe(std::chrono::duration<double>(now - input->second).count());
        inputs_.erase(inputs_.begin(), std::next(input));
    }
    ask_for_frames(now);
    pump();
}

/// Tells the engine what may be sent, where that has changed.
void Connection::ask_for_frames(base::Clock::time_point now) {
    const std::int64_t known = holds_in_vain(now) ? room_->newest->header.frame : last_frame_;
    const engine::FramesWanted wanted{
        client_, known, flow_.frames_allowed(now), granted_at_, flow_.link(now), wants_depth_, wants_depth_};
    if (wanted == wanted_) return;
    const bool matters = wanted.count > 0 || wanted_.count > 0;
    wanted_ = wanted;
    if (matters) room_->engine->push(wanted);
}

void Connection::take_snapshot(std::shared_ptr<const engine::EncodedPicture> picture) {
    snapshots_.push_back(std::move(picture));
    pump();
}

void Connection::handled(const engine::EngineOutput::Handled& handled) {
    unhandled_bytes_ -= std::min(handled.bytes, unhandled_bytes_);
    unhandled_requests_ -= std::min(handled.requests, unhandled_requests_);
    handled_sequence_ = handled.sequence;
    read();
}

void Connection::newest_changed(std::int64_t before) {
    const bool waited = writing_ && flow_.credits() > 0 && before > last_frame_;
    if (waited) ++registry_.metrics->frames_replaced;
    pump();
}

/// One that shows what the messages before the newest grant did, or what is to be seen after them.
bool Connection::has_newer_frame() const {
    const auto& newest = room_->newest;
    if (!newest || newest->header.frame <= last_frame_) return false;
    const auto applied = newest->applied.find(client_);
    if (applied != newest->applied.end() && applied->second.sequence >= granted_at_) return true;
    return handled_sequence_ >= granted_at_ && room_->present_frame == newest->header.frame;
}

/// When the newest frame may be sent, as far as the time decides for which the view has been idle.
base::Clock::time_point Connection::newest_from(base::Clock::time_point now) const {
    return flow_.may_send_from(bytes_of(*room_->newest), room_->newest->idle_since, now);
}

bool Connection::frame_is_due(base::Clock::time_point now) const {
    return has_newer_frame() && flow_.may_send_frame(now) && newest_from(now) <= now;
}

/// The newest frame waits for the view to have rested, and the view has moved on.
bool Connection::holds_in_vain(base::Clock::time_point now) const {
    return has_newer_frame() && room_->newest->header.frame != room_->present_frame && newest_from(now) > now;
}

/// What was not sent because of what is under way is looked at again when that may have changed.
void Connection::ask_again(base::Clock::time_point now) {
    ask_for_frames(now);
    auto at = flow_.ask_again(now);
    if (has_newer_frame() && flow_.may_send_frame(now)) {
        const auto from = newest_from(now);
        if (from > now) at = std::min(at.value_or(from), from);
    }
    if (!at) return flow_timer_.cancel(), void();
    flow_timer_.expires_at(std::max(*at, now + 1ms));
    flow_timer_.async_wait([weak = weak_from_this()](beast::error_code stopped) {
        const auto self = weak.lock();
        if (stopped || !self || self->dropped_) return;
        self->ask_for_frames(base::Clock::now());
        self->pump();
    });
}

void Connection::pump() {
    if (writing_ || dropped_) return;
    const std::int64_t known = document_ ? document_->revision() : 0;
    if (closing_) {
        if (!answers_.empty()) return send_answer();
        return send_goodbye();
    }
    const base::Clock::time_point now = base::Clock::now();
    if (!has_broadcasts()) had_broadcasts_ = now;
    if (!client_.empty() && flow_.wants_ping()) return send_ping(now);
    // A frame or answer goes when the client knows the revision that it speaks of.
    const bool frame_due = frame_is_due(now);
    if (frame_due && known >= room_->newest->header.revision) return send_frame();
    if (!answers_.empty() && known >= answers_.front().revision) return send_answer();
    if (!snapshots_.empty() && known >= snapshots_.front()->header.revision) return send_snapshot();
    const bool waited_for = frame_due || !answers_.empty() || !snapshots_.empty();
    if (has_updates() && (waited_for || flow_.may_send_update(now))) return send_update(now);
    ask_again(now);
}

DocumentUpdates& Connection::documents() const {
    return may(role_, protocol::Right::drive_walls) ? room_->host_document : room_->document;
}

/// A client that has not joined the room gets no document: its first one tells who has control.
bool Connection::has_updates() const {
    const bool has_joined = handled_sequence_ >= engine::kHelloSequence;
    return has_joined && documents().newest() &&
           (document_ != documents().newest() || has_broadcasts() || !points_.empty());
}

bool Connection::has_broadcasts() const { return loading_ != room_->loading || stats_ != room_->stats; }

/// Of each only the newest counts: the document, what each client points at, how far loading is, and
/// statistics. The document takes turns with points, and goes before the others, unless these have waited for
/// long.
void Connection::send_update(base::Clock::time_point now) {
    const bool knows_newest = document_ == documents().newest();
    if (document_ && !points_.empty() && (knows_newest || points_turn_)) return send_point(now);
    const bool waits = has_broadcasts() && now - had_broadcasts_ >= kLongestBroadcast;
    if (document_ != documents().newest() && !waits) return send_document();
    had_broadcasts_ = now;
    for (const auto& [newest, sent] :
         {std::pair(&room_->loading, &loading_), std::pair(&room_->stats, &stats_)})
        if (*newest != *sent) {
            *sent = *newest;
            flow_.sent_update((*sent)->size(), now);
            return send_text(*sent);
        }
}

void Connection::send_point(base::Clock::time_point now) {
    points_turn_ = false;
    Text text = points_.take();
    flow_.sent_update(text->size(), now);
    send_text(std::move(text));
}

void Connection::send_answer() {
    Text text = std::move(answers_.front().text);
    answers_.pop_front();
    answer_bytes_ -= text->size();
    flow_.sent(text->size(), base::Clock::now());
    sends_queued_ = true;
    send_text(std::move(text));
}

void Connection::send_document() {
    Text update = documents().update_from(document_.get(), *registry_.metrics);
    document_ = documents().newest();
    points_turn_ = true;
    flow_.sent_update(update->size(), base::Clock::now());
    send_text(std::move(update));
}

void Connection::send_ping(base::Clock::time_point now) {
    writing_ = true;
    write_by_ = now + registry_.deadlines.stuck;
    pinged_at_ = now;
    const websocket::ping_data number(std::to_string(flow_.sent_ping(now)).c_str());
    socket_.async_ping(number,
                       [self = shared_from_this()](beast::error_code error) { self->on_written(error); });
}

void Connection::send_frame() {
    picture_ = room_->newest;
    last_frame_ = picture_->header.frame;
    const auto applied = picture_->applied.find(client_);
    // A snapshot may have shown more.
    if (applied != picture_->applied.end()) handled_ = std::max(handled_, applied->second.id);
    std::optional<double> since_input_ms;
    if (picture_->newest_input)
        since_input_ms =
            std::chrono::duration<double, std::milli>(base::Clock::now() - *picture_->newest_input).count();
    if (picture_->newest_input > shown_input_) {
        inputs_[last_frame_] = *picture_->newest_input;
        if (inputs_.size() > kInputsRemembered) inputs_.erase(inputs_.begin());
        shown_input_ = *picture_->newest_input;
        registry_.metrics->input_to_frame.observe(*since_input_ms / 1000);
    }
    ++registry_.metrics->frames_sent;
    observe::log_debug("frame_sent", {{"client", client_},
                                      {"frame", last_frame_},
                                      {"bytes", bytes_of(*picture_)},
                                      {"ms", since_input_ms.value_or(0)}});
    const base::Clock::time_point now = base::Clock::now();
    flow_.sent_frame(last_frame_, bytes_of(*picture_), now);
    send_picture(since_input_ms);
    ask_for_frames(now);
}

void Connection::send_snapshot() {
    sends_queued_ = true;
    picture_ = std::move(snapshots_.front());
    snapshots_.pop_front();
    ++registry_.metrics->snapshots_sent;
    room_->engine->push(engine::SnapshotSent{client_});
    handled_ = std::max(handled_, picture_->header.handled);
    flow_.sent(picture_->file.size(), base::Clock::now());
    send_picture(picture_->header.timing.since_input_ms);
}

/// A client keeps the depth that it has for the refinements of a frame.
bool Connection::sends_depth_of(const engine::EncodedPicture& picture) const {
    return wants_depth_ && picture.depth && picture.depth->frame != depth_frame_;
}

std::size_t Connection::bytes_of(const engine::EncodedPicture& picture) const {
    return picture.file.size() + (sends_depth_of(picture) ? picture.depth->bytes.size() : 0);
}

void Connection::send_picture(std::optional<double> since_input_ms) {
    using Depth = protocol::EncodedFrameHeader::Depth;
    const bool sends_depth = sends_depth_of(*picture_);
    header_ = picture_->header_of_file(handled_, since_input_ms,
                                       sends_depth    ? Depth::sent
                                       : wants_depth_ ? Depth::known
                                                      : Depth::none);
    if (sends_depth) depth_frame_ = picture_->depth->frame;
    const auto& file = picture_->file;
    const std::size_t cut = picture_->header_offset;
    socket_.binary(true);
    write({boost::asio::buffer(file.data(), cut), boost::asio::buffer(header_),
           boost::asio::buffer(file.data() + cut, file.size() - cut),
           sends_depth ? boost::asio::buffer(picture_->depth->bytes) : boost::asio::const_buffer()});
}

/// No client gets a message longer than `welcome` says.
void Connection::send_text(Text text) {
    if (text->size() > protocol::kMaxServerMessageBytes) {
        observe::log_warning("message_too_long", {{"client", client_}, {"bytes", text->size()}});
        answers_.clear();
        answer_bytes_ = 0;
        close_reason_ = "too-large";
        close(websocket::close_code::internal_error, "a message would be longer than maxServerMessage");
        return pump();  // where it is closing already
    }
    text_ = std::move(text);
    socket_.text(true);
    write({boost::asio::buffer(*text_)});
}

// One type of buffers for all: Beast's write operation takes seconds to compile for each.
void Connection::write(const std::array<boost::asio::const_buffer, 4>& buffers) {
    writing_ = true;
    const std::size_t bytes = boost::asio::buffer_size(buffers);
    registry_.metrics->bytes_sent += bytes;
    write_by_ = base::Clock::now() + registry_.deadlines.stuck + std::chrono::seconds(bytes / kLeastRate);
    socket_.async_write(buffers, [self = shared_from_this()](beast::error_code error, std::size_t) {
        self->on_written(error);
    });
}

void Connection::on_written(beast::error_code error) {
    writing_ = sends_queued_ = false;
    picture_.reset();
    text_.reset();
    // Beast is closing for what it has read; the read ends when the peer knows why.
    if (error == boost::asio::error::operation_aborted && reading_) return;
    if (error) return drop(error == boost::asio::error::timed_out ? "stuck" : "gone");
    pump();
    read();
}

}  // namespace vrut::server::net
