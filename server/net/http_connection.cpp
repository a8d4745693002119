#include "net/http_connection.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <memory>
#include <optional>

#include "net/addresses.hpp"
#include "net/connection.hpp"
#include "net/http_routes.hpp"
#include "observe/log.hpp"

namespace vrut::server::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using namespace std::chrono_literals;

namespace {

constexpr auto kForEnd = 1s;  // for the peer to take the last answer and to close, too

/// One connection. A request is answered before the next is read, and none that cannot be trusted is followed
/// by another.
class HttpConnection : public Exchange, public std::enable_shared_from_this<HttpConnection> {
public:
    HttpConnection(Transport socket, ConnectionLimit::Place place, ConnectionRegistry& registry)
        : socket_(std::move(socket)),
          place_(std::move(place)),
          deadline_timer_(socket_.get_executor()),
          registry_(registry) {}

    void start() {
        beast::error_code ignored;
        tcp().set_option(asio::ip::tcp::no_delay(true), ignored);
        expire_after(registry_.deadlines.request);
        poll_deadline();
        if (registry_.tls) return wait_for_first_byte();
        read();
    }

private:
    asio::ip::tcp::socket& tcp() { return socket_.next_layer().socket(); }

    // --- TLS or not

    void wait_for_first_byte() {
        tcp().async_wait(asio::ip::tcp::socket::wait_read,
                         [self = shared_from_this()](beast::error_code error) {
                             if (!error) self->look_at_first_byte();
                         });
    }

    void look_at_first_byte() {
        constexpr unsigned char kHandshake = 22;  // RFC 8446, 5.1
        unsigned char first = 0;
        if (::recv(tcp().native_handle(), &first, 1, MSG_PEEK | MSG_DONTWAIT) != 1) return;
        beast::error_code gone;
        const auto local = tcp().local_endpoint(gone).address();
        const auto peer = tcp().remote_endpoint(gone).address();
        if (gone) return;
        if (first != kHandshake) {
            is_insecure_ = !is_loopback(peer);
            return read();
        }
        socket_.async_secure(registry_.tls->context_for(local),
                             [self = shared_from_this()](beast::error_code error) {
                                 if (!error) return self->read();
                                 ++self->registry_.metrics->tls_handshakes_failed;
                                 observe::log_info("tls_failed", {{"reason", error.message()}});
                             });
    }

    // --- reading

    void next() {
        if (!answer_buffered()) read();
    }

    /// What came behind a request is looked at when that is answered.
    bool answer_buffered() {
        const auto bytes = incoming_.data();
        auto read = read_request({static_cast<const char*>(bytes.data()), bytes.size()});
        if (!read) return false;
        if (*read) {
            incoming_.consume((*read)->size);
            on_request((*read)->request);
        } else {
            keep_alive_ = false;
            host_.clear();
            send(rejection(read->error().status, read->error().sentence));
        }
        return true;
    }

    void read() {
        constexpr std::size_t kAtOnce = 2048;
        const auto room = incoming_.prepare(std::min(kAtOnce, kMaxRequest - incoming_.size()));
        socket_.async_read_some(room, [self = shared_from_this()](beast::error_code error, std::size_t size) {
            if (error) return;
            if (self->answered_ && self->incoming_.size() == 0)
                self->expire_after(self->registry_.deadlines.request);
            self->incoming_.commit(size);
            self->next();
        });
    }

    void on_request(const HttpRequest& request) {
        keep_alive_ = request.keep_alive() && request.version() == 11;
        head_only_ = request.method() == http::verb::head;
        host_ = std::string(view(request[http::field::host]));
        answer(request, is_insecure_, shared_from_this(), registry_);
    }

    // --- as an exchange

    void wait() override { deadline_ = base::Clock::time_point::max(); }

    bool is_gone() override {
        pollfd peer{tcp().native_handle(), POLLRDHUP, 0};
        return registry_.stopping || ::poll(&peer, 1, 0) != 0;
    }

    void open_websocket(const HttpRequest& request, std::shared_ptr<ServedRoom> room) override {
        if (incoming_.size() > 0) {
            keep_alive_ = false;
            return send(
                rejection(http::status::bad_request, "nothing may follow a handshake before its answer"));
        }
        if (registry_.stopping) return;
        deadline_timer_.cancel();
        std::make_shared<Connection>(std::move(socket_), std::move(place_), registry_, std::move(room))
            ->accept(request);
    }

    // --- writing

    void send(HttpResponse response) override {
        keep_alive_ = keep_alive_ && !registry_.stopping;
        head_ = head_of(response, host_, keep_alive_);
        body_ = head_only_ ? nullptr : std::move(response.body);
        head_only_ = false;
        if (body_)
            sending_ = registry_.bodies_sent.add(body_, [weak = weak_from_this()] {
                if (const auto self = weak.lock()) self->socket_.next_layer().close();
            });
        expire_after(registry_.deadlines.answer + time_for(body_ ? body_->size() : 0));
        const std::array<asio::const_buffer, 2> buffers{asio::buffer(head_),
                                                        body_ ? asio::buffer(*body_) : asio::const_buffer()};
        asio::async_write(
            socket_, buffers, [self = shared_from_this()](beast::error_code error, std::size_t) {
                self->sending_.reset();
                self->body_.reset();
                if (error) return;
                self->expire_after(self->keep_alive_ ? self->registry_.deadlines.request : kForEnd);
                self->answered_ = true;
                if (self->keep_alive_) return self->next();
                self->socket_.async_end_sending([self] { self->drain(); });
            });
    }

    /// Closing with bytes unread would take the last answer away from the peer.
    void drain() {
        incoming_.clear();
        tcp().async_read_some(incoming_.prepare(kMaxRequest),
                              [self = shared_from_this()](beast::error_code error, std::size_t) {
                                  if (!error) self->drain();
                              });
    }

    // --- deadlines

    /// What a large answer takes beyond what any may.
    static base::Clock::duration time_for(std::size_t bytes) {
        constexpr std::size_t kAtOnce = std::size_t{1} << 20, kBytesPerMs = 100;
        return std::chrono::milliseconds((std::max(bytes, kAtOnce) - kAtOnce) / kBytesPerMs);
    }

    void expire_after(base::Clock::duration time) { deadline_ = base::Clock::now() + time; }

    /// Looks after the deadline when one that was set earlier would have passed: setting one costs nothing.
    void poll_deadline() {
        deadline_timer_.expires_at(std::min(deadline_, base::Clock::now() + kForEnd));
        deadline_timer_.async_wait([weak = weak_from_this()](beast::error_code stopped) {
            const auto self = weak.lock();
            if (stopped || !self) return;
            if (base::Clock::now() < self->deadline_) return self->poll_deadline();
            self->socket_.next_layer().close();
        });
    }

    Transport socket_;
    ConnectionLimit::Place place_;
    asio::steady_timer deadline_timer_;
    base::Clock::time_point deadline_;
    ConnectionRegistry& registry_;
    beast::flat_buffer incoming_{kMaxRequest};
    bool keep_alive_ = false, head_only_ = false, answered_ = false, is_insecure_ = false;
    std::string host_, head_;
    std::shared_ptr<const std::string> body_;
    BodiesSent::Sending sending_;  // the body
};

}  // namespace

void serve_http(asio::ip::tcp::socket socket, ConnectionLimit::Place place, ConnectionRegistry& registry) {
    std::make_shared<HttpConnection>(Transport(std::move(socket)), std::move(place), registry)->start();
}

void reject_connection(asio::ip::tcp::socket socket) {
    const HttpResponse response = rejection(http::status::service_unavailable,
                                            "there are too many connections: close some, or try again later");
    const std::string text = head_of(response, {}, false) + *response.body;
    beast::error_code ignored;  // what fits at once has to do
    socket.non_blocking(true, ignored);
    socket.write_some(asio::buffer(text), ignored);
    socket.shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
    std::array<char, kMaxRequest> unread{};  // or closing would take the answer away
    socket.read_some(asio::buffer(unread), ignored);
}

}  // namespace vrut::server::net
