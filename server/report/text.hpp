#pragma once

#include <string>
#include <string_view>

namespace vrut::server::report {

/// The shortest text that is read as the same number.
std::string shortest(double value);
/// With so many digits behind the point.
std::string fixed(double value, int digits);
/// RFC 4648, with padding.
std::string base64(std::string_view bytes);
/// `text` as text of HTML, and of a quoted attribute's value.
std::string escaped(std::string_view text);

}  // namespace vrut::server::report
