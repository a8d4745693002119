#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "engine/pacing.hpp"
#include "messages.hpp"
#include "scene/loader.hpp"

namespace vrut::server::engine {

struct ClientJoined {
    std::string client;
    protocol::Role role = protocol::Role::view;
    std::string name;
    std::int64_t id = 0;  ///< of its `hello`; 0: it had none
};

struct ClientLeft {
    std::string client;
};

struct ClientSaid {
    std::string client;
    tl::expected<protocol::ClientMessage, protocol::Error> message;  ///< or why it cannot be read
    base::Clock::time_point arrival;
    std::size_t bytes = 0;  ///< on the wire, merged ones summed
    bool may_steer = true;  ///< else its moves are not merged: each is answered as wrong
    bool has_frame = true;  ///< the newest frame sent may have arrived
    bool is_late = true;    ///< frames were last longer on their way than over a quick link

    /// Anything but input and grants, of which there may be thousands a second.
    bool is_request() const {
        return !message || !(std::holds_alternative<protocol::Pointer>(message->payload) ||
                             std::holds_alternative<protocol::Wheel>(message->payload) ||
                             std::holds_alternative<protocol::Key>(message->payload) ||
                             std::holds_alternative<protocol::FrameGrant>(message->payload));
    }
};

/// A frame was handed to its client's socket: the promised one, or a newer one.
struct FrameSent {
    std::string client;
    std::int64_t frame = 0;
    int unused_grants = 0;  ///< where it is one frame for two grants
    double encode_ms = 0;
    std::optional<base::Clock::time_point> newest_input{};  ///< that it shows
    base::Clock::duration round_trip{};                     ///< there and back, the least that was seen
};

struct SnapshotSent {
    std::string client;
};

/// Somebody who is no client wants the present picture.
struct PictureAsked {
    std::string name;           ///< that the picture shall have as its `client`
    int width = 0, height = 0;  ///< 0: the view's
};

/// Work on files is done: what the render thread does with its result.
struct FileWorkDone {
    std::function<void()> use;
};

using EngineEvent = std::variant<ClientJoined, ClientLeft, ClientSaid, FrameSent, SnapshotSent, PictureAsked,
                                 scene::SceneLoading, scene::SceneLoaded, FileWorkDone>;

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
    std::size_t size() const;
    /// Empties the mailbox; waits for an event, a wake, the end, or `until` first.
    std::vector<EngineEvent> wait(std::optional<base::Clock::time_point> until);

private:
    mutable std::mutex mutex_;
    std::condition_variable condition_;
    std::vector<EngineEvent> events_;
    bool woken_ = false, closed_ = false;
};

}  // namespace vrut::server::engine
