#pragma once

#include <cstddef>
#include <cstdint>

#include "test_client.hpp"

namespace vrut::test {

/// So many clients connect and die, in all the ways that there are: between any two bytes that a client
/// sends, with a pointer down, with a frame, a snapshot or a picture on its way; half of them with a goodbye
/// of the system's (FIN), half without (RST).
void connect_and_die(std::uint16_t port, std::size_t clients);

/// Rounds of them at a server in this process, which has one client who stays. After each the process holds
/// as many descriptors and threads as before. Returns by how many MB its memory has grown after the first two
/// rounds.
double let_die(const TestServer& server, int rounds, std::size_t clients);

}  // namespace vrut::test
