#include "net/connection.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "codec.hpp"
#include "engine/images.hpp"
#include "observe/log.hpp"
#include "utf8.hpp"

namespace vrut::server::net {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using websocket::close_code;
using namespace std::chrono_literals;

namespace {

constexpr auto kGoodbye = 3s;               // for the peer to answer a close
constexpr int kMessagesPerSecond = 10'000;  // of one client; who sends more is read more slowly
// Who has sent so much that is not handled, or has not taken so much of its answers, is not read until that
// is done.
constexpr std::size_t kMaxUnhandled = 1 << 20, kMaxRequests = 256, kMaxAnswers = 1 << 18;
// Beast ends a connection at its own limit in the middle of the message, and the reset that follows may
// overtake the close frame. So messages that are too large are read to their end, up to here, and answered.
constexpr std::size_t kMaxRead = 1 << 20, kReadAtOnce = 1 << 16;
constexpr int kSendBuffer = 128 * 1024;  // the kernel doubles it: at most 256 KiB wait in the socket
constexpr int kNotSent = 16 * 1024;      // bytes that the kernel takes beyond what is on its way
constexpr auto kLongestBroadcast = 3s;   // statistics wait behind states that change all the time
constexpr std::size_t kInputsRemembered = 64;

/// Lets the kernel end a connection whose peer does not answer at all, as a tablet that fell asleep: after 20
/// s.
void find_dead_peers(int socket) {
    const int on = 1, idle_s = 10, interval_s = 5, probes = 2;
    ::setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPIDLE, &idle_s, sizeof idle_s);
    ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPINTVL, &interval_s, sizeof interval_s);
    ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPCNT, &probes, sizeof probes);
}

/// Lets the kernel end a connection whose peer acknowledges nothing for so long, and take no more than it can
/// send.
void bound_waiting(int socket, std::chrono::milliseconds stuck) {
    const auto timeout_ms = static_cast<unsigned>(stuck.count());
    ::setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &timeout_ms, sizeof timeout_ms);
    ::setsockopt(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kNotSent, sizeof kNotSent);
}

/// Why the other side's end of a connection is at its end, of kCloseReasons.
const char* reason_of(beast::error_code error) {
    if (error == websocket::error::closed) return "normal";
    if (error == boost::asio::error::timed_out) return "stuck";
    return error.category() == make_error_code(websocket::error::closed).category() ? "protocol" : "gone";
}

/// Why this side closes a connection, of kCloseReasons.
const char* reason_of(const protocol::Error& error, close_code code) {
    if (error.code == protocol::error_code::not_allowed) return "token";
    if (code == close_code::try_again_later) return "too-many";
    if (code == close_code::too_big || code == close_code::internal_error) return "too-large";
    if (code == close_code::bad_payload) return "protocol";
    return code == close_code::unknown_data ? "binary" : "hello";
}

}  // namespace

Connection::Connection(Stream stream, ConnectionLimit::Place place, ConnectionRegistry& registry)
    : socket_(std::move(stream)),
      registry_(registry),
      hello_deadline_(socket_.get_executor()),
      watch_(socket_.get_executor()),
      rate_timer_(socket_.get_executor()),
      flow_timer_(socket_.get_executor()),
      place_(std::move(place)),
      rate_(kMessagesPerSecond),
      heard_at_(base::Clock::now()) {
    registry_.connections.insert(this);
    ++registry_.metrics->connections_opened;
}

Connection::~Connection() { registry_.connections.erase(this); }

void Connection::accept(const HttpRequest& request) {
    Stream& stream = beast::get_lowest_layer(socket_);
    stream.expires_never();  // from here on the WebSocket's own deadlines hold
    beast::error_code ignored;
    stream.socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
    stream.socket().set_option(boost::asio::socket_base::send_buffer_size(kSendBuffer), ignored);
    const auto endpoint = stream.socket().remote_endpoint(ignored);
    peer_ = endpoint.address().to_string() + ":" + std::to_string(endpoint.port());

    websocket::stream_base::timeout deadlines{};
    deadlines.handshake_timeout = kGoodbye;
    // Beast's own deadline counts what is read only: it would cut a slow reader, whose pings wait behind a
    // frame. See check_deadlines().
    deadlines.idle_timeout = websocket::stream_base::none();
    deadlines.keep_alive_pings = false;
    find_dead_peers(stream.socket().native_handle());
    bound_waiting(stream.socket().native_handle(), registry_.deadlines.stuck);
    socket_.set_option(deadlines);
    socket_.read_message_max(kMaxRead);
    socket_.auto_fragment(false);  // one frame, one write
    if (request.find(beast::http::field::sec_websocket_protocol) != request.end())
        socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
            response.set(beast::http::field::sec_websocket_protocol, protocol::kSubprotocol);
        }));

    socket_.control_callback([this](websocket::frame_type type, beast::string_view text) {
        if (message_size_ == 0) traffic().unfinished.reset();
        if (type == websocket::frame_type::close) on_close_frame(socket_.reason().code);
        if (type == websocket::frame_type::pong) on_pong({text.data(), text.size()}, base::Clock::now());
    });
    socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
        if (error) return self->drop("handshake");
        self->hello_deadline_.expires_after(self->registry_.deadlines.hello);
        self->hello_deadline_.async_wait([weak = self->weak_from_this()](beast::error_code stopped) {
            const auto connection = weak.lock();
            if (!stopped && connection)
                connection->reject_and_close(
                    {{}, protocol::error_code::bad_message, "no 'hello' came within 5 s"},
                    close_code::policy_error);
        });
        self->watch();
        self->read();
    });
}

// --- reading

void Connection::read() {
    if (reading_ || dropped_ || closing_ || (!begun() && must_wait())) return;
    receive();
}

/// Before the next message.
bool Connection::must_wait() {
    if (unhandled_bytes_ >= kMaxUnhandled || unhandled_requests_ >= kMaxRequests ||
        answer_bytes_ >= kMaxAnswers)
        return true;
    const base::Clock::duration wait = rate_.wait(base::Clock::now());
    if (throttled_ || wait <= 0s) return throttled_;
    throttled_ = true;
    rate_timer_.expires_after(wait + 10ms);  // a hundred messages, and no timer for each
    rate_timer_.async_wait([weak = weak_from_this()](beast::error_code stopped) {
        const auto self = weak.lock();
        if (stopped || !self) return;
        self->throttled_ = false;
        self->read();
    });
    return true;
}

void Connection::receive() {
    reading_ = true;
    socket_.async_read_some(incoming_, kReadAtOnce,
                            [self = shared_from_this()](beast::error_code error, std::size_t size) {
                                self->reading_ = false;
                                if (error) return self->drop(reason_of(error));
                                if (!self->closing_) self->on_received(size);
                                self->read();
                            });
}

void Connection::on_received(std::size_t size) {
    heard_at_ = base::Clock::now();
    if (!begun()) traffic().unfinished = heard_at_;
    message_size_ += size;
    registry_.metrics->bytes_received += size;
    if (message_size_ > protocol::kMaxMessageBytes) incoming_.clear();
    if (!socket_.is_message_done()) return;
    ++registry_.metrics->messages_received;
    rate_.spend(base::Clock::now());
    traffic().unfinished.reset();
    const bool too_large = std::exchange(message_size_, 0) > protocol::kMaxMessageBytes;
    const auto data = incoming_.data();
    const std::string_view text{static_cast<const char*>(data.data()), data.size()};
    if (!socket_.got_text())
        reject_and_close({{}, protocol::error_code::bad_message, "clients send no binary messages"},
                         close_code::unknown_data);
    else if (too_large)
        reject_and_close(
            {{},
             protocol::error_code::bad_message,
             "the message is longer than " + std::to_string(protocol::kMaxMessageBytes) + " bytes"},
            close_code::too_big);
    else if (find_invalid_utf8(text) !=
             std::string_view::npos)  // Beast overlooks it where an empty fragment ends it
        reject_and_close({{}, protocol::error_code::bad_message, "the message is no UTF-8"},
                         close_code::bad_payload);
    else
        on_text(text);
    incoming_.clear();
}

void Connection::on_text(std::string_view text) {
    auto message = protocol::decode(text);
    const auto* hello = message ? std::get_if<protocol::Hello>(&message->payload) : nullptr;
    if (client_.empty() && !hello) {
        if (message)
            message = tl::unexpected(protocol::Error{message->id, protocol::error_code::bad_message,
                                                     "the first message must be 'hello'"});
        return reject_and_close(message.error(), close_code::policy_error);
    }
    if (hello && !client_.empty())
        return reject_and_close(
            {message->id, protocol::error_code::bad_message, "'hello' came a second time"},
            close_code::policy_error);
    if (hello) return on_hello(*hello, message->id);
    std::optional<protocol::FrameGrant> grant;
    if (const auto* granted = message ? std::get_if<protocol::FrameGrant>(&message->payload) : nullptr)
        grant = *granted;
    const std::optional<std::int64_t> id = message ? message->id : std::nullopt;
    if (!grant || id)
        forward(std::move(message), text.size());  // a grant's id rises with those of the others
    if (grant) on_grant(*grant, id);
}

void Connection::forward(tl::expected<protocol::ClientMessage, protocol::Error> message, std::size_t bytes) {
    engine::MessageReceived said{client_, std::move(message), base::Clock::now(), bytes,
                                 role_ == protocol::Role::control};
    said.sequence = ++sequence_;
    unhandled_bytes_ += said.bytes;
    unhandled_requests_ += said.is_request();
    registry_.engine->mailbox().push(std::move(said));
}

void Connection::on_hello(const protocol::Hello& hello, std::optional<std::int64_t> id) {
    const std::optional<protocol::Role> role = registry_.access.role_for(hello.role, hello.token);
    if (!role)
        return reject_and_close({id, protocol::error_code::not_allowed,
                                 hello.token.empty() ? "this server asks for a token" : "the token is wrong"},
                                close_code::policy_error);
    if (registry_.clients.size() >= registry_.max_clients)
        return reject_and_close(
            {id, protocol::error_code::too_many,
             "the server has its " + std::to_string(registry_.max_clients) + " clients already"},
            close_code::try_again_later);
    if (registry_.stopping) return;  // the close is on its way
    hello_deadline_.cancel();
    role_ = *role;
    client_ = "c" + std::to_string(registry_.next_client++);
    registry_.clients[client_] = shared_from_this();
    if (!registry_.loads) loading_ = registry_.loading;  // is no news any more
    ++registry_.metrics->clients_joined;
    ++registry_.metrics->clients[name_of(*role)];
    observe::log_info("joined",
                      {{"client", client_}, {"role", name_of(*role)}, {"name", hello.name}, {"peer", peer_}});
    registry_.engine->mailbox().push(engine::ClientJoined{client_, *role, hello.name, id.value_or(0)});

    protocol::Welcome welcome;
    welcome.id = id;
    welcome.server = VRUT_VERSION;
    welcome.client = client_;
    welcome.role = *role;
    welcome.limits.max_pixels = registry_.engine->limits().max_pixels;
    welcome.limits.messages_per_second = kMessagesPerSecond;
    answer({client_, protocol::encode(welcome), 0});
}

void Connection::reject_and_close(const protocol::Error& error, close_code code) {
    ++registry_.metrics->errors[error.code];
    observe::log_info(
        "refused", {{"client", client_}, {"peer", peer_}, {"code", error.code}, {"reason", error.message}});
    if (!closing_) close_reason_ = reason_of(error, code);
    answer({client_, protocol::encode(error), 0, error.message});
    close(code, error.message);
}

// --- what there is to send

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
    granted_at_ = sequence_;
    if (const auto input = inputs_.find(grant.shown.value_or(0)); input != inputs_.end()) {
        registry_.metrics->input_to_grant.observe(std::chrono::duration<double>(now - input->second).count());
        inputs_.erase(inputs_.begin(), std::next(input));
    }
    ask_for_frames(now);
    pump();
}

/// Tells the engine what may be sent, where that has changed.
void Connection::ask_for_frames(base::Clock::time_point now) {
    const std::int64_t known = holds_in_vain(now) ? registry_.newest->header.frame : last_frame_;
    const engine::FramesWanted wanted{client_, known, flow_.frames_allowed(now), granted_at_,
                                      flow_.link(now)};
    if (wanted == wanted_) return;
    const bool matters = wanted.count > 0 || wanted_.count > 0;
    wanted_ = wanted;
    if (matters) registry_.engine->mailbox().push(wanted);
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
    const auto& newest = registry_.newest;
    if (!newest || newest->header.frame <= last_frame_) return false;
    const auto applied = newest->applied.find(client_);
    if (applied != newest->applied.end() && applied->second.sequence >= granted_at_) return true;
    return handled_sequence_ >= granted_at_ && registry_.present_frame == newest->header.frame;
}

/// When the newest frame may be sent, as far as the view's rest decides.
base::Clock::time_point Connection::newest_from(base::Clock::time_point now) const {
    return flow_.may_send_from(registry_.newest->file.size(), registry_.newest->rests_since, now);
}

bool Connection::frame_is_due(base::Clock::time_point now) const {
    return has_newer_frame() && flow_.may_send_frame(now) && newest_from(now) <= now;
}

/// The newest frame waits for the view to have rested, and the view has moved on.
bool Connection::holds_in_vain(base::Clock::time_point now) const {
    return has_newer_frame() && registry_.newest->header.frame != registry_.present_frame &&
           newest_from(now) > now;
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
        return say_goodbye();
    }
    const base::Clock::time_point now = base::Clock::now();
    if (!has_broadcasts()) had_broadcasts_ = now;
    if (!client_.empty() && flow_.wants_ping()) return send_ping(now);
    // A frame or answer goes when the client knows the revision that it speaks of.
    const bool frame_due = frame_is_due(now);
    if (frame_due && known >= registry_.newest->header.revision) return send_frame();
    if (!answers_.empty() && known >= answers_.front().revision) return send_answer();
    if (!snapshots_.empty() && known >= snapshots_.front()->header.revision) return send_snapshot();
    const bool waited_for = frame_due || !answers_.empty() || !snapshots_.empty();
    if (has_updates() && (waited_for || flow_.may_send_update(now))) return send_update(now);
    ask_again(now);
}

/// Nothing goes out behind the close.
void Connection::say_goodbye() {
    if (std::exchange(said_goodbye_, true)) return;
    writing_ = true;
    socket_.async_close(*closing_, [self = shared_from_this()](beast::error_code) { self->drop("gone"); });
}

/// Beast would echo a code beyond the last that RFC 6455 knows (7.4.2).
void Connection::on_close_frame(std::uint16_t code) {
    constexpr std::uint16_t kLastCode = 4999;
    if (code <= kLastCode || said_goodbye_) return;
    closing_.emplace(close_code::protocol_error);
    close_reason_ = "protocol";
    answers_.clear();
    say_goodbye();
}

bool Connection::has_updates() const {
    return !client_.empty() && registry_.document.newest() &&
           (document_ != registry_.document.newest() || has_broadcasts());
}

bool Connection::has_broadcasts() const { return loading_ != registry_.loading || stats_ != registry_.stats; }

/// Of each only the newest counts: the document, how far loading is, and statistics. The document goes first,
/// unless the others have waited for long.
void Connection::send_update(base::Clock::time_point now) {
    const bool waits = has_broadcasts() && now - had_broadcasts_ >= kLongestBroadcast;
    if (document_ != registry_.document.newest() && !waits) return send_document();
    had_broadcasts_ = now;
    for (const auto& [newest, sent] :
         {std::pair(&registry_.loading, &loading_), std::pair(&registry_.stats, &stats_)})
        if (*newest != *sent) {
            *sent = *newest;
            flow_.sent_update((*sent)->size(), now);
            return send_text(*sent);
        }
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
    Text update = registry_.document.update_from(document_.get(), *registry_.metrics);
    if (update->size() > protocol::kMaxServerMessageBytes)
        return reject_and_close(
            {{},
             protocol::error_code::failed,
             "the scene's state takes " + std::to_string(update->size()) + " bytes, more than the " +
                 std::to_string(protocol::kMaxServerMessageBytes) +
                 " of a message (maxServerMessage): a scene with fewer or shorter names is needed"},
            close_code::internal_error);
    document_ = registry_.document.newest();
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
    picture_ = registry_.newest;
    last_frame_ = picture_->header.frame;
    const auto applied = picture_->applied.find(client_);
    // A snapshot may have told of more.
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
                                      {"bytes", picture_->file.size()},
                                      {"ms", since_input_ms.value_or(0)}});
    const base::Clock::time_point now = base::Clock::now();
    flow_.sent_frame(last_frame_, picture_->file.size(), now);
    send_picture(since_input_ms);
    ask_for_frames(now);
}

void Connection::send_snapshot() {
    sends_queued_ = true;
    picture_ = std::move(snapshots_.front());
    snapshots_.pop_front();
    ++registry_.metrics->snapshots_sent;
    registry_.engine->mailbox().push(engine::SnapshotSent{client_});
    handled_ = std::max(handled_, picture_->header.handled);
    flow_.sent(picture_->file.size(), base::Clock::now());
    send_picture(picture_->header.timing.since_input_ms);
}

void Connection::send_picture(std::optional<double> since_input_ms) {
    header_ = picture_->header_of_file(handled_, since_input_ms);
    const auto& file = picture_->file;
    const std::size_t cut = picture_->header_offset;
    socket_.binary(true);
    write({boost::asio::buffer(file.data(), cut), boost::asio::buffer(header_),
           boost::asio::buffer(file.data() + cut, file.size() - cut)});
}

void Connection::send_text(Text text) {
    text_ = std::move(text);
    socket_.text(true);
    write({boost::asio::buffer(*text_)});
}

// One type of buffers for all: Beast's write operation takes seconds to compile for each.
void Connection::write(const std::array<boost::asio::const_buffer, 3>& buffers) {
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

// --- the end

void Connection::close(close_code code, const std::string& reason) {
    if (closing_ || dropped_) return;
    // A close frame holds 123 bytes of reason at most, and whole characters.
    std::size_t length = std::min<std::size_t>(reason.size(), 123);
    while (length < reason.size() && (static_cast<unsigned char>(reason[length]) & 0xC0) == 0x80) --length;
    closing_.emplace(code, reason.substr(0, length));
    hello_deadline_.cancel();
    pump();
}

void Connection::drop(const char* reason) {
    if (std::exchange(dropped_, true)) return;
    reason = closing_ ? close_reason_ : reason;
    ++registry_.metrics->closes[reason];
    hello_deadline_.cancel();
    watch_.cancel();
    rate_timer_.cancel();
    flow_timer_.cancel();
    beast::get_lowest_layer(socket_).close();
    answers_.clear();
    snapshots_.clear();
    if (client_.empty()) return;
    observe::log_info("left", {{"client", client_}, {"peer", peer_}, {"reason", reason}});
    ++registry_.metrics->clients_left;
    --registry_.metrics->clients[name_of(role_)];
    registry_.engine->mailbox().push(engine::ClientLeft{client_});
    registry_.clients.erase(client_);
}

}  // namespace vrut::server::net
