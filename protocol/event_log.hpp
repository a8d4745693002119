#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "messages.hpp"
#include "state.hpp"

/// Recorded sessions: JSON Lines, first a header, then what happened in the order in which it was applied.
/// Times are whole microseconds, written as milliseconds, so that reading gives back what was written.
namespace vrut::protocol {

using LogTime = std::chrono::microseconds;  ///< since the recording began; before that negative

/// A frame that clients may still name when recording begins.
struct LoggedFrame {
    std::int64_t frame = 0;
    CameraState camera;
    Resize view;
};

struct LogHeader {
    std::string scene, scene_sha256;
    std::optional<UpAxis> up_axis = {};           ///< none: the format defines it, or an old log
    std::string started;                          ///< ISO 8601
    std::shared_ptr<const nlohmann::json> state;  ///< the document
    struct Client {
        std::string client;
        Role role = Role::view;
        std::optional<Resize> wanted;
        std::string name = {};  ///< empty: none
        // Only where a room goes on with the log:
        std::string resume = {};     ///< its key
        std::uint64_t sequence = 0;  ///< of its last message
    };
    std::vector<Client> clients;
    // What else the camera depends on:
    Resize view;           ///< in force
    bool at_home = false;  ///< nobody has moved the camera yet
    /// The view "home" as it was at loading, which depends on the view's size then: null gives it back. None:
    /// as loading for 16:9 gives it.
    std::optional<ViewState> home;
    std::vector<LoggedFrame> frames;
    struct Flight {
        std::string client;
        std::int64_t id = 0;
        double since = 0;  ///< ms that it has lasted
        CameraState from;
        Fly fly;
    };
    std::optional<Flight> flight;  ///< that was going on
    struct Walls {
        ViewState camera, guide;
        glm::dvec3 velocity{0}, spin{0};  ///< scene units and radians a second
        double due = 0;                   ///< ms until the next step
    };
    std::optional<Walls> walls;  ///< the camera of hosts, where that was behind
    std::int64_t revision = 0;   ///< of the state; 0: not known
};

struct LogLine {
    struct Connected {
        Role role = Role::view;
        std::string name = {};    ///< empty: none
        std::string resume = {};  ///< as in the header
    };
    struct Disconnected {};
    /// From here on this line's client holds control, or nobody where it has none.
    struct ControlPassed {};
    /// A scene that was being loaded is shown from here on.
    struct Opened {
        std::string scene, sha256;
        std::string changes = {};            ///< what was kept of it: a patch of the state; empty: nothing
        std::optional<UpAxis> up_axis = {};  ///< as in the header
    };
    /// The frame of this number was drawn of what is shown now.
    struct Drawn {
        std::int64_t frame = 0;
    };
    /// What is shown now is this revision of the state. Only where a room goes on with the log.
    struct Revised {
        std::int64_t revision = 0;
        std::optional<std::vector<Notice>> notices = {};  ///< of the server; none: unchanged
        std::optional<std::string> recording = {};        ///< that goes on, empty: none does; none: unchanged
    };
    LogTime at{0};
    std::string client;  ///< empty where it was none's doing
    std::variant<ClientMessage, Connected, Disconnected, ControlPassed, Opened, Drawn, Revised> what;
    std::uint64_t sequence = 0;  ///< of this message among those of its client; 0: not known
};

/// Without the line's end.
std::string encode(const LogHeader& header);
std::string encode(const LogLine& line);
/// The error's message tells what is wrong with the line.
tl::expected<LogHeader, Error> decode_log_header(std::string_view text);
tl::expected<LogLine, Error> decode_log_line(std::string_view text);

}  // namespace vrut::protocol
