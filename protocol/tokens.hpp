#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "messages.hpp"

namespace vrut::protocol {

struct Tokens {
    std::string control, view;  ///< empty: none
};

/// A token has 16 to 1000 bytes.
bool is_token(std::string_view text);

/// A token file's text: {"control": …, "view": …}, at least one of them, each of 16 to 1000 bytes.
tl::expected<Tokens, Error> parse_tokens(std::string_view text);

}  // namespace vrut::protocol
