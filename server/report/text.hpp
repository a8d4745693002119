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

}  // namespace vrut::server::report
