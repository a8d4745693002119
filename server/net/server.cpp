#include "net/server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <stdexcept>

#include "net/connection.hpp"
#include "net/descriptors.hpp"
#include "net/http_connection.hpp"
#include "net/share_address.hpp"
#include "observe/log.hpp"

namespace vrut::server::net {

namespace asio = boost::asio;
using asio::ip::tcp;
using namespace std::chrono_literals;

struct Server::Impl {
    Impl(ServerOptions server_options, scenes::LoadedScene scene,
         const engine::FrameRendererFactory& renderer)
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
        engine::EngineCallbacks callbacks;
        callbacks.on_output = [this](engine::EngineOutput output) {
            asio::post(context, [this, moved = std::move(output)]() mutable { take(std::move(moved)); });
        };
        callbacks.on_encoded = [this](std::shared_ptr<const engine::EncodedPicture> picture) {
            asio::post(context, [this, moved = std::move(picture)]() mutable { take(std::move(moved)); });
        };
        callbacks.on_failure = [this](const std::string& why) {
            asio::post(context, [this, why] {
                failure = why;
                stop();
            });
        };
        engine::EngineOptions engine_options{std::move(scene), options.library, options.record_folder,
                                             options.keep_changes,
                                             share_address(options.listen, acceptor.local_endpoint().port(),
                                                           options.tls != nullptr, options.access)};
        engine = std::make_unique<engine::Engine>(std::move(engine_options), renderer, metrics,
                                                  std::move(callbacks));
        registry.engine = engine.get();
    }

    ~Impl() {
        registry.newest.reset();
        registry.pictures.stop();
        registry.clients.clear();
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

    // --- what the engine says, on the net thread

    Connection* find(const std::string& client) {
        const auto connection = registry.clients.find(client);
        return connection == registry.clients.end() ? nullptr : connection->second.get();
    }

    void take(engine::EngineOutput output) {
        if (output.document) {
            registry.document.set(std::move(output.document), std::move(output.by), output.by_since);
            registry.pictures.forget_before(registry.document.newest()->revision());
        }
        if (output.stats) registry.stats = std::move(output.stats);
        if (output.loading) {
            registry.loading = std::move(output.loading);
            registry.loads = output.loads;
        }
        if (output.size) registry.size = *output.size;
        if (output.present_frame) registry.present_frame = *output.present_frame;
        for (auto& answer : output.answers)
            if (Connection* connection = find(answer.client)) connection->answer(std::move(answer));
        for (const std::string& name : output.failed_pictures) registry.pictures.give_up(name);
        for (const auto& [client, handled] : output.handled)
            if (Connection* connection = find(client)) connection->handled(handled);
        for_each_client([](Connection& connection) { connection.pump(); });
        bound_backlog(registry);
    }

    void take(std::shared_ptr<const engine::EncodedPicture> picture) {
        if (!picture->client.empty()) return take_ordered(std::move(picture));
        const std::int64_t before = registry.newest ? registry.newest->header.frame : 0;
        registry.newest = std::move(picture);
        for_each_client([&](Connection& connection) { connection.newest_changed(before); });
    }

    void take_ordered(std::shared_ptr<const engine::EncodedPicture> picture) {
        if (registry.pictures.take(*picture)) return;
        if (Connection* connection = find(picture->client)) connection->take_snapshot(std::move(picture));
        bound_backlog(registry);
    }

    template <class Function>
    void for_each_client(Function function) {
        for (const auto& [name, connection] : registry.clients) function(*connection);
    }

    // --- the end

    void stop() {
        if (std::exchange(registry.stopping, true)) return;
        engine->stop();
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
    asio::steady_timer deadline, goodbye{context};
    std::optional<std::string> failure;
    std::unique_ptr<engine::Engine> engine;
};

Server::Server(ServerOptions options, scenes::LoadedScene scene, const engine::FrameRendererFactory& renderer)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(scene), renderer)) {}
Server::~Server() = default;

std::uint16_t Server::port() const { return impl_->acceptor.local_endpoint().port(); }
const std::string& Server::description() const { return impl_->engine->description(); }
const observe::Metrics& Server::metrics() const { return impl_->metrics; }

void Server::stop_on_signals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) impl_->signals.add(signal);
    impl_->signals.async_wait([this](boost::system::error_code error, int) {
        if (!error) impl_->stop();
    });
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
