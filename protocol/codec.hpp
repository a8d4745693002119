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

/// `place`: of its type in ServerMessage.
std::string encode_server_message(std::size_t place, const void* message);
template <class Message, class... All>
constexpr std::size_t place_among(const std::variant<All...>*) {
    std::size_t place = 0;
    const bool found = ((std::is_same_v<Message, All> || (++place, false)) || ...);
    return found ? place : throw "it is no ServerMessage";
}
/// A server's text message: any that ServerMessage can hold.
template <class Message>
requires requires { Message::kType; }
std::string encode(const Message& message) {
    constexpr std::size_t kPlace = place_among<Message>(static_cast<const ServerMessage*>(nullptr));
    return encode_server_message(kPlace, &message);
}

/// The word that stands for it in messages and in the state.
const char* name_of(Role role);
const char* name_of(NavigationState::Style style);

/// The JSON Schema (draft 2020-12) of everything that travels, and of what is kept in files. Its $defs hold
/// each message, and `clientMessage`, `serverMessage`, `frameHeader`, `stateDocument`, `statePatch`,
/// `eventLogHeader`, `eventLogLine`, `levelTable` and `renderJob`.
std::string json_schema();

}  // namespace vrut::protocol
