#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "engine/change_keeper.hpp"
#include "engine/frame_renderer.hpp"
#include "net/access.hpp"
#include "net/addresses.hpp"
#include "net/deadlines.hpp"
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
    /// A thread that has something to do and does not come round for longer is not alive.
    std::chrono::milliseconds longest_busy{30'000};
};

/// The preview server: an engine, and clients that reach it over HTTP and WebSocket.
class Server {
public:
    /// Listens and draws from here on, and serves once run() runs. Throws std::runtime_error where the port
    /// is taken or nothing can draw.
    Server(ServerOptions options, scenes::LoadedScene scene, const engine::FrameRendererFactory& renderer);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    std::uint16_t port() const;
    /// What draws.
    const std::string& description() const;
    const observe::Metrics& metrics() const;

    /// From here on SIGTERM, SIGINT and SIGHUP do what stop() does.
    void stop_on_signals();
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
