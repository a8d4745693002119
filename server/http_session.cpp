#include "http_session.hpp"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <charconv>
#include <memory>
#include <optional>

#include "codec.hpp"
#include "log.hpp"
#include "monitoring.hpp"
#include "page_files.hpp"
#include "session.hpp"

namespace vrut {

namespace beast = boost::beast;
namespace http = beast::http;
using namespace std::chrono_literals;

namespace {

using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

constexpr auto kDeadline = 5s;  // for a request to come in, and for its answer to go out
constexpr std::uint32_t kMaxHeader = 8 * 1024;
constexpr std::uint64_t kMaxBody = 1024;

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

std::string_view path_of(const Request& request) {
    const std::string_view target = view(request.target());
    return target.substr(0, target.find('?'));
}

Response make_response(const Request& request, http::status status, std::string_view content_type,
                       std::string body) {
    Response response(status, request.version());
    response.set(http::field::content_type, beast::string_view(content_type.data(), content_type.size()));
    response.set(http::field::cache_control, "no-cache");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set(
        "Content-Security-Policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
        "manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    response.keep_alive(request.keep_alive());
    response.body() = std::move(body);
    response.prepare_payload();
    if (request.method() == http::verb::head) response.body().clear();  // its length stays said
    return response;
}

Response refuse(const Request& request, http::status status, const std::string& sentence) {
    return make_response(request, status, "text/plain; charset=utf-8", sentence + "\n");
}

bool has_token(const Request& request, const Hub& hub) {
    constexpr std::string_view kScheme = "Bearer ";
    const std::string_view header = view(request[http::field::authorization]);
    const std::string_view token = header.starts_with(kScheme) ? header.substr(kScheme.size()) : "";
    return hub.access.role_for(protocol::Role::view, token).has_value();
}

/// Subprotocols are a comma-separated list; a client that offers none gets version 1.
bool speaks_our_subprotocol(const Request& request) {
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
std::optional<std::int64_t> query_number(const Request& request, std::string_view name) {
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

Response respond(const Request& request, const Hub& hub) {
    const std::string_view path = path_of(request);
    if (!hub.access.accepts_host(view(request[http::field::host])))
        return refuse(request, http::status::forbidden, "this server is to be reached as localhost");
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
        Response response =
            refuse(request, http::status::method_not_allowed, "only GET and HEAD are answered");
        response.set(http::field::allow, "GET, HEAD");
        return response;
    }
    for (const PageFile& file : page_files())
        if (path == file.path || (path == "/" && file.path == "/index.html"))
            return make_response(request, http::status::ok, file.content_type, std::string(file.bytes));
    const auto text = [&](const std::string& body) {
        return make_response(request, http::status::ok, "text/plain; charset=utf-8", body);
    };
    const auto state = [&](const std::optional<std::string>& fault, const char* good) {
        return fault ? refuse(request, http::status::service_unavailable, *fault) : text(good);
    };
    if (path == "/healthz") return state(why_unhealthy(hub), "ok\n");
    if (path == "/readyz" || path == "/metrics" || path == "/protocol.schema.json" || path == "/frame.jpg") {
        if (!has_token(request, hub)) {
            Response response = refuse(request, http::status::unauthorized, "this route asks for a token");
            response.set(http::field::www_authenticate, "Bearer");
            return response;
        }
        if (path == "/protocol.schema.json")
            return make_response(request, http::status::ok, "application/schema+json",
                                 protocol::json_schema());
        if (path == "/frame.jpg") return text({});  // the session's, who can wait for it
        if (path == "/readyz") return state(why_unready(hub), "ready\n");
        return make_response(request, http::status::ok, "text/plain; version=0.0.4; charset=utf-8",
                             metrics_text(hub));
    }
    return refuse(request, http::status::not_found, "there is nothing at this address");
}

class HttpSession : public std::enable_shared_from_this<HttpSession> {
public:
    HttpSession(boost::asio::ip::tcp::socket socket, Hub& hub) : stream_(std::move(socket)), hub_(hub) {}

    void read() {
        parser_.emplace();
        parser_->header_limit(kMaxHeader);
        parser_->body_limit(kMaxBody);
        stream_.expires_after(kDeadline);
        http::async_read(stream_, buffer_, *parser_,
                         [self = shared_from_this()](beast::error_code error, std::size_t) {
                             if (!error) return self->on_request();
                             if (error.category() == make_error_code(http::error::bad_method).category())
                                 self->on_bad_request(error);
                         });
    }

private:
    void on_bad_request(beast::error_code error) {
        if (error == http::error::end_of_stream || error == http::error::partial_message) return;
        const http::status status = error == http::error::header_limit
                                        ? http::status::request_header_fields_too_large
                                    : error == http::error::body_limit ? http::status::payload_too_large
                                                                       : http::status::bad_request;
        Response response = refuse(Request{}, status, "the request cannot be read: " + error.message());
        response.keep_alive(false);
        send(std::move(response));
    }

    void on_request() {
        Request request = parser_->release();
        if (path_of(request) == "/ws" && beast::websocket::is_upgrade(request))
            return open_websocket(request);
        Response response = respond(request, hub_);
        if (path_of(request) == "/frame.jpg" && response.result() == http::status::ok)
            return send_picture(std::move(request));
        send(std::move(response));
    }

    /// The present view, in the size asked for or the view's own. Its ETag tells revision and size.
    void send_picture(Request request) {
        constexpr std::size_t kMostWaiting = 8;
        const PictureLimits& limits = hub_.engine->limits();
        const auto width = query_number(request, "width"), height = query_number(request, "height");
        if (!width || !height || (*width == 0) != (*height == 0) || !fits(*width, *height, limits))
            return send(refuse(request, http::status::bad_request,
                               "'width' and 'height' must be given together, as numbers from 1, of at most " +
                                   std::to_string(limits.max_pixels) + " pixels"));
        const std::int64_t pixels_wide = *width > 0 ? *width : hub_.size.width;
        const std::int64_t pixels_high = *height > 0 ? *height : hub_.size.height;
        const auto tag = [width = pixels_wide, height = pixels_high](std::int64_t revision) {
            return "\"" + std::to_string(revision) + "-" + std::to_string(width) + "x" +
                   std::to_string(height) + "\"";
        };
        if (hub_.document && view(request[http::field::if_none_match]) == tag(hub_.document->revision())) {
            Response response = make_response(request, http::status::not_modified, "image/jpeg", {});
            response.set(http::field::etag, tag(hub_.document->revision()));
            return send(std::move(response));
        }
        if (request.method() == http::verb::head) {
            Response response = make_response(request, http::status::ok, "image/jpeg", {});
            response.erase(http::field::content_length);
            if (hub_.document) response.set(http::field::etag, tag(hub_.document->revision()));
            return send(std::move(response));
        }
        if (hub_.picture_waiters.size() >= kMostWaiting) {
            Response response =
                refuse(request, http::status::service_unavailable, "too many pictures are being drawn");
            response.set(http::field::retry_after, "1");
            return send(std::move(response));
        }
        const std::string name = "picture " + std::to_string(hub_.next_picture++);
        hub_.picture_waiters[name] = [self = shared_from_this(), request = std::move(request),
                                      tag](const std::shared_ptr<const EncodedPicture>& picture) {
            if (!picture)
                return self->send(refuse(request, http::status::service_unavailable,
                                         "this picture cannot be drawn: the log says why"));
            const std::vector<std::uint8_t> header = header_of_file(*picture, picture->header);
            const auto& file = picture->file;
            const auto cut = file.begin() + static_cast<std::ptrdiff_t>(picture->header_offset);
            std::string body(file.begin(), cut);
            body.append(header.begin(), header.end()).append(cut, file.end());
            Response response = make_response(request, http::status::ok, "image/jpeg", std::move(body));
            response.set(http::field::etag, tag(picture->header.revision));
            self->send(std::move(response));
        };
        hub_.engine->mailbox().push(
            PictureAsked{name, static_cast<int>(pixels_wide), static_cast<int>(pixels_high)});
    }

    void open_websocket(const Request& request) {
        const std::string_view host = view(request[http::field::host]);
        if (!hub_.access.accepts_host(host))
            return send(
                refuse(request, http::status::forbidden, "this server is to be reached as localhost"));
        if (!hub_.access.accepts_origin(view(request[http::field::origin]), host)) {
            log_info("origin_refused", {{"origin", view(request[http::field::origin])}, {"host", host}});
            return send(refuse(request, http::status::forbidden, "pages of this origin may not connect"));
        }
        if (!speaks_our_subprotocol(request))
            return send(refuse(request, http::status::bad_request, "the subprotocol is vrut-preview.v1"));
        if (hub_.stopping || hub_.connections.size() >= 2 * hub_.max_clients)
            return send(refuse(request, http::status::service_unavailable, "there are too many connections"));
        std::make_shared<Session>(std::move(stream_), hub_)->accept(request);
    }

    void send(Response response) {
        response_ = std::move(response);
        stream_.expires_after(kDeadline);
        http::async_write(
            stream_, response_, [self = shared_from_this()](beast::error_code error, std::size_t) {
                if (error) return;
                if (self->response_.keep_alive() && !self->hub_.stopping) return self->read();
                beast::error_code ignored;
                self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
            });
    }

    beast::tcp_stream stream_;
    Hub& hub_;
    beast::flat_buffer buffer_{kMaxHeader + kMaxBody};
    std::optional<http::request_parser<http::string_body>> parser_;
    Response response_;
};

}  // namespace

void serve_http(boost::asio::ip::tcp::socket socket, Hub& hub) {
    std::make_shared<HttpSession>(std::move(socket), hub)->read();
}

}  // namespace vrut
