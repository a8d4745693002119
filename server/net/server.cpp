#include "net/server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <stdexcept>

#include "engine/engine.hpp"
#include "net/connection.hpp"
#include "net/descriptors.hpp"
#include "net/http_connection.hpp"
#include "net/monitoring.hpp"
#include "net/share_address.hpp"
#include "observe/log.hpp"

namespace vrut::server::net {

namespace asio = boost::asio;
using asio::ip::tcp;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kMostRooms = 64;  // open at once
constexpr auto kRoomKept = 10s;         // that nobody is in

/// By the tokens of this server.
ServedRoom::Admit admit_by(Access access) {
    return [access = std::move(access)](const engine::Admission& asked, const auto& done) {
        if (const auto role = access.role_for(asked.role, asked.token)) return done(*role);
        done(tl::unexpected(
            protocol::Error{{},
                            protocol::error_code::not_allowed,
                            asked.token.empty() ? "this server asks for a token" : "the token is wrong"}));
    };
}

}  // namespace

struct Server::Impl {
    explicit Impl(ServerOptions server_options)
        : options(std::move(server_options)),
          acceptor(context),
          accept_pause(context),
          signals(context),
          deadline(context) {
        listen();
        limit_connections();
        registry.access = options.access;
        registry.tls = options.tls;
        registry.max_clients = options.max_clients;
        registry.longest_busy = options.longest_busy;
        registry.deadlines = options.deadlines;
        registry.metrics = &metrics;
    }

    Impl(ServerOptions server_options, scenes::LoadedScene scene,
         const engine::FrameRendererFactory& renderer)
        : Impl(std::move(server_options)) {
        const auto room = std::make_shared<ServedRoom>();
        engine::EngineOptions engine_options{std::move(scene), options.library, options.record_folder,
                                             options.keep_changes,
                                             share_address(options.listen, acceptor.local_endpoint().port(),
                                                           options.tls != nullptr, options.access)};
        engine_options.shared = options.shared;
        registry.nats_connected = options.nats_connected;
        engine::EngineCallbacks callbacks = callbacks_of(room);
        if (options.relay) callbacks = options.relay(std::move(callbacks));
        const auto engine = std::make_shared<engine::Engine>(std::move(engine_options), renderer, metrics,
                                                             std::move(callbacks));
        room->engine = engine;
        if (options.shared) registry.room_owner = [engine = engine.get()] { return !engine->follows(); };
        room->admit = [engine = engine.get(), by_token = admit_by(options.access)](
                          const engine::Admission& asked, const auto& done) {
            if (!engine->follows()) return by_token(asked, done);
            done(tl::unexpected(
                protocol::Error{{},
                                protocol::error_code::failed,
                                "another server draws this room: go to that one, or to an edge"}));
        };
        registry.rooms[""] = room;
        registry.why_unready = [room = room.get()] { return net::why_unready(*room); };
    }

    Impl(ServerOptions server_options, RemoteRooms remote_rooms) : Impl(std::move(server_options)) {
        registry.why_unready = remote_rooms.why_unready;
        registry.nats_connected = options.nats_connected;
        registry.open_room = [this, remote = std::move(remote_rooms)](const std::string& name) {
            return open_room(name, remote);
        };
        forget_unused_rooms();
    }

    Impl(ServerOptions server_options, Monitored monitored) : Impl(std::move(server_options)) {
        registry.renderer = std::move(monitored.renderer);
        registry.why_unready = std::move(monitored.why_unready);
        registry.nats_connected = options.nats_connected;
    }

    ~Impl() {
        for (const auto& [name, room] : registry.rooms) {
            room->engine.reset();
            room->newest.reset();
            room->pictures.stop();
            room->clients.clear();
        }
    }

    /// What the engine of a room says comes to the net thread.
    engine::EngineCallbacks callbacks_of(const std::weak_ptr<ServedRoom>& to) {
        const auto post = [this, to](auto said) {
            asio::post(context, [this, to, moved = std::move(said)]() mutable {
                const auto room = to.lock();
                if (!room) return;
                room->take(std::move(moved));
                bound_backlog(registry);
            });
        };
        engine::EngineCallbacks callbacks;
        callbacks.on_output = post;
        callbacks.on_encoded = post;
        callbacks.on_failure = [this](const std::string& why) {
            asio::post(context, [this, why] {
                failure = why;
                stop();
            });
        };
        return callbacks;
    }

    // --- rooms that others draw

    std::shared_ptr<ServedRoom> open_room(const std::string& name, const RemoteRooms& remote) {
        if (registry.rooms.size() >= kMostRooms || registry.stopping) return nullptr;
        const auto room = std::make_shared<ServedRoom>();
        RemoteRooms::Room opened = remote.open(name, metrics, callbacks_of(room));
        room->engine = std::move(opened.engine);
        room->admit = [this, admit = std::move(opened.admit)](const engine::Admission& asked, auto done) {
            admit(asked,
                  [this, done = std::move(done)](const tl::expected<protocol::Role, protocol::Error>& role) {
                      asio::post(context, [done, role] { done(role); });
                  });
        };
        room->suffix = remote.suffix;
        return registry.rooms[name] = room;
    }

    void forget_unused_rooms() {
        unused_rooms.expires_after(kRoomKept);
        unused_rooms.async_wait([this](boost::system::error_code stopped) {
            if (stopped) return;
            // Connections that have said no hello yet hold theirs, too.
            std::erase_if(registry.rooms, [](const auto& entry) { return entry.second.use_count() == 1; });
            forget_unused_rooms();
        });
    }

    void listen() {
        const tcp::endpoint endpoint(asio::ip::make_address(options.listen.host), options.listen.port);
        boost::system::error_code error;
        acceptor.open(endpoint.protocol(), error);
        if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
        if (!error) acceptor.bind(endpoint, error);
        if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
        if (error)
            throw std::runtime_error("cannot listen at " + options.listen.host + ":" +
                                     std::to_string(options.listen.port) + ": " + error.message() +
                                     "; choose another with --listen ADDR:PORT");
    }

    /// A page comes with several connections, and some are only half made: more than there may be clients.
    /// Beyond loopback, one address may not take them all; on loopback the clients of a proxy share one.
    void limit_connections() {
        constexpr std::size_t kOfOne = 64, kOthers = 1024, kForEachClient = 4, kFiles = 64;
        const std::size_t most = kOthers + kForEachClient * options.max_clients;
        registry.limit.emplace(
            most, is_loopback(options.listen.host) ? most : kOfOne + kForEachClient * options.max_clients);
        allow_descriptors(most + kFiles);
    }

    void accept() {
        acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
            if (registry.stopping) return;
            if (!error) {
                admit(std::move(socket));
                return accept();
            }
            // Out of descriptors, say: trying again at once would spin.
            observe::log_warning("accept_failed", {{"reason", error.message()}});
            accept_pause.expires_after(100ms);
            accept_pause.async_wait([this](boost::system::error_code stopped) {
                if (!stopped) accept();
            });
        });
    }

    void admit(tcp::socket socket) {
        boost::system::error_code gone;
        const tcp::endpoint peer = socket.remote_endpoint(gone);
        if (gone) return;
        if (auto place = registry.limit->enter(peer.address()))
            serve_http(std::move(socket), *std::move(place), registry);
        else if (!options.tls)
            reject_connection(std::move(socket));
    }

    // --- signals

    void wait_for_signals() {
        signals.async_wait([this](boost::system::error_code error, int signal) {
            if (error) return;
            if (signal != SIGHUP || !options.tls || options.tls->authority()) return stop();
            reload_certificates();
            wait_for_signals();
        });
    }

    void reload_certificates() {
        try {
            options.tls->reload();
            observe::log_info("certificates_reloaded", {});
        } catch (const std::runtime_error& error) {
            observe::log_warning("certificates_kept", {{"reason", error.what()}});
        }
    }

    // --- the end

    void stop() {
        if (std::exchange(registry.stopping, true)) return;
        for (const auto& [name, room] : registry.rooms) room->engine->stop();
        unused_rooms.cancel();
        acceptor.close();
        accept_pause.cancel();
        signals.cancel();
        for (Connection* connection : registry.connections)
            connection->close(boost::beast::websocket::close_code::going_away, "the server is shutting down");
        // Whoever has not said goodbye by then is left standing.
        deadline.expires_after(!registry.connections.empty() ? 2000ms : 0ms);
        deadline.async_wait([this](boost::system::error_code) { context.stop(); });
        wait_for_goodbyes();
    }

    void wait_for_goodbyes() {
        if (registry.connections.empty()) return context.stop();
        goodbye.expires_after(10ms);
        goodbye.async_wait([this](boost::system::error_code) { wait_for_goodbyes(); });
    }

    ServerOptions options;
    observe::Metrics metrics;
    ConnectionRegistry registry;  // before the context: what waits there still knows it at the end
    asio::io_context context{1};
    tcp::acceptor acceptor;
    asio::steady_timer accept_pause;
    asio::signal_set signals;
    asio::steady_timer deadline, goodbye{context}, unused_rooms{context};
    std::optional<std::string> failure;
};

Server::Server(ServerOptions options, scenes::LoadedScene scene, const engine::FrameRendererFactory& renderer)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(scene), renderer)) {}
Server::Server(ServerOptions options, RemoteRooms rooms)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(rooms))) {}
Server::Server(ServerOptions options, Monitored monitored)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(monitored))) {}
Server::~Server() = default;

std::uint16_t Server::port() const { return impl_->acceptor.local_endpoint().port(); }
std::string Server::description() const {
    const auto room = impl_->registry.rooms.find("");
    return room == impl_->registry.rooms.end() ? "" : room->second->engine->description();
}
observe::Metrics& Server::metrics() { return impl_->metrics; }

engine::RoomEngine& Server::engine() { return *impl_->registry.rooms.at("")->engine; }

void Server::heed_signals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) impl_->signals.add(signal);
    impl_->wait_for_signals();
}

void Server::run() {
    impl_->accept();
    impl_->context.run();
    if (impl_->failure) throw std::runtime_error("drawing has failed: " + *impl_->failure);
}

void Server::stop() {
    asio::post(impl_->context, [this] { impl_->stop(); });
}

}  // namespace vrut::server::net
