#include "net/http_response.hpp"

namespace vrut::server::net {

namespace http = boost::beast::http;

namespace {

constexpr std::string_view kSecurity =
    "X-Content-Type-Options: nosniff\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n";

/// They bind documents. A script or a style sheet is none, and the page has two dozen of them.
constexpr std::string_view kDocumentSecurity =
    "Referrer-Policy: no-referrer\r\n"
    "Cross-Origin-Opener-Policy: same-origin\r\n"
    "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
    "manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; connect-src 'self'";

/// For older WebKits, to which 'self' is no WebSocket. The policy's language has no numbers of IPv6.
void append_websocket(std::string& head, std::string_view host) {
    if (host.empty() || host.starts_with('[')) return;
    for (const std::string_view scheme : {" ws://", " wss://"}) head.append(scheme).append(host);
}

}  // namespace

HttpResponse text_response(http::status status, std::string text) {
    HttpResponse response{status};
    response.body = std::make_shared<const std::string>(std::move(text));
    return response;
}

HttpResponse rejection(http::status status, const std::string& sentence) {
    HttpResponse response = text_response(status, sentence + "\n");
    if (status == http::status::method_not_allowed) response.fields = "Allow: GET, HEAD\r\n";
    if (status == http::status::unauthorized) response.fields = "WWW-Authenticate: Bearer\r\n";
    if (status == http::status::upgrade_required)
        response.fields = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n";
    if (status == http::status::service_unavailable) response.fields = "Retry-After: 1\r\n";
    return response;
}

std::string head_of(const HttpResponse& response, std::string_view host, bool keep_alive) {
    const auto reason = http::obsolete_reason(response.status);
    std::string head;
    head.reserve(1024);
    head.append("HTTP/1.1 ").append(std::to_string(static_cast<unsigned>(response.status))).append(" ");
    head.append(reason.data(), reason.size()).append("\r\nContent-Type: ").append(response.content_type);
    head.append("\r\nCache-Control: ").append(response.cache_control).append("\r\n").append(kSecurity);
    if (response.is_document) {
        head.append(kDocumentSecurity);
        append_websocket(head, host);
        head.append("\r\n");
    }
    head.append(response.fields);
    if (response.body)
        head.append("Content-Length: ").append(std::to_string(response.body->size())).append("\r\n");
    if (!keep_alive) head += "Connection: close\r\n";
    return head += "\r\n";
}

}  // namespace vrut::server::net
