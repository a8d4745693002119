#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "messages.hpp"

/// Messages between the server that draws a room and its edges, which serve it to clients. Each
/// message is a line of JSON; an image's bytes follow it.
namespace vrut::protocol {

/// Changes with any message that an older program would not understand.
inline constexpr int kRelayVersion = 1;

/// 1 to 32 lower-case letters, digits and hyphens.
bool is_room_name(std::string_view name);

// --- from an edge

/// A client, as it came in.
struct EdgeClient {
    std::string client;
    Role role = Role::view;  ///< asked for
    std::string token, name, resume;
    std::int64_t id = 0;        ///< of its `hello`; 0: it had none
    std::uint64_t handled = 0;  ///< of its messages: the last whose handling is known
};
/// All that the edge has, after it came, after it missed something, and when another server draws the room.
struct EdgeSync {
    int version = kRelayVersion;
    std::vector<EdgeClient> clients;
};
struct EdgeAlive {};
/// Whether a client may come in: answered by RoomAdmitted.
struct EdgeAdmission {
    std::int64_t number = 0;
    Role role = Role::view;
    std::string token;
};
struct EdgeJoined {
    EdgeClient client;
};
struct EdgeLeft {
    std::string client;
};
/// A client's message.
struct EdgeSaid {
    std::string client;
    std::uint64_t sequence = 0;  ///< of this client's, rising
    std::string text;
    bool again = false;  ///< its handling is not known, and it was sent before
};
/// Of a link without a known limit, bytes a second.
inline constexpr double kFastestLink = 1e15;
struct EdgeWanted {
    std::string client;
    std::int64_t newer_than = 0;
    int count = 0;
    std::uint64_t since_sequence = 0;
    bool depth = false, only_warped = false;
    std::optional<double> bytes_per_second, round_trip_ms;  ///< of its link; none: not measured
};
struct EdgeSnapshotSent {
    std::string client;
};
struct EdgePicture {
    std::string name;
    int width = 0, height = 0;  ///< pixels; 0: the view's
    OtherView view = {};        ///< that the picture shows
};
struct EdgeMessage {
    std::string edge;  ///< the sender
    std::variant<EdgeSync, EdgeAlive, EdgeAdmission, EdgeJoined, EdgeLeft, EdgeSaid, EdgeWanted,
                 EdgeSnapshotSent, EdgePicture>
        what;
};

// --- from the server that draws the room

struct RoomAnswer {
    std::string client, text;
    std::int64_t revision = 0;
};
struct RoomHandled {
    std::string client;
    std::uint64_t sequence = 0;  ///< of its last message that was handled
};
/// The newest that is to be said of what a client points at.
struct RoomPointed {
    std::string client, text;
};
/// For the connections of clients.
struct RoomOutput {
    std::string edge;           ///< all that this one has to know; empty: news for all
    std::string state;          ///< the text of a `state` or a `patch`; empty: unchanged
    std::int64_t from = 0;      ///< the revision from which a `patch` leads to its own; 0: it is a `state`
    std::int64_t by_since = 0;  ///< the revisions from this one on were made by the same
    std::string by;             ///< who made it
    std::vector<RoomAnswer> answers;
    bool again = false;  ///< some of them may have come before
    std::vector<std::string> failed_pictures;
    std::vector<RoomHandled> handled;
    std::optional<int> width, height;  ///< of a picture of the view; none: unchanged
    std::optional<std::int64_t> present_frame;
    std::string stats, loading;  ///< texts of messages; empty: nothing new
    bool loads = false;
    std::vector<RoomPointed> pointed;
};
/// Twice a second.
struct RoomAlive {
    int version = kRelayVersion;
    std::vector<std::string> edges;  ///< that it knows
    std::string renderer;
    std::int64_t max_pixels = 0;
    int max_side = 0;
    std::string unready;  ///< why it cannot draw; empty: it can
};
struct RoomAdmitted {
    std::string edge;
    std::int64_t question = 0;  ///< EdgeAdmission::number
    std::optional<Role> role;   ///< none: it may not come in
    std::string why;            ///< it may not
};
struct RoomApplied {
    std::string client;
    std::int64_t id = 0;
    std::uint64_t sequence = 0;
};
/// Before an image's bytes.
struct RoomPicture {
    std::int64_t frame = 0, revision = 0, handled = 0;
    std::optional<std::int64_t> snapshot;
    std::string client;  ///< of one that was asked for
    ImageFormat format = ImageFormat::jpeg;
    std::string header;  ///< as of a client of whose messages it shows none
    std::int64_t header_offset = 0;
    std::int64_t depth_frame = 0, depth_bytes = 0;  ///< the last of the bytes are a map of depth; 0: none are
    std::vector<RoomApplied> applied;
    std::optional<double> newest_input_ms;  ///< by the clock of the room's server
    double idle_since_ms = 0, sent_ms = 0;
};
/// The server leaves the room.
struct RoomLeft {};
struct RoomMessage {
    std::uint64_t lease = 0;   ///< rises with each server that takes the room over
    std::uint64_t number = 0;  ///< of this lease's messages, from 1
    std::variant<RoomOutput, RoomAlive, RoomAdmitted, RoomPicture, RoomLeft> what;
};

/// What of an answer is the same whichever server gives it: its type and its `id`; empty where it has none.
std::string answer_key(std::string_view text);

/// What is said of a loading whose server is gone, given what that said last. Empty where that is no JSON
/// object.
std::string given_up_loading(std::string_view text);

std::string encode(const EdgeMessage& message);
std::string encode(const RoomMessage& message);
/// Or a sentence that tells what is wrong with the text.
tl::expected<EdgeMessage, std::string> parse_edge_message(std::string_view text);
tl::expected<RoomMessage, std::string> parse_room_message(std::string_view text);

}  // namespace vrut::protocol
