#pragma once

#include <string>

#include "commands/commands.hpp"
#include "net/server.hpp"

namespace vrut::server::commands {

/// How clients reach a server, by its arguments. To be called first: what the program writes to may end from
/// then on. Throws std::runtime_error.
net::ServerOptions server_options(const NetworkArguments& arguments);

/// Prints the server's addresses, followed by `path`. Signals end it from here on.
void announce(net::Server& server, const net::ServerOptions& options, const std::string& path = {});
/// To be called when no server runs any more: further signals change nothing.
void end_serving();
/// Prints the server's addresses, followed by `path`, and serves until a signal ends it. Throws
/// std::runtime_error where drawing fails for good.
void run(net::Server& server, const net::ServerOptions& options, const std::string& path = {});

}  // namespace vrut::server::commands
