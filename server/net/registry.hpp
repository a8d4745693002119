#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tl/expected.hpp>

#include "engine/output.hpp"
#include "engine/room_engine.hpp"
#include "net/access.hpp"
#include "net/bodies_sent.hpp"
#include "net/connection_limit.hpp"
#include "net/deadlines.hpp"
#include "net/document_updates.hpp"
#include "net/tls.hpp"
#include "net/view_pictures.hpp"
#include "observe/metrics.hpp"

namespace vrut::server::net {

class Connection;

/// A room, as this server's connections know it. On the net thread only, except its engine.
struct ServedRoom {
    /// Whether a client may come in, and in which role: `done` is called with it, or with why it may not.
    using Admit =
        std::function<void(const engine::Admission& asked,
                           std::function<void(tl::expected<protocol::Role, protocol::Error>)> done)>;

    std::shared_ptr<engine::RoomEngine> engine;
    Admit admit;
    std::string suffix = {};  ///< of its clients' names and its pictures', which no other server's have
    DocumentUpdates document, host_document;  ///< hosts have a camera of their own
    std::shared_ptr<const engine::EncodedPicture> newest;
    std::int64_t present_frame = 0;  ///< the frame that shows what is to be seen now; 0: none
    std::shared_ptr<const std::string> stats, loading;  ///< the newest messages for all
    bool loads = false;                                 ///< a scene is being loaded
    engine::PictureSize size;                           ///< of a picture of the view
    ViewPictures pictures;
    std::map<std::string, std::shared_ptr<Connection>> clients;  ///< those that said hello
    std::string holder_key;  ///< by which control is resumed; empty: it is not, or not known here

    // What its engine says.
    void take(engine::EngineOutput output);
    void take(std::shared_ptr<const engine::EncodedPicture> picture);

private:
    std::shared_ptr<Connection> find(const std::string& client) const;  ///< null: none of that name
    void take_document(engine::EngineOutput& output);
};

/// Places for clients beyond max_clients, which the audience cannot take: so many for hosts and for who has
/// the control token, and the others for who resumes control.
inline constexpr std::size_t kReservedPlaces = 12, kPlacesToResume = 4;

/// State shared by all connections. On the net thread only, except the metrics.
struct ConnectionRegistry {
    Access access;
    std::size_t max_clients = 64;
    std::chrono::milliseconds longest_busy{30'000};  ///< of a loop that has something to do
    Deadlines deadlines;
    std::shared_ptr<Tls> tls;              ///< null: none
    std::optional<ConnectionLimit> limit;  ///< of connections of any kind
    observe::Metrics* metrics = nullptr;
    std::map<std::string, std::shared_ptr<ServedRoom>> rooms;  ///< by name; the one of this process has none
    std::string renderer;                                      ///< of a process without rooms: what draws
    /// Of a server for rooms that others draw: opens one. Empty: there is this process's alone, or none.
    std::function<std::shared_ptr<ServedRoom>(const std::string& name)> open_room;
    /// Why no room can be served, a sentence; none if one can.
    std::function<std::optional<std::string>()> why_unready;
    /// For those who monitor it; empty: it has nothing to do with NATS, or shares its room with no server.
    std::function<bool()> nats_connected, room_owner;
    std::size_t reports = 0;  ///< being made
    BodiesSent bodies_sent{std::size_t{128} << 20};
    std::set<Connection*> connections;
    std::int64_t next_client = 1;
    bool stopping = false;

    bool has_rooms() const { return open_room || !rooms.empty(); }
    /// Those that said hello, of all rooms.
    std::size_t clients() const;
    /// Whether there is a place for a client of this role, which `hello` asks for.
    bool has_place_for(protocol::Role role, const protocol::Hello& hello, const ServedRoom& room) const;
};

/// Cuts the clients for whom the most waits, while more waits for all than the server keeps.
void bound_backlog(ConnectionRegistry& registry);

}  // namespace vrut::server::net
