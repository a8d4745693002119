#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// What travels between clients and the server. PROTOCOL.md tells what each message means; the structs here
/// have its members under its names.
namespace vrut::protocol {

inline constexpr int kVersion = 1;
inline constexpr const char* kSubprotocol = "vrut-preview.v1";
inline constexpr std::size_t kMaxMessageBytes = 65'536;
inline constexpr int kMaxDepth = 32;
inline constexpr int kMaxGrants = 2;
/// Highest message id and revision: 2^53 - 1, exact in JSON.
inline constexpr std::int64_t kMaxInteger = (std::int64_t{1} << 53) - 1;

enum class Role { control, view, host };

// --- client to server

struct Hello {
    Role role = Role::view;
    std::string name, token;
};

struct Resize {
    double width = 1280, height = 720;  ///< CSS pixels
    double pixel_ratio = 1;
    bool operator==(const Resize&) const = default;
};

struct FrameGrant {};

struct Modifiers {
    bool ctrl = false, shift = false, alt = false, meta = false;
};

struct Pointer {
    enum class Event { down, move, up, cancel };
    enum class Type { mouse, touch, pen };
    Event event = Event::move;
    std::int64_t pointer_id = 0;
    Type pointer_type = Type::mouse;
    double x = 0, y = 0;
    int button = -1;
    unsigned buttons = 0;
    Modifiers modifiers;
    std::optional<double> time_stamp;
    std::optional<std::int64_t> frame;
};

struct Wheel {
    double x = 0, y = 0, delta_x = 0, delta_y = 0;
    int delta_mode = 0;  ///< 0 pixels, 1 lines, 2 pages
    Modifiers modifiers;
    std::optional<double> time_stamp;
};

struct Key {
    bool down = true;
    std::string key, code;
    Modifiers modifiers;
    std::optional<double> time_stamp;
};

/// A merge patch on the state document, not yet looked into (see patched() in state.hpp).
struct Patch {
    std::shared_ptr<const nlohmann::json> patch;
    std::optional<std::int64_t> if_revision;
};

/// Moves for scripts, done in this order; navigation speeds do not apply.
struct Navigate {
    std::array<double, 2> rotate{0, 0};  ///< degrees as if dragged right and down
    std::array<double, 2> pan{0, 0};     ///< fractions of the view's height, right and down
    double zoom = 1;                     ///< divides the distance from eye to focus
};

struct Fit {
    std::optional<std::int64_t> node;  ///< none: the whole scene
};

struct Control {
    bool take = true;  ///< and keep; else release
};

/// What is under a point of the view, as a frame showed it.
struct Pick {
    enum class Then { nothing, select, center, look_at };
    double x = 0, y = 0;                ///< CSS pixels
    std::optional<std::int64_t> frame;  ///< none: the newest
    Then then = Then::nothing;
    bool through = false;  ///< transparent parts are passed
};

struct ClientMessage {
    std::optional<std::int64_t> id;
    std::variant<Hello, Resize, FrameGrant, Pointer, Wheel, Key, Patch, Navigate, Fit, Control, Pick> payload;
};

// --- server to client

struct Limits {
    std::size_t max_message = kMaxMessageBytes;
    int max_depth = kMaxDepth;
    int max_grants = kMaxGrants;
    std::int64_t max_pixels = 0;
    int messages_per_second = 0;
    std::size_t max_server_message = 0;
};

struct Welcome {
    std::string server;  ///< the program's version
    std::string client;
    Role role = Role::view;
    Limits limits;
};

struct Ok {
    std::int64_t id = 0;
    std::int64_t revision = 0;
};

struct Picked {
    struct Hit {
        std::int64_t node = 0;
        std::string name;
        std::vector<std::string> path;   ///< names from the root, the last 32
        glm::dvec3 point{0}, normal{0};  ///< world; the normal is geometric, unit, towards the viewer
        double distance = 0;             ///< from the eye
    };
    std::int64_t id = 0;
    std::optional<Hit> hit;
};

/// One sentence for a person that names the culprit, and a code for a program.
struct Error {
    std::optional<std::int64_t> id;
    std::string code, message;
};

namespace error_code {
inline constexpr const char *bad_message = "bad-message", *out_of_range = "out-of-range",
                            *unknown_member = "unknown-member", *read_only = "read-only",
                            *unknown_node = "unknown-node", *unknown_frame = "unknown-frame",
                            *stale_revision = "stale-revision", *not_in_control = "not-in-control",
                            *not_allowed = "not-allowed", *too_many = "too-many", *failed = "failed";
}  // namespace error_code

}  // namespace vrut::protocol
