#include "net/monitoring.hpp"

#include "net/registry.hpp"

namespace vrut::server::net {

std::optional<std::string> why_unhealthy(const Hub& hub) {
    for (const auto& [loop, silence] : hub.engine->silences())
        if (silence > hub.longest_silence)
            return "the " + std::string(loop) + " loop has not come round for " +
                   std::to_string(std::chrono::duration_cast<std::chrono::seconds>(silence).count()) + " s";
    return std::nullopt;
}

std::optional<std::string> why_unready(const Hub& hub) {
    if (hub.stopping) return "the server is shutting down";
    // The engine hands over its first document when a first picture has been drawn.
    if (!hub.document) return "no scene is drawn yet";
    if (!hub.engine->draws()) return "the graphics driver is being started again";
    return std::nullopt;
}

std::string metrics_text(const Hub& hub) {
    return hub.metrics->text(
        {!why_unhealthy(hub), !why_unready(hub), hub.engine->description(), hub.engine->events_waiting()});
}

}  // namespace vrut::server::net
