#pragma once

#include <array>
#include <chrono>
#include <string>

#include "nats/connection.hpp"

namespace vrut::server::nats {

/// How many NATS servers keep a stream or a bucket: the first number that there are servers for.
inline constexpr std::array kReplicas{3, 1};

/// Whether it may be tried with fewer replicas: not where NATS has not answered.
bool has_refused(natsStatus status);

struct Stream {
    std::string name, subject;
    jsRetentionPolicy retention = js_LimitsPolicy;
    std::chrono::nanoseconds kept{0};  ///< how long a message is kept; 0: without end
};

/// Makes it if it is not there. Throws std::runtime_error where it cannot be made.
void add_stream(const Connection& connection, const Stream& stream);

}  // namespace vrut::server::nats
