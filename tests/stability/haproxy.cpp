#include "haproxy.hpp"

#include <netinet/in.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

namespace vrut::stability {

namespace {

const char* const kProgram = "/usr/sbin/haproxy";
constexpr int kInherited = 3;  // the descriptor of the socket that HAProxy listens at

void replace(std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::runtime_error(from + " is not in haproxy.cfg");
    text.replace(at, from.size(), to);
}

std::string configuration(std::uint16_t server_port) {
    std::ifstream file(VRUT_HAPROXY_CONFIGURATION);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    replace(text, "    log /dev/log local0 info\n", "    log stdout format raw local0 emerg\n");
    replace(text, "    user haproxy\n    group haproxy\n    chroot /var/lib/haproxy\n", "");
    replace(text, "bind :443 ssl crt /etc/haproxy/vrut-preview.pem alpn http/1.1\n",
            "bind fd@" + std::to_string(kInherited) + "\n");
    replace(text, "bind :80\n", "bind abns@vrut-" + std::to_string(server_port) + "\n");  // not used
    replace(text, "127.0.0.1:8080 ", "127.0.0.1:" + std::to_string(server_port) + " ");
    return text;
}

/// A socket that listens at a port of loopback, and the port.
std::pair<int, std::uint16_t> listening() {
    const int made = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* any = reinterpret_cast<sockaddr*>(&address);
    if (made < 0 || bind(made, any, size) != 0 || listen(made, 16) != 0 || getsockname(made, any, &size) != 0)
        throw std::runtime_error("no port can be had for HAProxy");
    return {made, ntohs(address.sin_port)};
}

pid_t start(const std::string& configuration, int listens) {
    std::string words[] = {kProgram, "-q", "-db", "-f", configuration};
    char* argv[] = {words[0].data(), words[1].data(), words[2].data(),
                    words[3].data(), words[4].data(), nullptr};
    posix_spawn_file_actions_t actions{};
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, listens, kInherited);
    pid_t process = 0;
    const int failed = posix_spawn(&process, kProgram, &actions, nullptr, argv, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw std::runtime_error("HAProxy cannot be started");
    return process;
}

}  // namespace

bool HaProxy::is_installed() { return access(kProgram, X_OK) == 0; }

HaProxy::HaProxy(std::uint16_t server_port)
    : configuration_(std::filesystem::temp_directory_path() /
                     ("vrut-haproxy-" + std::to_string(getpid()) + "-" + std::to_string(server_port))) {
    std::ofstream(configuration_) << configuration(server_port);
    const auto [listens, port] = listening();
    port_ = port;
    process_ = start(configuration_, listens);
    close(listens);
}

HaProxy::~HaProxy() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    std::error_code ignored;
    std::filesystem::remove(configuration_, ignored);
}

}  // namespace vrut::stability
