#pragma once

#include <chrono>

namespace vrut::server::net {

/// How long a peer may take; the connection of one that takes longer is closed.
struct Deadlines {
    std::chrono::milliseconds request{
        4'500};  ///< HTTP: from the connection's begin or its first byte to its last; over within 5 s
    std::chrono::milliseconds answer{10'000};   ///< HTTP: to be taken
    std::chrono::milliseconds hello{5'000};     ///< from the handshake to the end of `hello`
    std::chrono::milliseconds message{10'000};  ///< from a message's first bytes to its last
    std::chrono::milliseconds stuck{
        10'000};  ///< no byte taken, or for a message that and 1 s for each 1000 bytes
    std::chrono::milliseconds least_rate{
        20'000};  ///< with answers or snapshots waiting, less than 4 kB a second taken
    std::chrono::milliseconds ping{20'000};  ///< without a byte: then a ping asks for an answer
    std::chrono::milliseconds idle{
        60'000};  ///< without a byte or pong, and 1 s for each 1000 bytes in flight
};

}  // namespace vrut::server::net
