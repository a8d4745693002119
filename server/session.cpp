#include "session.hpp"

#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "codec.hpp"
#include "images.hpp"
#include "log.hpp"

namespace vrut {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using websocket::close_code;
using namespace std::chrono_literals;

namespace {

constexpr auto kHelloDeadline = 5s;
constexpr auto kStuck = 10s;  // a connection that takes nothing for so long is cut
// Who has sent so much that is not handled, or has not taken so much of its answers, is not read until that
// is done.
constexpr std::size_t kMaxUnhandled = 1 << 20, kMaxRequests = 256, kMaxAnswers = 1 << 18;
// Beast ends a connection at its own limit in the middle of the message, and the reset that follows may
// overtake the close frame. So messages that are too large are read to their end, up to here, and answered.
constexpr std::size_t kMaxRead = 1 << 20;
constexpr int kSendBuffer = 128 * 1024;  // the kernel doubles it: at most 256 KiB wait in the socket

/// Bytes that the peer has acknowledged since the connection began.
std::uint64_t bytes_acknowledged(int socket) {
    // tcpi_bytes_acked: the C library's struct tcp_info ends before this member, the kernel's goes on.
    constexpr std::size_t kBytesAckedAt = 120;
    std::array<std::uint8_t, 256> raw{};
    socklen_t size = raw.size();
    if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, raw.data(), &size) != 0 || size < kBytesAckedAt + 8)
        return 0;
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, raw.data() + kBytesAckedAt, sizeof bytes);
    return bytes;
}

/// Lets the kernel end a connection whose peer does not answer at all, as a tablet that fell asleep: after 20
/// s.
void find_dead_peers(int socket) {
    const int on = 1, idle_s = 10, interval_s = 5, probes = 2;
    ::setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPIDLE, &idle_s, sizeof idle_s);
    ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPINTVL, &interval_s, sizeof interval_s);
    ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPCNT, &probes, sizeof probes);
}

/// Why the other side's end of a connection is at its end, of kCloseReasons.
const char* reason_of(beast::error_code error) {
    if (error == websocket::error::closed) return "normal";
    return error.category() == make_error_code(websocket::error::closed).category() ? "protocol" : "gone";
}

/// Why this side closes a connection, of kCloseReasons.
const char* reason_of(const protocol::Error& error, close_code code) {
    if (error.code == protocol::error_code::not_allowed) return "token";
    if (code == close_code::try_again_later) return "too-many";
    if (code == close_code::too_big) return "too-large";
    return code == close_code::unknown_data ? "binary" : "hello";
}

/// Bytes that were handed over and that the peer has not acknowledged.
int bytes_unacknowledged(int socket) {
    int bytes = 0;
    return ::ioctl(socket, SIOCOUTQ, &bytes) == 0 ? bytes : 0;
}

}  // namespace

Session::Session(beast::tcp_stream stream, Hub& hub)
    : socket_(std::move(stream)),
      hub_(hub),
      hello_deadline_(socket_.get_executor()),
      write_watch_(socket_.get_executor()) {
    hub_.connections.insert(this);
    ++hub_.metrics->connections_opened;
}

Session::~Session() { hub_.connections.erase(this); }

void Session::accept(const beast::http::request<beast::http::string_body>& request) {
    beast::tcp_stream& stream = beast::get_lowest_layer(socket_);
    stream.expires_never();  // from here on the WebSocket's own deadlines hold
    beast::error_code ignored;
    stream.socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
    stream.socket().set_option(boost::asio::socket_base::send_buffer_size(kSendBuffer), ignored);
    const auto endpoint = stream.socket().remote_endpoint(ignored);
    peer_ = endpoint.address().to_string() + ":" + std::to_string(endpoint.port());

    websocket::stream_base::timeout deadlines{};
    deadlines.handshake_timeout = 5s;
    // Beast's own deadline counts what is read only: it would cut a slow reader, whose pings wait behind a
    // frame.
    deadlines.idle_timeout = websocket::stream_base::none();
    deadlines.keep_alive_pings = false;
    find_dead_peers(stream.socket().native_handle());
    socket_.set_option(deadlines);
    socket_.read_message_max(kMaxRead);
    socket_.auto_fragment(false);  // one frame, one write
    if (request.find(beast::http::field::sec_websocket_protocol) != request.end())
        socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
            response.set(beast::http::field::sec_websocket_protocol, protocol::kSubprotocol);
        }));

    socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
        if (error) return self->drop("handshake");
        self->hello_deadline_.expires_after(kHelloDeadline);
        self->hello_deadline_.async_wait([weak = self->weak_from_this()](beast::error_code stopped) {
            const auto session = weak.lock();
            if (!stopped && session)
                session->refuse_and_close(
                    {{}, protocol::error_code::bad_message, "no 'hello' came within 5 s"},
                    close_code::policy_error);
        });
        self->read();
    });
}

// --- reading

void Session::read() {
    if (reading_ || dropped_ || closing_) return;
    if (unhandled_bytes_ >= kMaxUnhandled || unhandled_requests_ >= kMaxRequests ||
        answer_bytes_ >= kMaxAnswers)
        return;
    reading_ = true;
    socket_.async_read(incoming_, [self = shared_from_this()](beast::error_code error, std::size_t) {
        self->reading_ = false;
        if (error) return self->drop(reason_of(error));
        if (!self->closing_) {
            ++self->hub_.metrics->messages_received;
            self->hub_.metrics->bytes_received += self->incoming_.size();
            if (self->socket_.got_text()) {
                const auto data = self->incoming_.data();
                self->on_text({static_cast<const char*>(data.data()), data.size()});
            } else {
                self->refuse_and_close(
                    {{}, protocol::error_code::bad_message, "clients send no binary messages"},
                    close_code::unknown_data);
            }
            self->incoming_.consume(self->incoming_.size());
        }
        self->read();
    });
}

void Session::on_text(std::string_view text) {
    if (text.size() > protocol::kMaxMessageBytes)
        return refuse_and_close(
            {{},
             protocol::error_code::bad_message,
             "the message is longer than " + std::to_string(protocol::kMaxMessageBytes) + " bytes"},
            close_code::too_big);
    auto message = protocol::decode(text);
    const auto* hello = message ? std::get_if<protocol::Hello>(&message->payload) : nullptr;
    if (client_.empty() && !hello) {
        if (message)
            message = tl::unexpected(protocol::Error{message->id, protocol::error_code::bad_message,
                                                     "the first message must be 'hello'"});
        return refuse_and_close(message.error(), close_code::policy_error);
    }
    if (hello && !client_.empty())
        return refuse_and_close(
            {message->id, protocol::error_code::bad_message, "'hello' came a second time"},
            close_code::policy_error);
    if (hello) return on_hello(*hello, message->id);
    ClientSaid said{client_, std::move(message), Clock::now(), text.size(), role_ == protocol::Role::control};
    unhandled_bytes_ += said.bytes;
    unhandled_requests_ += said.is_request();
    hub_.engine->mailbox().push(std::move(said));
}

void Session::on_hello(const protocol::Hello& hello, std::optional<std::int64_t> id) {
    const std::optional<protocol::Role> role = hub_.access.role_for(hello.role, hello.token);
    if (!role)
        return refuse_and_close({id, protocol::error_code::not_allowed,
                                 hello.token.empty() ? "this server asks for a token" : "the token is wrong"},
                                close_code::policy_error);
    if (hub_.sessions.size() >= hub_.max_clients)
        return refuse_and_close(
            {id, protocol::error_code::too_many,
             "the server has its " + std::to_string(hub_.max_clients) + " clients already"},
            close_code::try_again_later);
    if (hub_.stopping) return;  // the close is on its way
    hello_deadline_.cancel();
    role_ = *role;
    client_ = "c" + std::to_string(hub_.next_client++);
    hub_.sessions[client_] = shared_from_this();
    if (!hub_.loads) loading_ = hub_.loading;  // is no news any more
    ++hub_.metrics->clients_joined;
    ++hub_.metrics->clients[name_of(*role)];
    log_info("joined",
             {{"client", client_}, {"role", name_of(*role)}, {"name", hello.name}, {"peer", peer_}});
    hub_.engine->mailbox().push(ClientJoined{client_, *role, hello.name, id.value_or(0)});

    protocol::Welcome welcome;
    welcome.id = id;
    welcome.server = VRUT_VERSION;
    welcome.client = client_;
    welcome.role = *role;
    welcome.limits.max_pixels = hub_.engine->limits().max_pixels;
    welcome.limits.messages_per_second = 10'000;
    welcome.limits.max_server_message = std::size_t{64} << 20;
    answer({client_, protocol::encode(welcome), 0});
}

void Session::refuse_and_close(const protocol::Error& error, close_code code) {
    ++hub_.metrics->errors[error.code];
    log_info("refused",
             {{"client", client_}, {"peer", peer_}, {"code", error.code}, {"reason", error.message}});
    if (!closing_) close_reason_ = reason_of(error, code);
    answer({client_, protocol::encode(error), 0, error.message});
    close(code, error.message);
}

// --- what there is to send

void Session::answer(Answer answer) {
    answer_bytes_ += answer.text.size();
    answers_.push_back(std::move(answer));
    pump();
}

void Session::owe(std::int64_t frame) {
    if (frame <= last_frame_) {
        // A newer one went out meanwhile: the grant is for what comes next.
        hub_.engine->mailbox().push(FrameSent{client_, last_frame_, 1});
        return;
    }
    owed_.push_back(frame);
    pump();
}

void Session::take_snapshot(std::shared_ptr<const EncodedPicture> picture) {
    snapshots_.push_back(std::move(picture));
    pump();
}

void Session::handled(const EngineOutput::Handled& handled) {
    unhandled_bytes_ -= std::min(handled.bytes, unhandled_bytes_);
    unhandled_requests_ -= std::min(handled.requests, unhandled_requests_);
    read();
}

void Session::newest_changed(std::int64_t before) {
    const bool waited = !owed_.empty() && writing_ && before >= owed_.front() && before > last_frame_;
    if (waited) ++hub_.metrics->frames_replaced;
    pump();
}

bool Session::frame_is_due() const {
    return !owed_.empty() && hub_.newest && hub_.newest->header.frame >= owed_.front();
}

void Session::pump() {
    if (writing_ || dropped_) return;
    const std::int64_t known = document_ ? document_->revision() : 0;
    if (closing_) {
        if (!answers_.empty()) return send_answer();
        writing_ = true;  // nothing goes out behind the close
        return socket_.async_close(*closing_,
                                   [self = shared_from_this()](beast::error_code) { self->drop("gone"); });
    }
    // A frame or answer goes when the client knows the revision that it speaks of.
    if (frame_is_due() && known >= hub_.newest->header.revision) return send_frame();
    if (!answers_.empty() && known >= answers_.front().revision) return send_answer();
    if (!snapshots_.empty() && known >= snapshots_.front()->header.revision) return send_snapshot();
    if (client_.empty() || !hub_.document) return;
    if (document_ == hub_.document) return send_news();
    const auto before = std::exchange(document_, hub_.document);
    if (!before || !document_->has_scene_of(*before)) return send_text(document_->encode());
    const bool one_author = before->revision() + 1 >= hub_.document_by_since;
    send_text(document_->encode_patch_from(*before, one_author ? hub_.document_by : ""));
}

/// What is told to all, and of which only the newest counts.
void Session::send_news() {
    for (const auto& [newest, sent] : {std::pair(&hub_.loading, &loading_), std::pair(&hub_.stats, &stats_)})
        if (*newest != *sent) {
            *sent = *newest;
            return send_text(**sent);
        }
}

void Session::send_answer() {
    std::string text = std::move(answers_.front().text);
    answers_.pop_front();
    answer_bytes_ -= text.size();
    send_text(std::move(text));
}

void Session::send_frame() {
    picture_ = hub_.newest;
    last_frame_ = picture_->header.frame;
    int grants = 0;
    for (; !owed_.empty() && owed_.front() <= last_frame_; owed_.pop_front()) ++grants;
    // One frame answers one grant; the others are for what comes next.
    hub_.engine->mailbox().push(FrameSent{client_, last_frame_, grants - 1, picture_->header.timing.encode_ms,
                                          picture_->newest_input});

    protocol::FrameHeader header = picture_->header;
    const auto handled = picture_->handled.find(client_);
    // A snapshot may have told of more.
    if (handled != picture_->handled.end()) handled_ = std::max(handled_, handled->second);
    header.handled = handled_;
    if (picture_->newest_input)
        header.timing.since_input_ms =
            std::chrono::duration<double, std::milli>(Clock::now() - *picture_->newest_input).count();
    if (picture_->newest_input > shown_input_) {
        shown_input_ = *picture_->newest_input;
        hub_.metrics->input_to_frame.observe(*header.timing.since_input_ms / 1000);
    }
    ++hub_.metrics->frames_sent;
    log_debug("frame_sent", {{"client", client_},
                             {"frame", last_frame_},
                             {"bytes", picture_->file.size()},
                             {"ms", header.timing.since_input_ms.value_or(0)}});
    send_picture(header);
}

void Session::send_snapshot() {
    picture_ = std::move(snapshots_.front());
    snapshots_.pop_front();
    ++hub_.metrics->snapshots_sent;
    hub_.engine->mailbox().push(SnapshotSent{client_});
    protocol::FrameHeader header = picture_->header;
    header.handled = handled_ = std::max(handled_, header.handled);
    send_picture(header);
}

void Session::send_picture(const protocol::FrameHeader& header) {
    header_ = header_of_file(*picture_, header);
    const auto& file = picture_->file;
    const std::size_t cut = picture_->header_offset;
    socket_.binary(true);
    write(std::array<boost::asio::const_buffer, 3>{
        boost::asio::buffer(file.data(), cut), boost::asio::buffer(header_),
        boost::asio::buffer(file.data() + cut, file.size() - cut)});
}

void Session::send_text(std::string text) {
    text_ = std::move(text);
    socket_.text(true);
    write(boost::asio::buffer(text_));
}

template <class Buffers>
void Session::write(const Buffers& buffers) {
    writing_ = true;
    hub_.metrics->bytes_sent += boost::asio::buffer_size(buffers);
    if (!watching_) {
        watching_ = true;
        progress_at_ = Clock::now();
        watch_progress();
    }
    socket_.async_write(buffers, [self = shared_from_this()](beast::error_code error, std::size_t) {
        self->on_written(error);
    });
}

void Session::on_written(beast::error_code error) {
    writing_ = false;
    picture_.reset();
    if (error) return drop("gone");
    pump();
    read();
}

/// Cuts the connection when the peer has something to take and has acknowledged nothing for kStuck. Runs only
/// while there is something.
void Session::watch_progress() {
    write_watch_.expires_after(1s);
    write_watch_.async_wait([weak = weak_from_this()](beast::error_code stopped) {
        const auto self = weak.lock();
        if (stopped || !self || self->dropped_) return;
        const int socket = beast::get_lowest_layer(self->socket_).socket().native_handle();
        if (!self->writing_ && bytes_unacknowledged(socket) == 0) {
            self->watching_ = false;
            return;
        }
        const std::uint64_t acknowledged = bytes_acknowledged(socket);
        if (std::exchange(self->acknowledged_, acknowledged) != acknowledged)
            self->progress_at_ = Clock::now();
        if (Clock::now() - self->progress_at_ < kStuck) return self->watch_progress();
        self->drop("stuck");
    });
}

// --- the end

void Session::close(close_code code, const std::string& reason) {
    if (closing_ || dropped_) return;
    // A close frame holds 123 bytes of reason at most, and whole characters.
    std::size_t length = std::min<std::size_t>(reason.size(), 123);
    while (length < reason.size() && (static_cast<unsigned char>(reason[length]) & 0xC0) == 0x80) --length;
    closing_.emplace(code, reason.substr(0, length));
    hello_deadline_.cancel();
    pump();
}

void Session::drop(const char* reason) {
    if (std::exchange(dropped_, true)) return;
    reason = closing_ ? close_reason_ : reason;
    ++hub_.metrics->closes[reason];
    hello_deadline_.cancel();
    write_watch_.cancel();
    beast::get_lowest_layer(socket_).close();
    if (client_.empty()) return;
    log_info("left", {{"client", client_}, {"peer", peer_}, {"reason", reason}});
    ++hub_.metrics->clients_left;
    --hub_.metrics->clients[name_of(role_)];
    hub_.engine->mailbox().push(ClientLeft{client_});
    hub_.sessions.erase(client_);
}

}  // namespace vrut
