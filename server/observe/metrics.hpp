#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "codec.hpp"

namespace vrut::server::observe {

using Counter = std::atomic<std::uint64_t>;

/// A counter for each of a few words. What is none of them counts as the last.
template <const auto& kWords>
class Counters {
public:
    Counter& operator[](std::string_view word) { return counts_[place_of(word)]; }
    const Counter& operator[](std::string_view word) const { return counts_[place_of(word)]; }
    const Counter& at(std::size_t word) const { return counts_[word]; }
    std::uint64_t sum() const {
        std::uint64_t sum = 0;
        for (const Counter& count : counts_) sum += count;
        return sum;
    }

private:
    static std::size_t place_of(std::string_view word) {
        std::size_t i = 0;
        while (i + 1 < kWords.size() && word != kWords[i]) ++i;
        return i;
    }

    std::array<Counter, kWords.size()> counts_{};
};

/// How many times something took how long.
class Histogram {
public:
    /// Seconds; a bucket ends at each, and counts it in. The last one is without end.
    static constexpr std::array kBounds{0.0005, 0.001, 0.002, 0.004, 0.008, 0.016, 0.033, 0.05,
                                        0.1,    0.2,   0.5,   1.0,   2.0,   5.0,   10.0};
    using Counts = std::array<std::uint64_t, kBounds.size() + 1>;

    void observe(double seconds);
    Counts counts() const;  ///< of each bucket by itself
    double sum() const { return static_cast<double>(nanoseconds_) * 1e-9; }

private:
    std::array<Counter, kBounds.size() + 1> counts_{};
    Counter nanoseconds_{0};
};

inline constexpr std::array kRoles{"control", "view", "host"};
/// Why WebSocket connections ended: the client said goodbye; the handshake failed; no `hello` or more than
/// one; its token was wrong; too many clients; a message that was too large, or binary, or no WebSocket
/// frame; it took nothing for 10 s, or too little; it was silent for 60 s; a message came too slowly; too
/// much waited for all clients, and the most for it; the server shut down; the connection was lost.
inline constexpr std::array kCloseReasons{"normal",    "handshake", "hello",    "token", "too-many",
                                          "too-large", "binary",    "protocol", "stuck", "silent",
                                          "slow",      "backlog",   "shutdown", "gone"};

/// What became of an image that a worker took: it was drawn; it could not be, and was given back; the worker
/// has not its scene, and handed it on.
inline constexpr std::array kJobResults{"drawn", "returned", "handed-on"};

/// What the server did since it started, and what is so now. Written by the thread that does it, read by any.
struct Metrics {
    Counters<kRoles> clients;  ///< connected now
    Counter clients_joined{0}, clients_left{0};
    Counter tls_handshakes_failed{0};
    Counter connections_opened{0};  ///< WebSocket connections, also those without a `hello`
    Counters<kCloseReasons> closes;
    Counter messages_received{0}, bytes_received{0};
    Counters<protocol::error_code::all> errors;
    Counter frames_granted{0};
    Counter frames_rendered_moving{0}, frames_rendered_still{0}, frames_interrupted{0};
    Counter samples_drawn{0}, readbacks{0};  ///< of all pictures, and of the one that makes drivers ready
    Counter frames_encoded{0}, bytes_encoded{0}, frames_sent{0};
    Counter frames_replaced{0};  ///< a newer picture took the place of one that waited for its client
    Counter pictures_held{0}, pictures_held_most{0};  ///< encoded pictures in memory, now and at most so far
    Counter bytes_held{0};  ///< of encoded pictures and of messages that wait; shared ones count once
    Counter snapshots_rendered{0}, snapshots_sent{0};
    Counter bytes_sent{0};
    Counters<kJobResults> jobs;
    Counter scene_nodes{0}, scene_triangles{0};
    Counter gl_objects{0};  ///< after the last picture
    Histogram render_moving, render_still, readback, encode;
    Histogram input_to_frame;  ///< from an input's arrival until the first frame that shows it is handed over
    Histogram input_to_grant;  ///< from the same until a client acknowledges the first frame that shows it

    std::uint64_t frames_rendered() const { return frames_rendered_moving + frames_rendered_still; }
    std::uint64_t messages_rejected() const { return errors.sum(); }

    /// What is not counted, but asked for.
    struct Readings {
        bool has_rooms = true;               ///< else it is a worker
        bool healthy = true, ready = true;   ///< as /healthz and /readyz say
        std::string renderer;                ///< what draws
        std::size_t events_waiting = 0;      ///< for the render thread
        std::optional<bool> nats_connected;  ///< none: it has nothing to do with NATS
        std::optional<bool> room_owner;      ///< draws its room; none: that is shared with no other server
        std::optional<std::size_t> rooms;    ///< of others, that are open; none: it serves its own
    };
    /// Prometheus' text format, version 0.0.4.
    std::string text(const Readings& readings) const;
};

}  // namespace vrut::server::observe
