#include "net/http_request.hpp"

#include <algorithm>
#include <array>
#include <boost/beast/http/parser.hpp>
#include <iterator>

namespace vrut::server::net {

namespace beast = boost::beast;
namespace http = beast::http;
using http::field;
using http::status;

namespace {

using Rejected = std::optional<HttpRejection>;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Judges bytes as they come, also where the end is still to come.
Rejected rejected_bytes(std::string_view head) {
    for (std::size_t i = 0; i < head.size(); ++i) {
        const auto byte = static_cast<unsigned char>(head[i]);
        const char before = i > 0 ? head[i - 1] : '\0';
        if ((byte == '\n') != (before == '\r'))
            return HttpRejection{status::bad_request, "each line of a request must end with CR LF"};
        if (before == '\n' && (byte == ' ' || byte == '\t'))
            return HttpRejection{status::bad_request, "a header field must stand in one line"};
        if ((byte < ' ' && byte != '\r' && byte != '\n' && byte != '\t') || byte == 0x7F)
            return HttpRejection{status::bad_request, "a request must hold no control bytes"};
    }
    if (head.substr(0, kMaxRequestLine).find('\n') == std::string_view::npos &&
        head.size() >= kMaxRequestLine)
        return HttpRejection{status::uri_too_long, "the first line of a request may have at most " +
                                                       std::to_string(kMaxRequestLine) + " bytes"};
    return std::nullopt;
}

/// What Beast makes of it.
HttpRejection unreadable(beast::error_code error, std::string_view head) {
    const std::string_view line = head.substr(0, head.find('\r'));
    const std::string_view version = line.substr(line.rfind(' ') + 1);
    const bool other_version = error == http::error::bad_version && version != "HTTP/1.1" &&
                               version != "HTTP/1.0" && version.size() == 8 && version.starts_with("HTTP/") &&
                               is_digit(version[5]) && version[6] == '.' && is_digit(version[7]);
    if (other_version)
        return {status::http_version_not_supported, "the version must be HTTP/1.1 or HTTP/1.0"};
    return {status::bad_request, "the request cannot be read: " + error.message()};
}

/// No request that is served has a body, so that nothing can be hidden in one.
Rejected rejected_body(const HttpRequest& request) {
    const bool encoded = request.count(field::transfer_encoding) > 0;
    const bool sized = request.count(field::content_length) > 0;
    if (encoded && (sized || request.version() < 11))
        return HttpRejection{status::bad_request,
                             "'Transfer-Encoding' must stand alone: leave out 'Content-Length', "
                             "and use HTTP/1.1"};
    if (encoded)
        return HttpRejection{status::not_implemented,
                             "requests may have no body: leave out 'Transfer-Encoding'"};
    const std::string_view length = view(request[field::content_length]);
    if (sized && !std::all_of(length.begin(), length.end(), is_digit))
        return HttpRejection{status::bad_request, "'Content-Length' must be one number"};
    if (sized && length.find_first_not_of('0') != std::string_view::npos)
        return HttpRejection{status::payload_too_large,
                             "requests may have no body: leave out 'Content-Length'"};
    if (request.count(field::expect) > 0)
        return HttpRejection{status::expectation_failed, "'Expect' is not supported: leave it out"};
    return std::nullopt;
}

Rejected rejected_repeats(const HttpRequest& request) {
    constexpr std::array kOnce{field::host,          field::content_length,        field::transfer_encoding,
                               field::origin,        field::authorization,         field::sec_websocket_key,
                               field::if_none_match, field::sec_websocket_version, field::upgrade};
    for (const field name : kOnce)
        if (request.count(name) > 1)
            return HttpRejection{status::bad_request,
                                 "'" + std::string(http::to_string(name)) + "' must occur once only"};
    return std::nullopt;
}

Rejected rejected_head(const HttpRequest& request) {
    const std::string_view target = view(request.target());
    if (request.method() == http::verb::unknown)
        return HttpRejection{status::not_implemented, "there is no such method: send GET or HEAD"};
    if (request.method() != http::verb::get && request.method() != http::verb::head)
        return HttpRejection{status::method_not_allowed, "the method must be GET or HEAD"};
    if (!target.starts_with('/') ||
        std::any_of(target.begin(), target.end(), [](char c) { return c < '!' || c > '~' || c == '#'; }))
        return HttpRejection{status::bad_request, "an address must be a path in ASCII, from '/' on"};
    if (request.version() == 11 && request.count(field::host) == 0)
        return HttpRejection{status::bad_request, "'Host' is missing: name the server and its port"};
    if (request.count(field::host) > 0 && !is_host(view(request[field::host])))
        return HttpRejection{status::bad_request, "'Host' must be a name and a port"};
    return std::nullopt;
}

/// Beast looks at the rest of a handshake.
Rejected rejected_handshake(const HttpRequest& request) {
    if (request.count(field::sec_websocket_key) == 0) return std::nullopt;
    const std::string_view key = view(request[field::sec_websocket_key]);
    const auto is_base64 = [](char c) { return is_letter(c) || is_digit(c) || c == '+' || c == '/'; };
    if (key.size() != 24 || !key.ends_with("==") || !std::all_of(key.begin(), key.end() - 2, is_base64))
        return HttpRejection{status::bad_request, "'Sec-WebSocket-Key' must be 16 bytes in base64"};
    return std::nullopt;
}

}  // namespace

bool is_host(std::string_view text) {
    const std::size_t end = text.starts_with('[') ? text.find(']') : text.find(':');
    std::string_view name = text.substr(0, end), port;
    if (text.starts_with('[')) {
        if (end == std::string_view::npos) return false;
        name.remove_prefix(1);
        port = text.substr(end + 1);
    } else if (end != std::string_view::npos) {
        port = text.substr(end);
    }
    const bool number = text.starts_with('[');
    const auto in_name = [&](char c) {
        const bool hexadecimal = is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
        return number ? hexadecimal || c == ':' || c == '.'
                      : is_letter(c) || is_digit(c) || c == '-' || c == '.' || c == '_';
    };
    if (name.empty() || !std::all_of(name.begin(), name.end(), in_name)) return false;
    if (port.empty()) return true;
    return port.size() >= 2 && port.size() <= 6 && port[0] == ':' &&
           std::all_of(port.begin() + 1, port.end(), is_digit);
}

bool names_tag(std::string_view if_none_match, std::string_view tag) {
    std::string_view list = if_none_match;
    while (!list.empty()) {
        const std::size_t comma = std::min(list.find(','), list.size());
        std::string_view each = list.substr(0, comma);
        while (each.starts_with(' ') || each.starts_with('\t')) each.remove_prefix(1);
        while (each.ends_with(' ') || each.ends_with('\t')) each.remove_suffix(1);
        if (each.starts_with("W/")) each.remove_prefix(2);
        if (each == tag || each == "*") return true;
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return false;
}

std::optional<tl::expected<ReadRequest, HttpRejection>> read_request(std::string_view bytes) {
    const std::size_t end = bytes.find("\r\n\r\n");
    const bool whole = end != std::string_view::npos;
    const std::string_view head = bytes.substr(0, whole ? end + 4 : bytes.size());
    if (auto rejected = rejected_bytes(head)) return tl::unexpected(*std::move(rejected));
    if (head.size() > kMaxRequest || (!whole && head.size() == kMaxRequest))
        return tl::unexpected(
            HttpRejection{status::request_header_fields_too_large,
                          "a request may have at most " + std::to_string(kMaxRequest) + " bytes"});
    if (!whole) return std::nullopt;

    http::request_parser<http::empty_body> parser;
    parser.header_limit(kMaxRequest);
    parser.body_limit(boost::none);
    beast::error_code error;
    parser.put(boost::asio::buffer(head.data(), head.size()), error);
    if (error) return tl::unexpected(unreadable(error, head));
    const HttpRequest& request = parser.get();
    for (const auto judge : {rejected_repeats, rejected_head, rejected_body, rejected_handshake})
        if (auto rejected = judge(request)) return tl::unexpected(*std::move(rejected));
    return ReadRequest{parser.release(), head.size()};
}

}  // namespace vrut::server::net
