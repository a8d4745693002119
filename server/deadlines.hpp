#pragma once

#include <chrono>

namespace vrut {

/// How long a peer may take; who takes longer is cut.
struct Deadlines {
    using Time = std::chrono::milliseconds;
    Time request{
        4'500};  ///< HTTP: from the connection's begin or its first byte to its last; over within 5 s
    Time answer{10'000};   ///< HTTP: to be taken
    Time hello{5'000};     ///< from the handshake to the end of `hello`
    Time message{10'000};  ///< from a message's first bytes to its last
    Time stuck{10'000};    ///< with something to take, and nothing taken
    Time ping{20'000};     ///< silence, after which a ping asks for an answer
    Time silence{60'000};  ///< silence in all, when everything sent has arrived
};

}  // namespace vrut
