#pragma once

#include <span>

#include "rights.hpp"

/// The one table of client messages. A new type of message is a struct (messages.hpp), the description of its
/// members (client_descriptions.hpp), a row in the table, and the room's handler, Room::apply() of that
/// struct.
namespace vrut::protocol {

/// If a message steers: its client must hold control, or takes it. `by_content`: its handler tells.
enum class Steers { no, yes, by_content };

/// What a message weighs of what a client may have unhandled. Thousands a second come of a stream, pointer
/// moves and grants; their bytes count, not their number.
enum class Weight { stream, request };

struct MessageTraits {
    const char* type;  ///< the word in `type`
    Right right;       ///< that its sender needs
    Steers steers;
    bool recorded;  ///< an accepted one is a line of the event log
    Weight weight;
};

/// One type of client message.
struct ClientMessageType {
    MessageTraits traits;
    decltype(ClientMessage::payload) prototype;  ///< holds what the type itself says
};

/// All of them.
std::span<const ClientMessageType> client_message_types();
const MessageTraits& traits_of(const ClientMessage& message);

}  // namespace vrut::protocol
