#pragma once

#include "net/access.hpp"
#include "net/addresses.hpp"
#include "room/answers.hpp"

namespace vrut::server::net {

/// Tells where others may watch what a server shows that listens there, with the view token where there is
/// one. The best address is that of the client's own page, by which other devices come through a proxy, too;
/// but if it is of the loopback interface, the server's own in the network.
room::ShareAddress share_address(const ListenAddress& listen, std::uint16_t port, bool secure,
                                 const Access& access);

}  // namespace vrut::server::net
