#include "http_session.hpp"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <memory>

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
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
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
    if (path == "/healthz") return text("ok\n");
    if (path == "/readyz" || path == "/metrics") {
        if (!has_token(request, hub)) {
            Response response = refuse(request, http::status::unauthorized, "this route asks for a token");
            response.set(http::field::www_authenticate, "Bearer");
            return response;
        }
        // The engine hands over its first document when a first picture has been drawn.
        if (path == "/readyz")
            return hub.document ? text("ready\n")
                                : refuse(request, http::status::service_unavailable, "no scene is drawn yet");
        return text(hub.metrics->text());
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
        send(respond(request, hub_));
    }

    void open_websocket(const Request& request) {
        const std::string_view host = view(request[http::field::host]);
        if (!hub_.access.accepts_host(host))
            return send(
                refuse(request, http::status::forbidden, "this server is to be reached as localhost"));
        if (!hub_.access.accepts_origin(view(request[http::field::origin]), host))
            return send(refuse(request, http::status::forbidden, "pages of this origin may not connect"));
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
