#include <algorithm>
#include <csignal>
#include <iostream>
#include <latch>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include "commands/commands.hpp"
#include "engine/images.hpp"
#include "net/server.hpp"
#include "observe/log.hpp"
#include "observe/progress.hpp"
#include "scenes/change_store.hpp"
#include "scenes/library.hpp"
#include "scenes/state_folder.hpp"

namespace vrut::server::commands {

namespace {

std::string url(const std::string& host, std::uint16_t port, bool secure, const std::string& token) {
    return net::page_address(host, port, secure) +
           (token.empty() ? "" : "#token=" + net::percent_encoded(token));
}

/// An empty path stays one. Throws std::runtime_error where there is no such folder.
std::filesystem::path existing_folder(const std::string& option, const std::filesystem::path& path) {
    if (!path.empty() && !std::filesystem::is_directory(path))
        throw std::runtime_error(option + ": there is no folder " + path.string());
    return path;
}

/// Null where HTTP alone is spoken. Throws std::runtime_error.
std::shared_ptr<net::Tls> tls_of(const ServeArguments& arguments) {
    if (!arguments.tls_cert.empty()) return std::make_shared<net::Tls>(arguments.tls_cert, arguments.tls_key);
    if (!arguments.lan) return nullptr;
    const std::filesystem::path folder = scenes::state_folder();
    if (folder.empty())
        throw std::runtime_error(
            "--lan: there is no folder for its certificate authority: neither XDG_STATE_HOME nor HOME is "
            "set");
    return std::make_shared<net::Tls>(net::CertificateAuthority(folder / "authority.pem"));
}

void announce(const net::ServerOptions& options, std::uint16_t port) {
    const net::Access& access = options.access;
    const bool secure = options.tls != nullptr;
    const std::string& token = access.control_token.empty() ? access.view_token : access.control_token;
    const std::vector<std::string> hosts = net::page_hosts(options.listen.host);
    if (!net::is_loopback(hosts[0])) {
        std::cout << net::qr_code(url(hosts[0], port, secure, token))
                  << "Scan it with the tablet, or open the address.\n";
        if (!access.control_token.empty() && !access.view_token.empty())
            std::cout << "To watch without steering: " << url(hosts[0], port, secure, access.view_token)
                      << "\n";
        if (secure && options.tls->authority())
            std::cout << "The first time, open " << net::page_address(hosts[0], port, false)
                      << "trust on it. The authority that it will trust has the fingerprint (SHA-256)\n"
                      << options.tls->authority()->fingerprint() << "\n";
    }
    for (const std::string& host : hosts)
        std::cout << "listening on " << url(host, port, secure && !net::is_loopback(host), token)
                  << std::endl;
    if (secure && net::is_any(options.listen.host))
        std::cout << "and for this machine on " << url("127.0.0.1", port, false, token) << std::endl;
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

/// Whoever asks again for an end that has begun does not change what it is.
void ignore_further_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // those that come stay pending; this thread is the last
}

}  // namespace

void serve_command(const ServeArguments& arguments) {
    std::signal(SIGPIPE, SIG_IGN);  // who reads its output may go, and the server stays
    require_threads();
    net::ServerOptions options;
    options.listen = net::parse_listen_address(arguments.listen);
    options.max_clients = arguments.max_clients;
    options.tls = tls_of(arguments);
    options.access = net::read_access(arguments.token_file);
    options.access.allowed_origins = arguments.allowed_origins;
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
    options.keep_changes = scenes::store_changes;
    const scene::Scene& read = *scene->placed->scene;
    for (const protocol::Notice& notice : scene->notices)
        observe::log_warning("notice", {{"scene", name}, {"text", notice.message}});
    observe::log_info(
        "scene_read",
        {{"file", path.string()}, {"nodes", read.nodes().size()}, {"triangles", read.triangle_count()}});
    options.record_folder = existing_folder("--record", arguments.record);

    net::Server server(options, *std::move(scene), engine::gl_renderer(arguments.device));
    server.stop_on_signals();  // before the address is told: from then on somebody may stop it
    announce(options, server.port());
    observe::log_info("listening", {{"host", options.listen.host}, {"port", std::uint64_t{server.port()}}});
    server.run();
    ignore_further_signals();
    observe::log_info("shut_down", {});
}

}  // namespace vrut::server::commands
