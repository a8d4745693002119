#pragma once

#include <optional>
#include <string_view>

#include "http_request.hpp"
#include "http_response.hpp"

namespace vrut {

/// The file of the page at `path`, in the content coding that `request` accepts, or 304 where the browser has
/// it; none if the page has no such file. What lies in page_folder() may be kept for good, the rest is asked
/// for again.
std::optional<HttpResponse> page_response(const HttpRequest& request, std::string_view path);

}  // namespace vrut
