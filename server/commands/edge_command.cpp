#include "commands/commands.hpp"
#include "commands/network.hpp"
#include "nats/remote_room.hpp"

namespace vrut::server::commands {

void edge_command(const EdgeArguments& arguments) {
    net::ServerOptions options = server_options(arguments.network);
    // Rooms ask for their own tokens; what is the edge's own is for nobody who has none.
    const bool is_open = !options.access.needs_token();
    if (is_open && !net::is_loopback(options.listen.host)) options.access.control_token = net::make_token();

    const nats::Connection connection(arguments.nats);
    options.nats_connected = [&] { return connection.is_connected(); };
    net::RemoteRooms rooms;
    const std::string edge = connection.id();
    rooms.suffix = "." + edge;
    rooms.why_unready = [&connection]() -> std::optional<std::string> {
        if (connection.is_connected()) return std::nullopt;
        return "the NATS server cannot be reached";
    };
    rooms.open = [&](const std::string& name, observe::Metrics& metrics, engine::EngineCallbacks callbacks) {
        auto room = std::make_shared<nats::RemoteRoom>(connection, name, edge, metrics, std::move(callbacks));
        return net::RemoteRooms::Room{room, [room = room.get()](const engine::Admission& asked, auto done) {
                                          room->admit(asked, std::move(done));
                                      }};
    };
    net::Server server(options, std::move(rooms));
    if (is_open) options.access = {};  // it is no client's
    run(server, options, "rooms/NAME/");
}

}  // namespace vrut::server::commands
