#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "messages.hpp"

/// What the server answers and tells (SERVER_MESSAGES.md).
namespace vrut::protocol {

struct Limits {
    std::size_t max_message = kMaxMessageBytes;
    int max_depth = kMaxDepth;
    int max_grants = kMaxGrants;
    std::int64_t max_pixels = 0;
    int messages_per_second = 0;
    std::size_t max_server_message = kMaxServerMessageBytes;
};

/// What a client needs to foretell what input does to the view.
struct InputRules {
    glm::dvec3 wheel_steps{1};  ///< what is one step, in pixels, lines and pages
    double wheel_zoom = 1;      ///< a step away from the user divides the distance by it
    double drag_zoom = 1;       ///< and so does a zooming drag over the view's height, upwards
    /// What a drag does by the buttons held, as of `PointerEvent.buttons`: `rotate`, `pan`, `zoom`. By
    /// navigation style, of those in which no key has a part in it.
    std::map<std::string, std::map<std::string, std::string>> drags;
    std::vector<std::string> keys;            ///< `KeyboardEvent.key` of those with a meaning
    std::vector<std::string> repeating_keys;  ///< of these, those that go on while they are held
};

struct Welcome {
    static constexpr const char* kType = "welcome";
    int version = kVersion;
    std::string server;  ///< the program's version
    std::string client;
    Role role = Role::view;
    Limits limits;
    InputRules input;
    std::optional<std::int64_t> id = {};  ///< of the `hello`, where it had one
};

struct Ok {
    static constexpr const char* kType = "ok";
    std::int64_t id = 0;
    std::int64_t revision = 0;
    std::optional<std::string> name;  ///< of the event log
};

struct Snapped {
    Feature feature;
    glm::dvec3 point{0};           ///< world: the feature's first
    std::vector<glm::dvec3> line;  ///< world: what it looks like; kMaxLine
};

struct Picked {
    static constexpr const char* kType = "picked";
    std::int64_t id = 0;
    // Where something was hit:
    std::optional<std::int64_t> node;
    std::optional<std::string> name;
    std::optional<std::vector<std::string>> path;  ///< names from the root, the last 32
    std::optional<glm::dvec3> point, normal;       ///< world; the normal is geometric, towards the viewer
    std::optional<double> distance;                ///< from the eye
    std::optional<glm::dvec3> local;               ///< the point in the node's own space, where that has one
    std::optional<Snapped> snapped = {};           ///< also where nothing was hit, beside the point
};

/// What a client points at now.
struct Pointed {
    static constexpr const char* kType = "pointed";
    std::string client;
    std::optional<std::string> name;          ///< as others see it
    std::optional<glm::dvec3> point, normal;  ///< world, as Picked's; none: it points at nothing any more
};

struct Flown {
    static constexpr const char* kType = "flown";
    std::int64_t id = 0;
    bool completed = false;
};

struct TreeHinge {
    glm::dvec3 axis{0, 1, 0};  ///< unit, in the node's own space, through its origin
    double degrees = 0;        ///< signed: so far it opens
    glm::dmat4 closed{1};      ///< the node's matrix as in the file
};

struct TreeNode {
    std::int64_t id = 0;
    std::string name, type;
    std::optional<std::int64_t> parent;  ///< none: the root
    bool active = true;
    std::uint64_t children = 0;
    std::uint64_t triangles = 0;  ///< of its own geometry
    std::optional<std::int64_t> material;
    std::optional<glm::dmat4> matrix = {};  ///< as it is now; none: the identity
    std::optional<TreeHinge> hinge = {};
    // Of a switch:
    std::optional<int> active_child = {};  ///< as in the file
    std::optional<std::vector<std::string>> choices =
        {};  ///< its children's names, by rising id; kMaxChoices
};

struct TreePage {
    static constexpr const char* kType = "tree";
    std::int64_t id = 0;
    std::vector<TreeNode> nodes;
    std::optional<std::int64_t> next;  ///< `after` for the page that follows; none: this was the last
};

/// What of a list of cues does not go with the scene.
struct Checked {
    static constexpr const char* kType = "checked";
    struct Problem {
        std::optional<std::string> cue;  ///< none: the whole list
        std::string message;
        bool operator==(const Problem&) const = default;
    };
    std::int64_t id = 0;
    std::vector<Problem> problems;
    std::vector<std::string> fitting;  ///< names of the cues that have none
};

struct SceneList {
    static constexpr const char* kType = "scenes";
    std::int64_t id = 0;
    std::vector<std::string> scenes;  ///< names for `open`, sorted
};

/// Where others open the page, to watch only.
struct SharedAddress {
    static constexpr const char* kType = "shared";
    std::int64_t id = 0;
    std::string address;
    std::vector<std::string> qr;  ///< it as a QR code: rows of 0 (light) and 1 (dark), without a quiet zone
    bool loopback = false;        ///< no other machine reaches it
};

/// How far the loading of a scene is; once at the end either `done` or `refused`.
struct Loading {
    static constexpr const char* kType = "loading";
    std::string scene;
    double fraction = 0;
    std::optional<bool> done;
    std::optional<std::string> refused;  ///< a sentence
};

/// What the server measures.
struct Stats {
    static constexpr const char* kType = "stats";
    struct Renderer {
        double mean_render_ms = 0, median_render_ms = 0, p95_render_ms = 0;  ///< of the last 100 frames
    };
    struct Host {
        std::string name;
        std::int64_t revision = 0;     ///< that it shows
        std::optional<double> lag_ms;  ///< from that revision's making to its report
    };
    std::optional<Renderer> renderer;  ///< none before the first frame
    std::optional<Quality> quality;    ///< of the newest frame
    std::map<std::string, Host> hosts;
    int clients = 0, watchers = 0;
    double frames_per_second = 0, bytes_per_second = 0;
};

/// All that the server says in text, but `state` and `patch` (StateDocument). A new type is a struct here,
/// with its word in `type` and its members, and their description (server_descriptions.hpp).
using ServerMessage = std::variant<Welcome, Ok, Picked, Pointed, Flown, TreePage, Checked, SceneList,
                                   SharedAddress, Loading, Stats, Error>;

}  // namespace vrut::protocol
