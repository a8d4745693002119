#pragma once

#include <optional>
#include <string>

namespace vrut::server::net {

struct ConnectionRegistry;
struct ServedRoom;

/// The answers of /healthz, /readyz and /metrics, made on the net thread, which is alive where it answers.

/// A sentence that names a thread which has something to do and does not come round; none where all do.
std::optional<std::string> why_unhealthy(const ConnectionRegistry& registry);
/// Why no pictures can be had now; none where they can.
std::optional<std::string> why_unready(const ConnectionRegistry& registry);
std::optional<std::string> why_unready(const ServedRoom& room);
/// As Metrics::text().
std::string metrics_text(const ConnectionRegistry& registry);

}  // namespace vrut::server::net
