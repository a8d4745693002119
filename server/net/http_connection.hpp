#pragma once

#include <boost/asio/ip/tcp.hpp>

#include "net/registry.hpp"

namespace vrut::server::net {

/// Serves HTTP on a fresh connection: the page, the routes of monitoring, and the door to /ws.
void serve_http(boost::asio::ip::tcp::socket socket, ConnectionLimit::Place place,
                ConnectionRegistry& registry);
/// Ends a connection that has no place, with a sentence.
void reject_connection(boost::asio::ip::tcp::socket socket);

}  // namespace vrut::server::net
