#pragma once

#include <boost/beast/core/string_type.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/status.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace vrut::server::net {

/// A GET or HEAD without a body; nothing else is served.
using HttpRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// Beast's strings as the standard's.
inline std::string_view view(boost::beast::string_view text) { return {text.data(), text.size()}; }

/// Why a request is not answered. What follows it on its connection cannot be trusted.
struct HttpRejection {
    boost::beast::http::status status;
    std::string sentence;
};

/// Bytes of a request, and of its first line alone.
inline constexpr std::size_t kMaxRequest = 8192, kMaxRequestLine = 4096;

struct ReadRequest {
    HttpRequest request;
    std::size_t size = 0;  ///< bytes of it
};

/// Reads the request at the start of `bytes`, none where it is not all there yet. Beast parses it, and
/// whatever two readers of RFC 9112 could understand in two ways is rejected: lines that end otherwise than
/// by CR LF or are folded, control bytes, fields that may come once and come twice, bodies of any kind, and
/// addresses that are no path.
std::optional<tl::expected<ReadRequest, HttpRejection>> read_request(std::string_view bytes);

/// A name or number, IPv6 in brackets, and a port: what can stand in a Content-Security-Policy.
bool is_host(std::string_view text);

/// Returns true if the value of an If-None-Match field names `tag`.
bool names_tag(std::string_view if_none_match, std::string_view tag);

}  // namespace vrut::server::net
