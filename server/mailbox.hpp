#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "messages.hpp"
#include "pacing.hpp"

namespace vrut {

struct ClientJoined {
    std::string client;
    protocol::Role role = protocol::Role::view;
};

struct ClientLeft {
    std::string client;
};

struct ClientSaid {
    std::string client;
    protocol::ClientMessage message;
    Clock::time_point arrival;
    std::size_t bytes = 0;  ///< on the wire, merged ones summed
};

/// Grants whose frame was never sent, because one frame served two of them.
struct GrantsReturned {
    std::string client;
    int count = 0;
};

using EngineEvent = std::variant<ClientJoined, ClientLeft, ClientSaid, GrantsReturned>;

/// The one way into the render thread. Adjacent moves of one pointer become one; nothing else is merged or
/// dropped.
class Mailbox {
public:
    void push(EngineEvent event);
    /// Makes a wait end without an event.
    void wake();
    /// No more events: every wait ends at once.
    void close();
    bool closed() const;
    /// True where something waits that may change what is to be seen.
    bool has_input() const;
    /// Empties the mailbox; waits for an event, a wake, the end, or `until` first.
    std::vector<EngineEvent> wait(std::optional<Clock::time_point> until);

private:
    mutable std::mutex mutex_;
    std::condition_variable condition_;
    std::vector<EngineEvent> events_;
    bool woken_ = false, closed_ = false;
    bool has_input_ = false;
};

}  // namespace vrut
