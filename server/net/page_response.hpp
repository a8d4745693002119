#pragma once

#include <optional>
#include <string_view>

#include "net/http_request.hpp"
#include "net/http_response.hpp"

namespace vrut::server::net {

/// Returns the file of the page at `path`, compressed if `request` accepts gzip; 304 if its If-None-Match
/// names the file; none if the page has no such file. Browsers may keep files of page_folder() for good, and
/// revalidate the others.
std::optional<HttpResponse> page_response(const HttpRequest& request, std::string_view path);

}  // namespace vrut::server::net
