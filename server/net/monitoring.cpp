#include "net/monitoring.hpp"

#include "net/registry.hpp"

namespace vrut::server::net {

std::optional<std::string> why_unhealthy(const ConnectionRegistry& registry) {
    for (const auto& [name, room] : registry.rooms)
        for (const auto& [loop, busy] : room->engine->busy_times())
            if (busy > registry.longest_busy)
                return "the " + std::string(loop) + " loop has not come round for " +
                       std::to_string(std::chrono::duration_cast<std::chrono::seconds>(busy).count()) + " s";
    return std::nullopt;
}

std::optional<std::string> why_unready(const ConnectionRegistry& registry) {
    if (registry.stopping) return "the server is shutting down";
    return registry.why_unready();
}

std::optional<std::string> why_unready(const ServedRoom& room) {
    if (auto why = room.engine->why_unready()) return why;
    // The engine hands over its first document when a first picture has been drawn.
    if (!room.document.newest()) return "no scene is drawn yet";
    return std::nullopt;
}

std::string metrics_text(const ConnectionRegistry& registry) {
    std::string renderer = registry.renderer;
    std::size_t events_waiting = 0;
    for (const auto& [name, room] : registry.rooms) {
        if (renderer.empty()) renderer = room->engine->description();
        events_waiting += room->engine->events_waiting();
    }
    observe::Metrics::Readings readings;
    readings.has_rooms = registry.has_rooms();
    readings.healthy = !why_unhealthy(registry);
    readings.ready = !why_unready(registry);
    readings.renderer = std::move(renderer);
    readings.events_waiting = events_waiting;
    if (registry.nats_connected) readings.nats_connected = registry.nats_connected();
    if (registry.room_owner) readings.room_owner = registry.room_owner();
    if (registry.open_room) readings.rooms = registry.rooms.size();
    return registry.metrics->text(readings);
}

}  // namespace vrut::server::net
