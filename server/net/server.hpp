#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "engine/change_keeper.hpp"
#include "engine/frame_renderer.hpp"
#include "engine/output.hpp"
#include "engine/room_engine.hpp"
#include "engine/shared_hooks.hpp"
#include "net/access.hpp"
#include "net/addresses.hpp"
#include "net/deadlines.hpp"
#include "net/registry.hpp"
#include "net/tls.hpp"
#include "scenes/library.hpp"

namespace vrut::server::observe {
struct Metrics;
}

namespace vrut::server::net {

struct ServerOptions {
    ListenAddress listen{"127.0.0.1", 8080};
    Access access;
    /// Clients may speak TLS, and those that are not on this machine must. Null: none may.
    std::shared_ptr<Tls> tls = nullptr;
    std::size_t max_clients = 64;
    Deadlines deadlines{};
    scenes::SceneLibrary library{};
    std::filesystem::path record_folder{};  ///< empty: nothing is recorded
    /// Stores what clients change of a scene. Empty: their changes are lost with the scene.
    engine::ChangeKeeper::Store keep_changes = {};
    std::function<bool()> nats_connected = {};  ///< empty: it has nothing to do with NATS
    /// Of a room that servers share, and what its engine says to clients on the way to them. Both or none.
    std::optional<engine::SharedHooks> shared = {};
    std::function<engine::EngineCallbacks(engine::EngineCallbacks to_clients)> relay = {};
    /// A thread that has something to do and does not come round for longer is not alive.
    std::chrono::milliseconds longest_busy{30'000};
};

/// Rooms that other servers draw.
struct RemoteRooms {
    struct Room {
        std::shared_ptr<engine::RoomEngine> engine;
        ServedRoom::Admit admit;
    };
    /// Opens the room of this name. Callbacks and `done` of its Admit are called from any thread. A room that
    /// no server has draws nothing.
    std::function<Room(const std::string& name, observe::Metrics& metrics, engine::EngineCallbacks callbacks)>
        open;
    /// Why none can be had now, a sentence; none if they can.
    std::function<std::optional<std::string>()> why_unready;
    std::string suffix;  ///< of clients' names; no other server of these rooms has it
};

/// A process without rooms, which those who monitor it ask how it is.
struct Monitored {
    std::string renderer;  ///< what draws
    /// Why it can do nothing now, a sentence; none if it can.
    std::function<std::optional<std::string>()> why_unready;
};

/// The preview server: clients reach rooms over HTTP and WebSocket.
class Server {
public:
    /// One room, drawn here. Listens and draws from here on, and serves once run() runs. Throws
    /// std::runtime_error where the port is taken or nothing can draw.
    Server(ServerOptions options, scenes::LoadedScene scene, const engine::FrameRendererFactory& renderer);
    /// Any room of those, at /rooms/NAME/.
    Server(ServerOptions options, RemoteRooms rooms);
    /// None: only how the process is.
    Server(ServerOptions options, Monitored monitored);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    std::uint16_t port() const;
    /// What draws; empty: that is elsewhere.
    std::string description() const;
    /// Of the room that is drawn here.
    engine::RoomEngine& engine();
    observe::Metrics& metrics();

    /// From here on SIGTERM and SIGINT do what stop() does. SIGHUP reads the files of the certificate again;
    /// a server without such files is stopped by it.
    void heed_signals();
    /// Serves until stop(); clients get a goodbye, and it ends within 3 s. Throws std::runtime_error where
    /// drawing fails for good.
    void run();
    /// From any thread.
    void stop();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vrut::server::net
