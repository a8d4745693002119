#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "nats/connection.hpp"

namespace vrut::server::nats {

/// The subject of what edges send to the server of a room, and that of what the server sends to them.
std::string subject_to(const std::string& room);
std::string subject_from(const std::string& room);

/// A line of JSON, and the bytes that follow it.
struct Packet {
    std::string json;
    std::vector<std::uint8_t> bytes = {};
};

/// Sends packets from a thread of its own, so that nobody waits for NATS. While the connection is lost what
/// is posted is made and dropped. A large packet goes in parts.
class Outbox {
public:
    using Make =
        std::function<std::optional<Packet>()>;  ///< on that thread, in the order of posts; none: nothing

    Outbox(const Connection& connection, std::string subject);
    ~Outbox();
    Outbox(const Outbox&) = delete;
    Outbox& operator=(const Outbox&) = delete;

    /// From any thread. If more than 4096 wait, the oldest is dropped unmade.
    void post(Make make);

private:
    void run(const std::stop_token& stop);
    void send(const Packet& packet);

    const Connection& connection_;
    const std::string subject_;
    std::mutex mutex_;
    std::condition_variable_any posted_;
    std::deque<Make> waiting_;
    std::uint64_t next_packet_ = 1;
    std::jthread thread_;  // last: it uses all of the above
};

/// Receives packets of any number of outboxes. To be used on one thread.
class Inbox {
public:
    Inbox(const Connection& connection, const std::string& subject);
    /// The next one, or none within `patience`. What is no whole packet is dropped.
    std::optional<Packet> next(std::chrono::milliseconds patience);

private:
    struct Incomplete {
        std::size_t next_part = 0, parts = 0;
        std::string body;
    };
    std::optional<std::string> complete(natsMsg* message);

    const Connection& connection_;
    Subscription subscription_;
    std::map<std::string, Incomplete> incomplete_;  ///< by sender
};

}  // namespace vrut::server::nats
