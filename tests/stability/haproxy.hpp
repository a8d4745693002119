#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>

namespace vrut::stability {

/// HAProxy in front of a server on loopback, by deploy/haproxy.cfg: its defaults, timeouts, buffers and rules
/// as they stand there, but without TLS, user and log. Throws std::runtime_error where it cannot be started.
class HaProxy {
public:
    static bool is_installed();

    explicit HaProxy(std::uint16_t server_port);
    ~HaProxy();
    HaProxy(const HaProxy&) = delete;
    HaProxy& operator=(const HaProxy&) = delete;

    std::uint16_t port() const { return port_; }

private:
    std::filesystem::path configuration_;
    std::uint16_t port_ = 0;
    pid_t process_ = 0;
};

}  // namespace vrut::stability
