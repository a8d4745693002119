#pragma once

#include <boost/beast/http/status.hpp>
#include <memory>
#include <string>
#include <string_view>

namespace vrut::server::net {

struct HttpResponse {
    boost::beast::http::status status = boost::beast::http::status::ok;
    std::string_view content_type = "text/plain; charset=utf-8";
    std::shared_ptr<const std::string> body{};  ///< null: none, and no length is said
    std::string fields{};                       ///< more of them, each with its CR LF
    std::string_view cache_control = "no-cache";
    bool is_document = true;  ///< a browser may show it as one: the Content-Security-Policy is sent with it
};

HttpResponse text_response(boost::beast::http::status status, std::string text);
/// A sentence that says why not.
HttpResponse rejection(boost::beast::http::status status, const std::string& sentence);

/// Status line and fields, those for a browser's security as well. `host` is that of the request, where it
/// had one: the page may connect there and nowhere else.
std::string head_of(const HttpResponse& response, std::string_view host, bool keep_alive);

}  // namespace vrut::server::net
