#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>

#include "base/clock.hpp"
#include "messages.hpp"
#include "observe/metrics.hpp"
#include "server_messages.hpp"

namespace vrut::server::observe {

/// Makes the `stats` message, at most twice a second, and only after something happened.
class LiveStats {
public:
    explicit LiveStats(const Metrics& metrics) : metrics_(metrics) {}

    void joined(const std::string& client, protocol::Role role, const std::string& name,
                base::Clock::time_point now);
    void left(const std::string& client, base::Clock::time_point now);
    void drawn(const protocol::Quality& quality, double render_ms, base::Clock::time_point now);
    void made(std::int64_t revision, base::Clock::time_point now);
    /// A host's walls show `revision`.
    void shown(const std::string& client, std::int64_t revision, base::Clock::time_point now);

    /// When the next message is due; none: not before something happens.
    std::optional<base::Clock::time_point> due() const;
    /// The message, if it is due.
    std::optional<protocol::Stats> take(base::Clock::time_point now);

private:
    struct Client {
        protocol::Role role = protocol::Role::view;
        std::string name;
        std::optional<std::int64_t> shown;
        std::optional<double> lag_ms;
    };
    void happened(base::Clock::time_point now);
    std::optional<protocol::Stats::Renderer> renderer() const;

    const Metrics& metrics_;
    std::map<std::string, Client> clients_;
    std::deque<double> render_ms_;  // of the last pictures
    std::optional<protocol::Quality> quality_;
    std::deque<std::pair<std::int64_t, base::Clock::time_point>> made_;  // the last revisions
    std::optional<base::Clock::time_point> taken_at_, happened_;         // last take, last event after it
    std::uint64_t frames_ = 0, bytes_ = 0;                               // sent until the last take
};

}  // namespace vrut::server::observe
