#pragma once

#include <string>
#include <string_view>

namespace vrut::server::base {

/// `text` as text of HTML, and of a quoted attribute's value.
std::string escaped(std::string_view text);

}  // namespace vrut::server::base
