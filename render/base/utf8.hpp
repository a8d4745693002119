#pragma once

#include <string_view>

namespace vrut::base {

/// Offset of the first byte that is not valid UTF-8 (RFC 3629), or npos.
std::size_t find_invalid_utf8(std::string_view text);

}  // namespace vrut::base
