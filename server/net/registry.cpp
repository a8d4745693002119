#include "net/registry.hpp"

#include <algorithm>

#include "net/connection.hpp"

namespace vrut::server::net {

namespace {

constexpr std::size_t kMostHeld = std::size_t{128} << 20;  // bytes

}  // namespace

void bound_backlog(ConnectionRegistry& registry) {
    std::size_t held = registry.metrics->bytes_held;
    if (held <= kMostHeld) return;
    // What was being sent to those who were cut is given up soon.
    for (const Connection* connection : registry.connections)
        if (connection->is_dropped()) held -= std::min(held, connection->backlog());
    while (held > kMostHeld && !registry.clients.empty()) {
        const auto most =
            std::max_element(registry.clients.begin(), registry.clients.end(),
                             [](auto& a, auto& b) { return a.second->backlog() < b.second->backlog(); });
        const std::shared_ptr<Connection> connection = most->second;
        if (connection->backlog() == 0) return;
        held -= std::min(held, connection->backlog());
        connection->drop("backlog");
    }
}

}  // namespace vrut::server::net
