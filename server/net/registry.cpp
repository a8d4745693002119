#include "net/registry.hpp"

#include <algorithm>

#include "net/connection.hpp"

namespace vrut::server::net {

namespace {

constexpr std::size_t kMostHeld = std::size_t{256} << 20;  // bytes

}  // namespace

Text held_text(std::string text, observe::Metrics& metrics) {
    Text counted(new std::string(std::move(text)), [&metrics](const std::string* held) {
        metrics.bytes_held -= held->capacity();
        delete held;
    });
    metrics.bytes_held += counted->capacity();
    return counted;
}

void bound_backlog(Hub& hub) {
    std::size_t held = hub.metrics->bytes_held;
    if (held <= kMostHeld) return;
    // What was being sent to those who were cut is given up soon.
    for (const Session* session : hub.connections)
        if (session->is_dropped()) held -= std::min(held, session->backlog());
    while (held > kMostHeld && !hub.sessions.empty()) {
        const auto most = std::max_element(hub.sessions.begin(), hub.sessions.end(), [](auto& a, auto& b) {
            return a.second->backlog() < b.second->backlog();
        });
        const std::shared_ptr<Session> session = most->second;
        if (session->backlog() == 0) return;
        held -= std::min(held, session->backlog());
        session->drop("backlog");
    }
}

}  // namespace vrut::server::net
