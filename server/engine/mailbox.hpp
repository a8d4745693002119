#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "engine/link.hpp"
#include "engine/picture.hpp"
#include "message_table.hpp"
#include "room/answers.hpp"
#include "scenes/loader.hpp"

namespace vrut::server::engine {

/// MessageReceived::sequence begins behind that of `hello`.
inline constexpr std::uint64_t kHelloSequence = 1;

struct ClientJoined {
    std::string client;
    protocol::Role role = protocol::Role::view;
    std::string name;
    std::int64_t id = 0;                      ///< of its `hello`; 0: it had none
    std::string resume_key = {};              ///< see room::Steering::join
    std::string token = {};                   ///< as it gave it
    std::uint64_t sequence = kHelloSequence;  ///< of its last message that was handled, here or elsewhere
};

struct ClientLeft {
    std::string client;
};

struct MessageReceived {
    std::string client;
    tl::expected<protocol::ClientMessage, protocol::Error> message;  ///< or why it cannot be read
    base::Clock::time_point arrival;
    std::size_t bytes = 0;        ///< on the wire, merged ones summed
    bool may_steer = true;        ///< else its moves are not merged: each is answered as wrong
    std::uint64_t sequence = 0;   ///< of this client's messages, from 1
    std::string unreadable = {};  ///< the text of one that cannot be read

    bool is_request() const {
        return !message || protocol::traits_of(*message).weight == protocol::Weight::request;
    }
};

/// A client may be sent frames newer than one, over a link like that. It takes the place of what it wanted
/// before.
struct FramesWanted {
    std::string client;
    std::int64_t newer_than = 0;       ///< number of the newest frame that it was sent; 0: none
    int count = 0;                     ///< at most so many; 0: none now
    std::uint64_t since_sequence = 0;  ///< they show what its messages up to this one did
    std::optional<Link> link = {};     ///< none: not measured yet
    bool depth = false;                ///< with depth
    bool only_warped = false;          ///< whoever gets them draws them from other cameras, by depth
    bool operator==(const FramesWanted&) const = default;
};

/// A live frame was encoded.
struct FrameEncoded {
    std::int64_t frame = 0;
    double encode_ms = 0;
    std::size_t bytes = 0;        ///< with those of its depth
    std::size_t depth_bytes = 0;  ///< 0: it was not made for this one
};

/// A picture could not be encoded.
struct PictureFailed {
    Picture picture;
    std::string why;
};

struct SnapshotSent {
    std::string client;
};

/// Somebody who is no client wants a picture.
struct PictureAsked {
    std::string name;               ///< that the picture shall have as its `client`
    int width = 0, height = 0;      ///< 0: the view's
    protocol::OtherView view = {};  ///< of another view than the present one
};

/// Another server draws the room: what it did, which is done here likewise, until TakeOver.
struct FollowFrom {
    std::shared_ptr<const room::Checkpoint> checkpoint;
    std::shared_ptr<const scenes::LoadedScene> scene;
};
struct Follow {
    protocol::LogLine line;
    std::shared_ptr<const scenes::LoadedScene> scene = nullptr;  ///< of an `opened`
};
/// From here on this server draws the room, under this lease. Where it does already, only that is new. Other
/// events have to wait for `done`, on the render thread: those
/// of clients would not wait for what is followed.
struct TakeOver {
    std::uint64_t lease = 0;
    std::map<std::string, std::uint64_t> sequences;  ///< of the clients' last messages that were followed
    std::function<void()> done;
};

/// Work on files is done: what the render thread does with its result.
struct FileWorkDone {
    std::function<void()> use;
};

using EngineEvent = std::variant<ClientJoined, ClientLeft, MessageReceived, FramesWanted, SnapshotSent,
                                 FrameEncoded, PictureFailed, PictureAsked, scenes::SceneLoading,
                                 scenes::SceneLoaded, FileWorkDone, FollowFrom, Follow, TakeOver>;

/// The one way into the render thread. Of a client's moves without `touched` that come one after the other
/// the last of each pointer is kept, and of what it wants the newest; nothing else is merged or dropped.
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
