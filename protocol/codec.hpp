#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "messages.hpp"
#include "server_messages.hpp"
#include "state.hpp"

namespace vrut::protocol {

/// A client's text message. The error carries the message's `id` where that could be read.
tl::expected<ClientMessage, Error> decode(std::string_view text);
/// The other way: decode() of it gives the same message. What has its default is left out.
std::string encode(const ClientMessage& message);

/// A flight from the text of a JSON object with the members of `fly`; others are ignored.
tl::expected<Fly, Error> parse_flight(std::string_view text);

/// A server's text message.
std::string encode(const Welcome& message);
std::string encode(const Ok& message);
std::string encode(const Picked& message);
std::string encode(const Pointed& message);
std::string encode(const Flown& message);
std::string encode(const TreePage& message);
std::string encode(const Checked& message);
std::string encode(const SceneList& message);
std::string encode(const SharedAddress& message);
std::string encode(const Loading& message);
std::string encode(const Stats& message);
std::string encode(const Error& message);

/// The word that stands for it in messages and in the state.
const char* name_of(Role role);
const char* name_of(NavigationState::Style style);

/// The JSON Schema (draft 2020-12) of everything that travels, and of what is kept in files. Its $defs hold
/// each message, and `clientMessage`, `serverMessage`, `frameHeader`, `stateDocument`, `statePatch`,
/// `eventLogHeader`, `eventLogLine`, `levelTable` and `renderJob`.
std::string json_schema();

}  // namespace vrut::protocol
