#include <algorithm>
#include <chrono>
#include <latch>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include "commands/commands.hpp"
#include "commands/network.hpp"
#include "engine/images.hpp"
#include "nats/shared_room.hpp"
#include "net/server.hpp"
#include "observe/log.hpp"
#include "observe/progress.hpp"
#include "scenes/change_store.hpp"
#include "scenes/library.hpp"
#include "scenes/state_folder.hpp"

namespace vrut::server::commands {

namespace {

/// An empty path stays one. Throws std::runtime_error where there is no such folder.
std::filesystem::path existing_folder(const std::string& option, const std::filesystem::path& path) {
    if (!path.empty() && !std::filesystem::is_directory(path))
        throw std::runtime_error(option + ": there is no folder " + path.string());
    return path;
}

/// Throws std::runtime_error where there are fewer threads than the server and a driver in software take:
/// such a driver does not look whether it got its own, and waits for them for ever.
void require_threads() {
    constexpr unsigned kEncoders = 2;  // of frames and of snapshots
    constexpr unsigned kOwn = 8 + kEncoders * (engine::JpegEncoder::kMaxThreads - 1), kMostOfDriver = 32;
    std::latch all_asked(1);
    std::vector<std::jthread> threads;
    const unsigned needed = kOwn + std::min(std::thread::hardware_concurrency(), kMostOfDriver);
    try {
        while (threads.size() < needed) threads.emplace_back([&] { all_asked.wait(); });
    } catch (const std::system_error&) {
    }
    all_asked.count_down();
    if (threads.size() < needed)
        throw std::runtime_error("only " + std::to_string(threads.size()) + " threads can be had, and " +
                                 std::to_string(needed) + " are needed: raise the limit (ulimit -u)");
}

/// Finds a scene that a shared room shows among those of this server, by what it shows.
room::SceneFinder finder(const scenes::SceneLibrary& library) {
    return
        [library](const std::string& name, const std::string& sha256,
                  std::optional<protocol::UpAxis> up_axis) -> tl::expected<scenes::LoadedScene, std::string> {
            const auto path = library.find(name);
            if (!path) return tl::unexpected(path.error());
            scenes::ImportOptions options = library.options();
            if (up_axis) options.read.z_up = up_axis == protocol::UpAxis::z;
            auto scene = scenes::load_scene(*path, name, {}, options);
            if (scene && scene->sha256 != sha256)
                return tl::unexpected(path->string() + " is not the scene '" + name + "' of the room");
            return scene;
        };
}

/// Serves a room that other servers serve, too, until a signal ends it: while one of them draws it this one
/// follows.
void serve_shared(const ServeArguments& arguments, net::ServerOptions options,
                  const scenes::LoadedScene& scene) {
    const nats::Connection connection(arguments.nats);
    options.nats_connected = [&] { return connection.is_connected(); };
    bool is_announced = false;
    for (bool is_superseded = true; std::exchange(is_superseded, false);) {
        net::Server* running = nullptr;
        nats::SharedRoom::Options shared_options;
        shared_options.room = arguments.room;
        shared_options.role_for = [access = options.access](auto wanted, const auto& token) {
            return access.role_for(wanted, token);
        };
        shared_options.find_scene = finder(options.library);
        shared_options.on_superseded = [&](const std::string&) {
            is_superseded = true;
            running->stop();
        };
        std::optional<nats::SharedRoom> shared;
        std::optional<net::Server> server;
        try {
            shared.emplace(connection, std::move(shared_options));
            options.shared = shared->hooks();
            options.relay = [&](engine::EngineCallbacks to_clients) {
                return shared->relay(std::move(to_clients));
            };
            server.emplace(options, scene, engine::gl_renderer(arguments.device));
            running = &*server;
            shared->begin(server->engine());
        } catch (const std::runtime_error& error) {
            if (!is_announced) throw;
            // NATS may answer later.
            observe::log_warning("room_stalls", {{"room", arguments.room}, {"reason", error.what()}});
            std::this_thread::sleep_for(std::chrono::seconds(1));
            is_superseded = true;
            continue;
        }
        if (std::exchange(is_announced, true))
            server->heed_signals();
        else
            announce(*server, options);
        options.listen.port = server->port();
        server->run();
        shared->stop();
    }
    end_serving();
}

}  // namespace

void serve_command(const ServeArguments& arguments) {
    require_threads();
    net::ServerOptions options = server_options(arguments.network);
    if (!net::is_loopback(options.listen.host) && !options.access.needs_token()) {
        options.access.control_token = net::make_token();
        options.access.view_token = net::make_token();
    }

    const std::filesystem::path path = arguments.scene.empty() ? default_scene() : arguments.scene;
    options.library =
        scenes::SceneLibrary(existing_folder("--scenes", arguments.scenes), {{}, arguments.read}, path);
    const std::string& name = options.library.start_name();
    auto scene = scenes::load_kept_scene(path, name, observe::loading_bar(name), options.library.options());
    if (!scene) throw std::runtime_error(scene.error());
    options.keep_changes = {scenes::store_changes, scenes::set_changes_aside};
    const scene::Scene& read = *scene->placed->scene;
    for (const protocol::Notice& notice : scene->notices)
        observe::log_warning("notice", {{"scene", name}, {"text", notice.message}});
    observe::log_info(
        "scene_read",
        {{"file", path.string()}, {"nodes", read.nodes().size()}, {"triangles", read.triangle_count()}});
    options.record_folder = existing_folder("--record", arguments.record);

    if (!arguments.nats.empty()) return serve_shared(arguments, std::move(options), *scene);
    net::Server server(options, *std::move(scene), engine::gl_renderer(arguments.device));
    run(server, options);
}

}  // namespace vrut::server::commands
