#include "net/connection.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <boost/asio/post.hpp>

#include "base/utf8.hpp"
#include "codec.hpp"
#include "engine/images.hpp"
#include "observe/log.hpp"
#include "rights.hpp"
#include "room/input_rules.hpp"

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
    if (code == close_code::too_big) return "too-large";
    if (code == close_code::bad_payload) return "protocol";
    return code == close_code::unknown_data ? "binary" : "hello";
}

}  // namespace

Connection::Connection(Transport transport, ConnectionLimit::Place place, ConnectionRegistry& registry,
                       std::shared_ptr<ServedRoom> room)
    : socket_(std::move(transport)),
      registry_(registry),
      room_(std::move(room)),
      hello_deadline_(socket_.get_executor()),
      deadline_timer_(socket_.get_executor()),
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
    stream.expires_never();        // from here on the WebSocket's own deadlines hold
    traffic().unfinished.reset();  // that was the request
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
            if (!stopped && connection && connection->client_.empty() && !connection->is_joining_)
                connection->reject_and_close(
                    {{}, protocol::error_code::bad_message, "no 'hello' came within 5 s"},
                    close_code::policy_error);
        });
        self->poll_deadlines();
        self->read();
    });
}

// --- reading

void Connection::read() {
    if (reading_ || dropped_ || closing_ || (!unfinished_since() && must_wait())) return;
    receive();
}

/// Before the next message.
bool Connection::must_wait() {
    if (is_joining_ || unhandled_bytes_ >= kMaxUnhandled || unhandled_requests_ >= kMaxRequests ||
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
    if (!unfinished_since()) traffic().unfinished = heard_at_;
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
    else if (vrut::base::find_invalid_utf8(text) !=
             std::string_view::npos)  // Beast overlooks it where an empty fragment ends it
        reject_and_close({{}, protocol::error_code::bad_message, "the message is not UTF-8"},
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
    if (!grant || id) forward(std::move(message), text);  // a grant's id rises with those of the others
    if (grant) on_grant(*grant, id);
}

void Connection::forward(tl::expected<protocol::ClientMessage, protocol::Error> message,
                         std::string_view text) {
    engine::MessageReceived received{client_, std::move(message), base::Clock::now(), text.size(),
                                     may(role_, protocol::Right::hold_control)};
    if (!received.message) received.unreadable = text;
    received.sequence = ++sequence_;
    const bool points =
        received.message && std::holds_alternative<protocol::Point>(received.message->payload);
    if (!points) shown_sequence_ = sequence_;
    unhandled_bytes_ += received.bytes;
    unhandled_requests_ += received.is_request();
    room_->engine->push(std::move(received));
}

void Connection::on_hello(const protocol::Hello& hello, std::optional<std::int64_t> id) {
    const std::string client = "c" + std::to_string(registry_.next_client++) + room_->suffix;
    is_joining_ = true;
    room_->admit({client, hello.role, hello.token},
                 [self = shared_from_this(), client, hello,
                  id](const tl::expected<protocol::Role, protocol::Error>& role) {
                     self->is_joining_ = false;
                     // Not at once: the hello itself may still be in hand.
                     boost::asio::post(self->socket_.get_executor(), [self] { self->read(); });
                     if (self->dropped_ || self->closing_) return;
                     if (role) return self->join(client, *role, hello, id);
                     const auto code = role.error().code == protocol::error_code::not_allowed
                                           ? close_code::policy_error
                                           : close_code::try_again_later;
                     self->reject_and_close({id, role.error().code, role.error().message}, code);
                 });
}

void Connection::join(const std::string& client, protocol::Role role, const protocol::Hello& hello,
                      std::optional<std::int64_t> id) {
    if (!registry_.has_place_for(role, hello, *room_))
        return reject_and_close(
            {id, protocol::error_code::too_many,
             "the server has its " + std::to_string(registry_.max_clients) + " clients already"},
            close_code::try_again_later);
    if (registry_.stopping) return;  // the close is on its way
    hello_deadline_.cancel();
    role_ = role;
    client_ = client;
    resume_key_ = hello.resume;
    wants_depth_ = hello.depth;
    room_->clients[client_] = shared_from_this();
    if (!room_->loads) loading_ = room_->loading;  // over before it came
    ++registry_.metrics->clients_joined;
    ++registry_.metrics->clients[name_of(role)];
    observe::log_info("joined",
                      {{"client", client_}, {"role", name_of(role)}, {"name", hello.name}, {"peer", peer_}});
    sequence_ = shown_sequence_ = engine::kHelloSequence;
    room_->engine->push(
        engine::ClientJoined{client_, role, hello.name, id.value_or(0), hello.resume, hello.token});

    protocol::Welcome welcome;
    welcome.id = id;
    welcome.server = VRUT_VERSION;
    welcome.client = client_;
    welcome.role = role;
    welcome.limits.max_pixels = room_->engine->limits().max_pixels;
    welcome.limits.messages_per_second = kMessagesPerSecond;
    welcome.input = room::input_rules();
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

// --- the end

/// Nothing goes out behind the close.
void Connection::send_goodbye() {
    if (std::exchange(said_goodbye_, true)) return;
    writing_ = true;
    write_by_ = base::Clock::now() + kGoodbye;
    socket_.async_close(*closing_, [self = shared_from_this()](beast::error_code) { self->drop("gone"); });
}

/// Beast would echo a code beyond the last that RFC 6455 knows (7.4.2).
void Connection::on_close_frame(std::uint16_t code) {
    constexpr std::uint16_t kLastCode = 4999;
    if (code <= kLastCode || said_goodbye_) return;
    closing_.emplace(close_code::protocol_error);
    close_reason_ = "protocol";
    answers_.clear();
    answer_bytes_ = 0;
    send_goodbye();
}

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
    deadline_timer_.cancel();
    rate_timer_.cancel();
    flow_timer_.cancel();
    beast::get_lowest_layer(socket_).close();
    answers_.clear();
    answer_bytes_ = 0;
    snapshots_.clear();
    if (client_.empty()) return;
    observe::log_info("left", {{"client", client_}, {"peer", peer_}, {"reason", reason}});
    ++registry_.metrics->clients_left;
    --registry_.metrics->clients[name_of(role_)];
    room_->engine->push(engine::ClientLeft{client_});
    room_->clients.erase(client_);
}

}  // namespace vrut::server::net
