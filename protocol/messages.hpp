#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// What travels between clients and the server. CLIENT_MESSAGES.md and SERVER_MESSAGES.md tell the messages;
/// client_descriptions.hpp and server_descriptions.hpp have the names, limits and meanings of the members of
/// the structs here.
namespace vrut::protocol {

inline constexpr int kVersion = 1;
inline constexpr const char* kSubprotocol = "vrut-preview.v1";
inline constexpr std::size_t kMaxMessageBytes = 65'536;
inline constexpr std::size_t kMaxServerMessageBytes = std::size_t{64} << 20;
inline constexpr int kMaxDepth = 32;
inline constexpr int kMaxGrants = 2;
/// Bytes of a client's name.
inline constexpr std::size_t kMaxClientName = 100;
inline constexpr std::size_t kMaxSceneName = 1000;   ///< bytes
inline constexpr std::size_t kMaxCueText = 2000;     ///< bytes, for who speaks
inline constexpr std::size_t kMaxCueProblems = 200;  ///< that are listed
inline constexpr std::size_t kMaxScenes = 1000;      ///< in a list
inline constexpr std::size_t kMaxChoices = 64;       ///< of a switch whose children are named
inline constexpr std::size_t kMaxLine = 64;          ///< points of a line that measures are drawn with
/// Highest message id and revision: 2^53 - 1, exact in JSON.
inline constexpr std::int64_t kMaxInteger = (std::int64_t{1} << 53) - 1;

enum class Role { control, view, host };
enum class DrawMode { realistic, stylized };
enum class UpAxis { y, z };
enum class ImageFormat { jpeg, png };

/// One sentence for a person that names the culprit, and a code for a program.
struct Error {
    static constexpr const char* kType = "error";
    std::optional<std::int64_t> id;
    std::string code, message;
};

/// What people should know, as an Error.
struct Notice {
    std::string code, message;
    bool operator==(const Notice&) const = default;
};

namespace notice_code {
inline constexpr const char *scene = "scene",                              // of the scene's file
    *software = "software",                                                // drawn without a graphics card
        *not_kept = "not-kept", *unusable_changes = "unusable-changes",    // what clients change of a scene
                                    *recording_ended = "recording-ended",  //
                                        *not_drawn = "not-drawn",
                            *not_encoded = "not-encoded",  // what is to be seen now
                                *no_memory = "no-memory",
                            *smaller = "smaller",  // to draw it; to draw it whole
                                *driver_restarted = "driver-restarted";
inline constexpr std::array all{scene,     software,    not_kept,  unusable_changes, recording_ended,
                                not_drawn, not_encoded, no_memory, smaller,          driver_restarted};
}  // namespace notice_code

namespace error_code {
inline constexpr const char *bad_message = "bad-message", *out_of_range = "out-of-range",
                            *unknown_member = "unknown-member", *read_only = "read-only",
                            *unknown_node = "unknown-node", *unknown_cue = "unknown-cue",
                            *unknown_frame = "unknown-frame", *stale_revision = "stale-revision",
                            *not_in_control = "not-in-control", *not_allowed = "not-allowed",
                            *refused_scene = "refused-scene", *busy = "busy", *too_many = "too-many",
                            *failed = "failed";
inline constexpr std::array all{bad_message,   out_of_range,  unknown_member, read_only,      unknown_node,
                                unknown_cue,   unknown_frame, stale_revision, not_in_control, not_allowed,
                                refused_scene, busy,          too_many,       failed};
}  // namespace error_code

struct Quality {
    enum class Level { moving, still };
    enum class Subsampling { yuv420, yuv444 };
    Level level = Level::still;
    double scale = 1;
    int samples = 1;
    double detail = 0;  ///< pixels of error allowed in the meshes
    int jpeg_quality = 90;
    Subsampling subsampling = Subsampling::yuv444;
    std::optional<double> error =
        {};  ///< mean FLIP against full accuracy, as measured for this level; none: not known
    bool operator==(const Quality&) const = default;
};

// --- client to server

struct Hello {
    Role role = Role::view;
    std::string name, token;
    /// A secret of the client, by which it gets control back after a lost connection; empty: none.
    std::string resume;
    bool depth = false;  ///< its frames shall hold depth
};

/// What lies on the view's sides and covers it, in CSS pixels.
struct Inset {
    double top = 0, right = 0, bottom = 0, left = 0;
    bool operator==(const Inset&) const = default;
};

struct Resize {
    double width = 1280, height = 720;  ///< CSS pixels
    double pixel_ratio = 1;
    Inset inset = {};
    bool operator==(const Resize&) const = default;
};

struct FrameGrant {
    std::optional<std::int64_t> shown;  ///< the newest frame that the client has displayed
};

struct Modifiers {
    bool ctrl = false, shift = false, alt = false, meta = false;
    bool operator==(const Modifiers&) const = default;
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
    std::optional<glm::dvec3> touched;  ///< what a drag that begins is about; none: what the server finds
};

struct Wheel {
    double x = 0, y = 0, delta_x = 0, delta_y = 0;
    int delta_mode = 0;  ///< 0 pixels, 1 lines, 2 pages
    Modifiers modifiers;
    std::optional<double> time_stamp;
    std::optional<glm::dvec3> touched;
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
    glm::dvec2 rotate{0, 0};  ///< degrees as if dragged right and down
    glm::dvec2 pan{0, 0};     ///< fractions of the view's height, right and down
    double zoom = 1;          ///< divides the distance from eye to focus
};

struct Fit {
    std::optional<std::int64_t> node;  ///< none: the whole scene
};

/// Opens or closes what turns about a hinge.
struct Swing {
    std::int64_t node = 0;       ///< with the hinge, or part of what has one
    std::optional<double> open;  ///< 0 closed, 1 as far as it goes; none: the other of the two
    double ms = 700;             ///< from one end to the other
};

struct Control {
    /// `ask` and `cancel` are another client's; `release`, `give` and `decline` the holder's.
    enum class Action { take, release, ask, cancel, give, decline };
    Action action = Action::take;
    std::optional<std::string> client;  ///< to whom control is given, or who is declined
};

/// What a measure is taken at: a point of a surface, a corner of the mesh, the middle of a straight edge, the
/// centre of a circle, a straight edge, a closed loop of edges, or a plane.
enum class Snap { point, vertex, midpoint, center, edge, loop, plane };
inline constexpr std::size_t kSnaps = 7;

/// Its points are in the node's own space. `point`, `vertex` and `midpoint` have one. The others have two
/// more: of a circle two on it, a quarter turn apart; of an edge its ends; of a loop the ends of one of its
/// mesh edges, as they follow each other around the face that was hit; of a plane two that span it.
struct Feature {
    std::int64_t node = 0;
    Snap snap = Snap::point;
    std::vector<glm::dvec3> points;
    bool operator==(const Feature&) const = default;
};

/// What a pick shall find beside the point that it hits.
struct SnapRequest {
    double within = 0;     ///< CSS pixels
    std::vector<Snap> to;  ///< empty: all but loops
    bool operator==(const SnapRequest&) const = default;
};

/// What is under a point of the view, now or as a frame showed it.
struct Pick {
    enum class Then { select, center, look_at };
    double x = 0, y = 0;                ///< CSS pixels
    std::optional<std::int64_t> frame;  ///< none: the present view
    std::optional<Then> then;
    bool through = false;  ///< transparent parts are passed
    std::optional<SnapRequest> snap = {};
};

/// Shows everybody what lies under a point of the view, as a frame showed it; without `x` and `y` nothing any
/// more.
struct Point {
    std::optional<double> x, y;         ///< CSS pixels; both or none
    std::optional<std::int64_t> frame;  ///< none: the present view
};

/// Where a camera stands, and how.
struct Pose {
    glm::dvec3 eye{0, 0, 5}, focus{0}, up{0, 1, 0};
    glm::dvec3 center{0};  ///< of rotation
    double fov = 40;       ///< the vertical angle of view in degrees
    bool operator==(const Pose&) const = default;
};

/// Members of a camera, to be laid over another; `node` first.
struct CameraOverlay {
    std::optional<std::int64_t> node;
    std::optional<glm::dvec3> eye, focus, up, center;
    std::optional<double> fov;
    bool operator==(const CameraOverlay&) const = default;
};
inline CameraOverlay overlay_of(const Pose& pose) {
    return {{}, pose.eye, pose.focus, pose.up, pose.center, pose.fov};
}

/// Another view than the present one: the scene as a cue shows it, and a camera laid over that.
struct OtherView {
    CameraOverlay camera = {};
    std::optional<std::string> cue = {};  ///< none: as things stand
    bool operator==(const OtherView&) const = default;
};

struct RendererOverlay {
    std::optional<DrawMode> mode;
    std::optional<bool> wireframe, show_selection;
    bool operator==(const RendererOverlay&) const = default;
};

/// One image at full accuracy, of `width` by `height` pixels.
struct Snapshot {
    int width = 0, height = 0;
    ImageFormat format = ImageFormat::jpeg;
    int jpeg_quality = 90;
    std::optional<int> samples;      ///< none: as many as at full accuracy
    std::optional<std::string> cue;  ///< as it would look; none: as things stand
    CameraOverlay camera;
    RendererOverlay renderer;
};

struct Fly {
    enum class Easing { smooth, linear };
    struct Keyframe {
        double at = 0;         ///< ms from the start, strictly rising
        CameraOverlay camera;  ///< over the keyframe before, the first over where the camera is
    };
    std::vector<Keyframe> keyframes;
    Easing easing = Easing::smooth;
};

/// Shows a cue: the one of this name, or so many after the one that was shown last.
struct Cue {
    std::optional<std::string> name;  ///< either this
    std::optional<int> step;          ///< or this
    CameraOverlay camera;             ///< over the cue's
    std::optional<double> ms;         ///< instead of the cue's
};

/// Finds out what of a list of cues does not go with the scene.
struct Check {
    std::shared_ptr<const nlohmann::json> cues;
};

/// A page of the scene's tree.
struct Tree {
    enum class Only { switches, hinges };
    std::optional<std::int64_t> node;   ///< none: the root
    std::optional<int> depth;           ///< none: 1, or with `search` or `only` all
    std::string search;                 ///< part of a name, in either case; empty: all
    std::optional<Only> only;           ///< nodes of one kind; none: all
    std::optional<std::int64_t> after;  ///< where the page before ended
};

struct Open {
    std::string scene;
    std::optional<UpAxis> up_axis = {};  ///< none: the last choice
};

/// What can be opened.
struct Scenes {};

struct Record {
    enum class Action { start, stop };
    Action action = Action::start;
    std::string name;  ///< empty: one is made
};

/// What a host's walls show now.
struct Shown {
    std::int64_t revision = 0;
};

/// An address for those who only watch.
struct Share {
    std::string page;  ///< where the client has opened the page; empty: nowhere
};

struct ClientMessage {
    std::optional<std::int64_t> id;
    std::variant<Hello, Resize, FrameGrant, Pointer, Wheel, Key, Navigate, Fit, Swing, Patch, Pick, Snapshot,
                 Fly, Tree, Open, Scenes, Record, Control, Shown, Share, Point, Cue, Check>
        payload;
    std::string text = {};  ///< as it came over the wire; empty where it did not
};

}  // namespace vrut::protocol
