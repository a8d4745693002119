#pragma once

#include "messages.hpp"
#include "server_messages.hpp"

namespace vrut::server::room {

/// What the gestures and keys of navigation/ go by, for clients.
protocol::InputRules input_rules();

}  // namespace vrut::server::room
