#pragma once

#include "fields.hpp"
#include "messages.hpp"

/// Messages as JSON values, for what else holds them. For protocol's own .cpp files.
namespace vrut::protocol {

/// Throws BadJson.
decltype(ClientMessage::payload) read_payload(const Json& json);
Json to_json(const ClientMessage& message);
/// A flight's keyframes must rise. Throws BadJson.
void check(const Fly& fly);
/// One type of the server's messages.
struct ServerMessageType {
    const char* name;  ///< the word in `type`
    const FieldTable& table;
};
/// In the order of ServerMessage.
std::span<const ServerMessageType> server_message_types();
/// Of the struct that it holds.
const FieldTable& table_of_message(const decltype(ClientMessage::payload)& payload);

}  // namespace vrut::protocol
