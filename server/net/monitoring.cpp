#include "net/monitoring.hpp"

#include "net/registry.hpp"

namespace vrut::server::net {

std::optional<std::string> why_unhealthy(const ConnectionRegistry& registry) {
    for (const auto& [loop, busy] : registry.engine->busy_times())
        if (busy > registry.longest_busy)
            return "the " + std::string(loop) + " loop has not come round for " +
                   std::to_string(std::chrono::duration_cast<std::chrono::seconds>(busy).count()) + " s";
    return std::nullopt;
}

std::optional<std::string> why_unready(const ConnectionRegistry& registry) {
    if (registry.stopping) return "the server is shutting down";
    // The engine hands over its first document when a first picture has been drawn.
    if (!registry.document.newest()) return "no scene is drawn yet";
    if (!registry.engine->draws()) return "the graphics driver is being started again";
    return std::nullopt;
}

std::string metrics_text(const ConnectionRegistry& registry) {
    return registry.metrics->text({!why_unhealthy(registry), !why_unready(registry),
                                   registry.engine->description(), registry.engine->events_waiting()});
}

}  // namespace vrut::server::net
