#include "commands/network.hpp"

#include <csignal>
#include <iostream>
#include <stdexcept>

#include "observe/log.hpp"
#include "scenes/state_folder.hpp"

namespace vrut::server::commands {

namespace {

std::string url(const std::string& host, std::uint16_t port, bool secure, const std::string& path,
                const std::string& token) {
    return net::page_address(host, port, secure) + path +
           (token.empty() ? "" : "#token=" + net::percent_encoded(token));
}

/// Null where HTTP alone is spoken. Throws std::runtime_error.
std::shared_ptr<net::Tls> tls_of(const NetworkArguments& arguments) {
    if (!arguments.tls_cert.empty()) return std::make_shared<net::Tls>(arguments.tls_cert, arguments.tls_key);
    if (!arguments.lan) return nullptr;
    const std::filesystem::path folder = scenes::state_folder();
    if (folder.empty())
        throw std::runtime_error(
            "--lan: there is no folder for its certificate authority: neither XDG_STATE_HOME nor HOME is "
            "set");
    return std::make_shared<net::Tls>(net::CertificateAuthority(folder / "authority.pem"));
}

void print_addresses(const net::ServerOptions& options, std::uint16_t port, const std::string& path) {
    const net::Access& access = options.access;
    const bool secure = options.tls != nullptr;
    const std::string& token = access.control_token.empty() ? access.view_token : access.control_token;
    const std::vector<std::string> hosts = net::page_hosts(options.listen.host);
    if (!net::is_loopback(hosts[0])) {
        std::cout << net::qr_code(url(hosts[0], port, secure, path, token))
                  << "Scan it with the tablet, or open the address.\n";
        if (!access.control_token.empty() && !access.view_token.empty())
            std::cout << "To watch without steering: " << url(hosts[0], port, secure, path, access.view_token)
                      << "\n";
        if (secure && options.tls->authority())
            std::cout << "The first time, open " << net::page_address(hosts[0], port, false)
                      << "trust on it. The authority that it will trust has the fingerprint (SHA-256)\n"
                      << options.tls->authority()->fingerprint() << "\n";
    }
    for (const std::string& host : hosts)
        std::cout << "listening on " << url(host, port, secure && !net::is_loopback(host), path, token)
                  << std::endl;
    // In a container, the host's own address is the only one of these that may lead to it.
    if (net::is_any(options.listen.host) && !net::is_loopback(hosts[0]))
        std::cout << "and for this machine on " << url("127.0.0.1", port, false, path, token) << std::endl;
}

/// Whoever asks again for an end that has begun does not change what it is.
void ignore_further_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // those that come stay pending; this thread is the last
}

}  // namespace

net::ServerOptions server_options(const NetworkArguments& arguments) {
    std::signal(SIGPIPE, SIG_IGN);  // who reads its output may go, and the server stays
    net::ServerOptions options;
    options.listen = net::parse_listen_address(arguments.listen);
    options.max_clients = arguments.max_clients;
    options.tls = tls_of(arguments);
    options.access = net::read_access(arguments.token_file);
    for (const std::string& origin : arguments.allowed_origins) {
        const auto normalized = net::normalized_origin(origin);
        if (!normalized)
            throw std::runtime_error("--allow-origin: '" + origin +
                                     "' is no origin: give scheme, host and, if need be, port alone, as "
                                     "https://preview.example:8443");
        options.access.allowed_origins.push_back(*normalized);
    }
    return options;
}

void announce(net::Server& server, const net::ServerOptions& options, const std::string& path) {
    server.heed_signals();  // before the address is printed: from then on somebody may stop it
    print_addresses(options, server.port(), path);
    observe::log_info("listening", {{"host", options.listen.host}, {"port", std::uint64_t{server.port()}}});
}

void end_serving() {
    ignore_further_signals();
    observe::log_info("shut_down", {});
}

void run(net::Server& server, const net::ServerOptions& options, const std::string& path) {
    announce(server, options, path);
    server.run();
    end_serving();
}

}  // namespace vrut::server::commands
