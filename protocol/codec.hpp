#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "messages.hpp"

namespace vrut::protocol {

/// A client's text message. The error carries the message's `id` where that could be read.
tl::expected<ClientMessage, Error> decode(std::string_view text);

std::string encode(const Welcome& message);
std::string encode(const Ok& message);
std::string encode(const Picked& message);
std::string encode(const Error& message);

const char* name_of(Role role);

}  // namespace vrut::protocol
