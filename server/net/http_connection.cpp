#include "net/http_connection.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <charconv>
#include <memory>
#include <optional>

#include "codec.hpp"
#include "net/addresses.hpp"
#include "net/connection.hpp"
#include "net/http_request.hpp"
#include "net/http_response.hpp"
#include "net/monitoring.hpp"
#include "net/page_response.hpp"
#include "net/report_drawing.hpp"
#include "observe/log.hpp"
#include "room_relay.hpp"

namespace vrut::server::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using namespace std::chrono_literals;

namespace {

constexpr std::string_view kRooms = "/rooms/";
constexpr auto kForEnd = 1s;  // for the peer to take the last answer and to close, too

std::string_view path_of(const HttpRequest& request) {
    const std::string_view target = view(request.target());
    return target.substr(0, target.find('?'));
}

/// What a request is for.
struct Address {
    std::optional<std::string> room;  ///< whose name may be empty; none: it is for the server itself
    std::string_view path;            ///< within that
};

Address address_of(const HttpRequest& request, const ConnectionRegistry& registry) {
    std::string_view path = path_of(request);
    if (!registry.has_rooms()) return {{}, path};
    if (!registry.open_room) return {"", path};
    if (!path.starts_with(kRooms)) return {{}, path};
    const std::string_view rest = path.substr(kRooms.size());
    const std::string_view name = rest.substr(0, rest.find('/'));
    if (name.size() == rest.size() || !protocol::is_room_name(name)) return {{}, path};
    return {std::string(name), rest.substr(name.size())};
}

/// Null where it cannot be had.
std::shared_ptr<ServedRoom> find_room(const std::string& name, ConnectionRegistry& registry) {
    if (const auto found = registry.rooms.find(name); found != registry.rooms.end()) return found->second;
    return registry.open_room ? registry.open_room(name) : nullptr;
}

std::string token_of(const HttpRequest& request) {
    constexpr std::string_view kScheme = "Bearer ";
    const std::string_view header = view(request[http::field::authorization]);
    return std::string(header.starts_with(kScheme) ? header.substr(kScheme.size()) : "");
}

bool has_token(const HttpRequest& request, const ConnectionRegistry& registry) {
    return registry.access.role_for(protocol::Role::view, token_of(request)).has_value();
}

HttpResponse needs_token() {
    return rejection(http::status::unauthorized,
                     "this address needs a token: send it as 'Authorization: Bearer TOKEN'");
}

HttpResponse no_room() {
    return rejection(http::status::service_unavailable,
                     "too many rooms are open here: try again later, or at another server");
}

/// Subprotocols are a comma-separated list; a client that offers none gets version 1.
bool speaks_our_subprotocol(const HttpRequest& request) {
    if (request.find(http::field::sec_websocket_protocol) == request.end()) return true;
    std::string_view list = view(request[http::field::sec_websocket_protocol]);
    while (!list.empty()) {
        const std::size_t comma = std::min(list.find(','), list.size());
        std::string_view offer = list.substr(0, comma);
        while (offer.starts_with(' ') || offer.starts_with('\t')) offer.remove_prefix(1);
        while (offer.ends_with(' ') || offer.ends_with('\t')) offer.remove_suffix(1);
        if (offer == protocol::kSubprotocol) return true;
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return false;
}

/// A whole number of the query, 0 where it is not there; none where it is something else.
std::optional<std::int64_t> query_number(const HttpRequest& request, std::string_view name) {
    std::string_view target = view(request.target());
    target.remove_prefix(std::min(target.find('?'), target.size()));
    while (!target.empty()) {
        target.remove_prefix(1);  // ? or &
        const std::string_view pair = target.substr(0, target.find('&'));
        target.remove_prefix(pair.size());
        if (pair.substr(0, pair.find('=')) != name) continue;
        const std::string_view value = pair.substr(std::min(pair.find('=') + 1, pair.size()));
        std::int64_t number = 0;
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
        constexpr std::int64_t kLargest = 1 << 20;
        if (error != std::errc() || end != value.data() + value.size() || number < 1 || number > kLargest)
            return std::nullopt;
        return number;
    }
    return 0;
}

/// Why nothing at all is served to whoever sends this request.
std::optional<HttpResponse> turned_away(const HttpRequest& request, const Access& access) {
    const std::string_view host = view(request[http::field::host]);
    if (!access.accepts_host(host))
        return rejection(http::status::forbidden,
                         "this server answers to localhost only: open it by that name, "
                         "or start it with --token-file");
    const auto origin = request.find(http::field::origin);
    if (origin != request.end() && !access.accepts_origin(view(origin->value()), host)) {
        observe::log_info("origin_refused", {{"origin", view(origin->value())}, {"host", host}});
        return rejection(http::status::forbidden,
                         "pages of this origin may not connect: allow it with --allow-origin");
    }
    return std::nullopt;
}

/// How to trust the certificates of a server with an authority of its own, and that authority's.
std::optional<HttpResponse> trust_response(const HttpRequest& request, std::string_view path,
                                           const ConnectionRegistry& registry) {
    const CertificateAuthority* const authority = registry.tls ? registry.tls->authority() : nullptr;
    if (authority && path == "/trust") return page_response(request, "/trust.html");
    if (authority && path == "/authority.crt")
        return HttpResponse{http::status::ok, "application/x-x509-ca-cert",
                            std::make_shared<const std::string>(authority->certificate())};
    return std::nullopt;
}

HttpResponse state_response(const std::optional<std::string>& fault, const char* good) {
    return fault ? rejection(http::status::service_unavailable, *fault)
                 : text_response(http::status::ok, good);
}

/// Of the server, or of a room, which is opened: for a moment it is not ready.
HttpResponse readiness(const std::optional<std::string>& name, ConnectionRegistry& registry) {
    auto why = why_unready(registry);
    if (!why && name) {
        const auto room = find_room(*name, registry);
        if (!room) return no_room();
        why = why_unready(*room);
    }
    return state_response(why, "ready\n");
}

HttpResponse respond(const HttpRequest& request, ConnectionRegistry& registry) {
    const auto [room, path] = address_of(request, registry);
    if (room || (registry.has_rooms() && path != "/" && path != "/index.html"))
        if (auto file = page_response(request, path)) return *std::move(file);
    if (auto page = trust_response(request, path, registry)) return *std::move(page);
    if (room && path == "/ws")
        return rejection(http::status::upgrade_required,
                         "this address is for WebSockets of version 13: send their handshake");
    if (path == "/healthz") return state_response(why_unhealthy(registry), "ok\n");
    if (path == "/readyz" || path == "/metrics" || path == "/protocol.schema.json") {
        if (!has_token(request, registry)) return needs_token();
        if (path == "/protocol.schema.json") {
            static const auto schema = std::make_shared<const std::string>(protocol::json_schema());
            return {http::status::ok, "application/schema+json", schema};
        }
        if (path == "/readyz") return readiness(room, registry);
        return {http::status::ok, "text/plain; version=0.0.4; charset=utf-8",
                std::make_shared<const std::string>(metrics_text(registry))};
    }
    if (!registry.has_rooms())
        return rejection(http::status::not_found,
                         "there is nothing at this address: how this worker is, is at /metrics");
    if (!room && path.starts_with(kRooms) && protocol::is_room_name(path.substr(kRooms.size()))) {
        HttpResponse response = rejection(http::status::permanent_redirect, "a room's address ends with /");
        response.fields = "Location: " + std::string(path) + "/\r\n";
        return response;
    }
    return rejection(http::status::not_found,
                     !room ? "there is nothing at this address: rooms are at /rooms/NAME/"
                           : "there is nothing at this address: the page is at /");
}

/// What is served to who comes without TLS where there is TLS, and not from this machine: how to trust the
/// server's certificates, and what that page needs. Else the same address of HTTPS.
HttpResponse respond_insecurely(const HttpRequest& request, const ConnectionRegistry& registry) {
    const std::string_view path = path_of(request);
    if (path != "/" && path != "/index.html")
        if (auto file = page_response(request, path)) return *std::move(file);
    if (auto page = trust_response(request, path, registry)) return *std::move(page);
    const std::string_view host = view(request[http::field::host]);
    HttpResponse response =
        rejection(http::status::permanent_redirect, "this server speaks HTTPS with other devices");
    response.fields = "Location: https://" + std::string(host) + std::string(view(request.target())) + "\r\n";
    return response;
}

/// One connection. A request is answered before the next is read, and none that cannot be trusted is followed
/// by another.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
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
        if (auto response = turned_away(request, registry_.access)) return send(*std::move(response));
        if (is_insecure_) return send(respond_insecurely(request, registry_));
        const auto [room, path] = address_of(request, registry_);
        if (room && path == "/ws" && beast::websocket::is_upgrade(request) &&
            view(request[http::field::sec_websocket_version]) == "13")
            return open_websocket(request, *room);
        if (room && path == "/frame.jpg") return admit(request, *room, &HttpConnection::send_picture);
        if (room && path == "/report.html") return admit(request, *room, &HttpConnection::send_report);
        if (room && path == "/report.csv") return admit(request, *room, &HttpConnection::send_table);
        send(respond(request, registry_));
    }

    /// `answer` gets the request of who may see the room.
    void admit(const HttpRequest& request, const std::string& name,
               void (HttpConnection::*answer)(const HttpRequest&)) {
        room_ = find_room(name, registry_);
        if (!room_) return send(no_room());
        deadline_ = base::Clock::time_point::max();  // the room's server has one of its own
        room_->admit({{}, protocol::Role::view, token_of(request)},
                     [self = shared_from_this(), answer, kept = std::make_shared<const HttpRequest>(request)](
                         const tl::expected<protocol::Role, protocol::Error>& role) {
                         if (role) return (*self.*answer)(*kept);
                         if (role.error().code == protocol::error_code::not_allowed)
                             return self->send(needs_token());
                         self->send(rejection(http::status::service_unavailable, role.error().message));
                     });
    }

    /// The present view, in the size asked for or the view's own.
    void send_picture(const HttpRequest& request) {
        const engine::PictureLimits limits = room_->engine->limits();
        const auto width = query_number(request, "width"), height = query_number(request, "height");
        if (!width || !height || (*width == 0) != (*height == 0) || !engine::fits(*width, *height, limits))
            return send(
                rejection(http::status::bad_request,
                          "'width' and 'height' must be given together, as numbers from 1, of at most " +
                              std::to_string(limits.max_pixels) + " pixels"));
        ViewPictureKey key{room_->document.newest() ? room_->document.newest()->revision() : 0, room_->size,
                           room_->size};
        if (*width > 0) key.size = {static_cast<int>(*width), static_cast<int>(*height)};
        const std::string tag = room_->pictures.tag(key);
        if (room_->document.newest() && names_tag(view(request[http::field::if_none_match]), tag))
            return send({http::status::not_modified, "image/jpeg", nullptr, "ETag: " + tag + "\r\n"});
        if (const ViewPicture* kept = room_->pictures.find(key)) return send_file(*kept);
        if (head_only_)
            return send({http::status::ok, "image/jpeg", nullptr,
                         room_->document.newest() ? "ETag: " + tag + "\r\n" : std::string{}});
        deadline_ = base::Clock::time_point::max();  // it takes as long as it takes
        const bool asked = room_->pictures.ask(
            key,
            [self = shared_from_this()](const ViewPicture* picture) {
                if (picture) return self->send_file(*picture);
                self->send(rejection(http::status::service_unavailable,
                                     "this image cannot be drawn: the log says why"));
            },
            *room_->engine, room_->suffix);
        if (!asked)
            send(rejection(http::status::service_unavailable,
                           "too many images are being drawn: try again later"));
    }

    void send_file(const ViewPicture& picture) {
        send({http::status::ok, "image/jpeg", picture.file,
              "ETag: " + room_->pictures.tag(picture.key) + "\r\n"});
    }

    // --- reports

    static constexpr std::size_t kMostReports = 2, kMostReportsSent = 8;

    /// What a report has of the state; none: the request is rejected.
    std::optional<protocol::ReportedState> reported() {
        const auto document = room_->document.newest();
        if (!document) {
            send(rejection(http::status::service_unavailable, "there is no scene yet: try again later"));
            return std::nullopt;
        }
        auto state = protocol::reported_state(*document);
        if (state) return *std::move(state);
        observe::log_warning("report_failed", {{"reason", state.error().message}});
        send(rejection(http::status::service_unavailable,
                       "there is no report of this scene: the log says why"));
        return std::nullopt;
    }

    /// Browsers keep it as a file: texts of users are no page of this server.
    static HttpResponse file_response(std::string_view content_type, const char* name) {
        HttpResponse response{http::status::ok, content_type};
        response.fields = "Content-Disposition: attachment; filename=\"" + std::string(name) + "\"\r\n";
        response.cache_control = "no-store";
        return response;
    }

    void send_table(const HttpRequest&) {
        const auto state = reported();
        if (!state) return;
        HttpResponse response = file_response("text/csv; charset=utf-8", "report.csv");
        response.body = std::make_shared<const std::string>(report::csv(*state));
        send(std::move(response));
    }

    void send_report(const HttpRequest&) {
        if (registry_.reports >= kMostReports || registry_.reports_sent >= kMostReportsSent)
            return send(rejection(http::status::service_unavailable,
                                  "too many reports are being made: try again later"));
        auto state = reported();
        if (!state) return;
        HttpResponse response = file_response("text/html; charset=utf-8", "report.html");
        if (head_only_) return send(std::move(response));
        deadline_ = base::Clock::time_point::max();  // it takes as long as it takes
        draw_report(
            *std::move(state), room_, registry_.reports,
            [self = shared_from_this()] { return !self->is_gone(); },
            [self = shared_from_this(),
             response = std::move(response)](std::optional<std::string> html) mutable {
                if (!html)
                    return self->send(rejection(http::status::service_unavailable,
                                                "another scene is shown meanwhile: try again"));
                response.body = self->counted(*std::move(html));
                self->send(std::move(response));
            });
    }

    /// Counts as being sent as long as it is kept.
    std::shared_ptr<const std::string> counted(std::string html) {
        ++registry_.reports_sent;
        return {new std::string(std::move(html)), [&registry = registry_](const std::string* text) {
                    --registry.reports_sent;
                    delete text;
                }};
    }

    /// The peer has closed, or the server stops.
    bool is_gone() {
        pollfd peer{tcp().native_handle(), POLLRDHUP, 0};
        return registry_.stopping || ::poll(&peer, 1, 0) != 0;
    }

    void open_websocket(const HttpRequest& request, const std::string& name) {
        if (!speaks_our_subprotocol(request))
            return send(
                rejection(http::status::bad_request, "'Sec-WebSocket-Protocol' must hold vrut-preview.v1"));
        if (incoming_.size() > 0) {
            keep_alive_ = false;
            return send(
                rejection(http::status::bad_request, "nothing may follow a handshake before its answer"));
        }
        if (registry_.stopping) return;
        auto room = find_room(name, registry_);
        if (!room) return send(no_room());
        deadline_timer_.cancel();
        std::make_shared<Connection>(std::move(socket_), std::move(place_), registry_, std::move(room))
            ->accept(request);
    }

    // --- writing

    void send(HttpResponse response) {
        keep_alive_ = keep_alive_ && !registry_.stopping;
        head_ = head_of(response, host_, keep_alive_);
        body_ = head_only_ ? nullptr : std::move(response.body);
        head_only_ = false;
        expire_after(registry_.deadlines.answer + time_for(body_ ? body_->size() : 0));
        const std::array<asio::const_buffer, 2> buffers{asio::buffer(head_),
                                                        body_ ? asio::buffer(*body_) : asio::const_buffer()};
        asio::async_write(
            socket_, buffers, [self = shared_from_this()](beast::error_code error, std::size_t) {
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
    std::shared_ptr<ServedRoom> room_;  // of the image that is asked for
    beast::flat_buffer incoming_{kMaxRequest};
    bool keep_alive_ = false, head_only_ = false, answered_ = false, is_insecure_ = false;
    std::string host_, head_;
    std::shared_ptr<const std::string> body_;
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
