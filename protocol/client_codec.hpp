#pragma once

#include "json_reader.hpp"
#include "messages.hpp"

/// Client messages as JSON values, for what else holds them. For protocol's own .cpp files.
namespace vrut::protocol {

/// Throws BadJson.
decltype(ClientMessage::payload) read_payload(const Json& json);
Json to_json(const ClientMessage& message);
/// A flight's keyframes must rise. Throws BadJson.
Fly checked(Fly fly);

}  // namespace vrut::protocol
