#pragma once

#include <string>
#include <string_view>

namespace vrut::io {

/// Returns true for `data:…`, a URI that has the data itself (RFC 2397).
inline bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

/// Returns the data, whatever its media type. Throws ImportError.
std::string decode_data_uri(std::string_view uri);

}  // namespace vrut::io
