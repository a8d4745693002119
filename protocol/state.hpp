#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "messages.hpp"

namespace vrut::protocol {

/// Large, never changed, and compared by place.
template <class T>
struct Shared {
    std::shared_ptr<const T> value = std::make_shared<const T>();
    bool operator==(const Shared&) const = default;
};

/// Entries by name. A copy shares them until one of the two changes: copying, and comparing with a copy, take
/// the same time for any number of entries.
template <class T>
class SharedMap {
public:
    using Map = std::map<std::string, T>;
    const Map& operator*() const { return *map_; }
    const Map* operator->() const { return map_.get(); }
    /// Equal entries stay shared.
    void set(Map map) {
        if (map != *map_) map_ = std::make_shared<const Map>(std::move(map));
    }
    void set(const std::string& name, T value) {
        Map map = *map_;
        map[name] = std::move(value);
        set(std::move(map));
    }
    bool operator==(const SharedMap& other) const { return map_ == other.map_ || *map_ == *other.map_; }

private:
    std::shared_ptr<const Map> map_ = std::make_shared<const Map>();
};

// --- the state document's members, as values. Those marked r are read-only to clients.

struct SceneState {                      // r
    std::string name, file;              ///< its title, and the name by which it is opened
    std::optional<UpAxis> up_axis = {};  ///< none: the format defines it
    std::uint64_t nodes = 0, materials = 0, geometries = 0, triangles = 0;
    struct Bounds {
        glm::dvec3 min{0}, max{0};
    } bounds;
    struct Seat {
        glm::dvec3 eye{0};
        double radius = 0;
    };
    std::vector<Seat> seats;
    std::vector<Notice> notices;
};

struct CameraState : Pose {
    std::optional<std::int64_t> node;  ///< the camera node that it stands at
    std::optional<std::string> name;   // r: of that node
    double near = 0.1, far = 100;      // r
    bool operator==(const CameraState&) const = default;
};

/// The camera that hosts have while it is behind the room's.
struct WallsState : Pose {  // r
    double near = 0.1, far = 100;
    double behind_degrees = 0, behind_metres = 0;  ///< how far the view must turn, and the eye move
    bool operator==(const WallsState&) const = default;
};

/// Of a camera node or a material.
struct Named {  // r
    std::string name;
};
using Names = std::map<std::string, Named>;

struct NavigationState {
    enum class Style { vrut, maya, catia, cinema4d };
    Style style = Style::vrut;
    bool keep_upright = true;
    enum class TurnAbout { center, touched };
    TurnAbout turn_about = TurnAbout::center;
    double rotate_speed = 1, pan_speed = 1, zoom_speed = 1;
    bool tap_swings = false;  ///< a tap opens or closes what turns about a hinge
    bool operator==(const NavigationState&) const = default;
};

struct RendererState {
    DrawMode mode = DrawMode::realistic;
    bool wireframe = false, show_selection = true;
    std::uint64_t solid = 0, transparent = 0, reflective = 0;  // r: geometry nodes
    bool operator==(const RendererState&) const = default;
};

struct LightState {
    std::string name, type;  // r
    glm::dvec4 color{1, 1, 1, 1};
    glm::dvec3 attenuation{1, 0, 0};
    bool operator==(const LightState&) const = default;
};

struct LightsState {
    std::string active = "headlight";  ///< an item's id
    SharedMap<LightState> items;
    bool operator==(const LightsState&) const = default;
};

struct BackgroundState {
    std::string name;  // r
    glm::dvec4 color{0, 0, 0, 1};
    std::optional<std::string> texture;  // r
    bool operator==(const BackgroundState&) const = default;
};

struct BackgroundsState {
    std::string active = "color";  ///< an item's id, or "color" for the plain one
    glm::dvec4 color{230.0 / 255, 235.0 / 255, 242.0 / 255, 1};
    SharedMap<BackgroundState> items;
    bool operator==(const BackgroundsState&) const = default;
};

struct SelectionState {
    std::optional<std::int64_t> node;
    std::optional<std::string> name;                    // r
    std::optional<std::vector<std::string>> path;       // r: names from the root, the last 32
    std::optional<std::vector<std::int64_t>> path_ids;  // r: the same nodes
    std::optional<std::int64_t> hinge;                  // r: the innermost of these that has one
    bool operator==(const SelectionState&) const = default;
};

/// What of a node differs from its file.
struct NodeOverride {
    std::optional<bool> active;
    std::optional<int> active_child;  ///< of a switch: -1 none, -2 all
    std::optional<glm::dmat4> matrix;
    std::optional<std::int64_t> material;
    bool operator==(const NodeOverride&) const = default;
};

/// A note on a point of the scene.
struct Marker {
    glm::dvec3 point{0};
    std::optional<std::int64_t> node;  ///< that it moves with; `point` is in that node's space then
    std::string text;
    std::optional<std::string> author = {};  ///< by the name that others see
    std::optional<std::int64_t> time = {};   ///< when it was made: milliseconds since 1970, UTC
    std::optional<Pose> view = {};           ///< the camera that it was made from
    bool done = false;
    bool operator==(const Marker&) const = default;
};

/// A plane that cuts the scene open: what lies beyond `distance` along `normal`, in the world, is not shown.
struct SectionState {
    glm::dvec3 normal{0, 0, 1};  ///< unit
    double distance = 0;         ///< from the world's origin
    bool on = true;
    bool caps = true;      ///< solids are closed where it cuts them
    bool hatched = false;  ///< their caps
    bool operator==(const SectionState&) const = default;
};

/// A box along the world's axes. Nothing outside it is shown.
struct SectionBoxState {
    glm::dvec3 min{-1}, max{1};
    bool on = false;
    bool caps = true, hatched = false;  ///< as SectionState's
    bool operator==(const SectionBoxState&) const = default;
};

/// `parallel`: the distance from a plane, or from a line, at right angles to it.
enum class MeasureKind { distance, parallel, angle, radius, length };

struct MeasureState {
    MeasureKind kind = MeasureKind::distance;
    std::vector<Feature> picks;
    bool operator==(const MeasureState&) const = default;
};

/// What is measured.
struct MeasuredState {                          // r
    std::optional<double> value = {};           ///< in the scene's unit, or degrees
    std::optional<glm::dvec3> components = {};  ///< of a distance, along the world's axes
    std::vector<glm::dvec3> line = {};          ///< world: what it looks like; kMaxLine
    std::optional<std::string> problem = {};    ///< why there is no value
    bool operator==(const MeasuredState&) const = default;
};

struct UnitState {
    double metres = 0.001;  ///< per unit of the scene
    enum class Shown { mm, cm, m, in };
    Shown shown = Shown::mm;  ///< by pages
    bool operator==(const UnitState&) const = default;
};

/// A saved camera.
struct ViewState : Pose {
    std::optional<double> order = {};  ///< among the views: the lowest first, then those without one
    bool operator==(const ViewState&) const = default;
};

/// What is shown at one point of a presentation, and how it comes to that. The members that have names of the
/// state's sections are to be what those are then.
struct CueState {
    struct Lights {
        std::string active = "headlight";
        bool operator==(const Lights&) const = default;
    };
    struct Backgrounds {
        std::string active = "color";
        glm::dvec4 color{1};
        bool operator==(const Backgrounds&) const = default;
    };
    struct Selection {
        std::optional<std::int64_t> node;
        bool operator==(const Selection&) const = default;
    };
    std::optional<double> order = {};  ///< as ViewState's
    std::string text;                  ///< for who speaks
    double ms = 1500;                  ///< how long the camera and what has a hinge are on their way
    Fly::Easing easing = Fly::Easing::smooth;
    Pose camera;
    Lights lights;
    Backgrounds backgrounds;
    Selection selection;
    SharedMap<NodeOverride> nodes;
    SharedMap<SectionState> sections;
    SectionBoxState section_box;
    bool operator==(const CueState&) const = default;
};

/// The cue that was shown last.
struct ShownCueState {  // r
    std::string name;
    bool operator==(const ShownCueState&) const = default;
};

struct QualityState {
    double preference = 0.5;  ///< 0 speed, 1 accuracy
    double latency_target_ms = 50;
    bool operator==(const QualityState&) const = default;
};

struct PointingState {
    bool watchers = true;  ///< who cannot hold control may point, too
    bool operator==(const PointingState&) const = default;
};

/// How fast the camera of hosts moves.
struct ComfortState {
    bool on = true;  ///< false: they have the room's camera at once
    double degrees_per_second = 45, degrees_per_second_squared = 180;  ///< of the view
    double metres_per_second = 2, metres_per_second_squared = 8;       ///< of the eye
    bool operator==(const ComfortState&) const = default;
};

struct ControlState {  // r
    /// A control client that asks the holder for control.
    struct Asking {
        std::string client;
        std::optional<std::string> name;
        bool operator==(const Asking&) const = default;
    };
    std::optional<std::string> holder;
    std::optional<std::string> name;  ///< that the holder gave in its `hello`
    bool kept = false;                ///< always true while there is a holder
    bool absent = false;              ///< the holder has lost its connection, and may come back
    std::vector<Asking> asking = {};  ///< the first one first
    bool operator==(const ControlState&) const = default;
};

/// Somebody who is connected.
struct ClientState {                  // r
    std::optional<std::string> name;  ///< as others see it
    Role role = Role::view;
    bool operator==(const ClientState&) const = default;
};

struct RecordingState {  // r
    std::string name;
    bool operator==(const RecordingState&) const = default;
};

/// A node on its way about its hinge.
struct SwingState {  // r
    double to = 0;   ///< 0 closed, 1 open
    bool operator==(const SwingState&) const = default;
};

/// What all clients share.
struct State {
    Shared<SceneState> scene;
    CameraState camera;
    std::optional<WallsState> walls;  // r: none: hosts have the room's camera
    Shared<Names> cameras;
    NavigationState navigation;
    RendererState renderer;
    LightsState lights;
    Shared<Names> materials;
    BackgroundsState backgrounds;
    SelectionState selection;
    SharedMap<NodeOverride> nodes;
    SharedMap<SwingState> swings;  // r: by the node's id
    SharedMap<Marker> markers;
    SharedMap<ViewState> views;
    SharedMap<SectionState> sections;
    SectionBoxState section_box;
    SharedMap<MeasureState> measures;
    SharedMap<MeasuredState> measured;  // r: by the measure's name
    UnitState unit;
    SharedMap<CueState> cues;
    std::optional<ShownCueState> cue;  // r
    QualityState quality;
    PointingState pointing;
    ComfortState comfort;
    ControlState control;
    SharedMap<ClientState> clients;  // r: the first kMaxListedClients
    std::optional<RecordingState> recording;
    std::vector<Notice> notices;  // r: what has gone wrong in the server, the newest last
    bool operator==(const State&) const = default;
};

/// Most markers, most views and most measures.
inline constexpr std::size_t kMaxEntries = 256;
/// Most cues.
inline constexpr std::size_t kMaxCues = 100;
/// Most planes of sections.
inline constexpr std::size_t kMaxSections = 6;
/// Most clients that the state names; `stats` counts all.
inline constexpr std::size_t kMaxListedClients = 64;
/// Most notices of the server; older ones are forgotten.
inline constexpr std::size_t kMaxNotices = 16;
/// Most nodes that differ from the file; likewise in all cues together.
inline constexpr std::size_t kMaxNodes = 10'000;
/// The last millisecond of the year 9999, since 1970 in UTC.
inline constexpr std::int64_t kLatestDate = 253'402'300'799'999;
/// Coordinates of positions go so far either way: products of two stay finite.
inline constexpr double kFarthest = 1e30;

/// `state` after a merge patch (RFC 7396) of its members, or what is wrong with it: all or nothing. null
/// gives a member back the value it has in `starting`, and removes entries of `nodes`, `markers`, `views`,
/// `measures` and `cues` that are not there. Checks types, ranges and names of members; what needs the scene
/// is the caller's.
tl::expected<State, Error> patched(const State& state, const State& starting, const nlohmann::json& patch);
/// New markers of a patch that led from `before` to `next` get what it does not give of them: the author, and
/// the camera of `next` as the view that they were made from.
void sign_notes(const State& before, const nlohmann::json& patch, const std::optional<std::string>& author,
                State& next);
/// A patch from the text of a JSON object.
tl::expected<Patch, Error> parse_patch(std::string_view text);

/// The text of the patch that leads from `starting` to what is kept of a scene in `state`. "{}" where that is
/// the same.
std::string kept_changes(const State& starting, const State& state);
/// Whether what is kept of a scene is equal in both.
bool has_equal_kept(const State& a, const State& b);

/// The document of a state, as clients see it (StateDocument::json()).
std::shared_ptr<const nlohmann::json> document_of(const State& state);
/// `starting` with what clients may change, and who steers, from a whole document (StateDocument::json()).
tl::expected<State, Error> restored(const State& starting, const nlohmann::json& document);

/// A choice of the state's sections, which their descriptions make.
enum class Sections {
    kept,       ///< with the scene, where a server keeps what clients change
    for_hosts,  ///< what hosts may patch, too
};
/// Returns true if the patch names no other sections.
bool names_only(const nlohmann::json& patch, Sections sections);
/// Their names, sorted.
std::vector<std::string> names_of(Sections sections);

/// `starting`, of a scene that is opened, with what goes on from the scene before.
State opened(State starting, const State& before);

/// Makes the state what a cue shows, but for its camera, and for what is known of the node that is selected.
void lay_cue(const CueState& cue, State& state);

/// Which members of `camera` a patch names; null names all.
struct NamedCameraMembers {
    bool node = false, eye = false, focus = false, up = false, center = false, fov = false;
    bool any() const { return node || eye || focus || up || center || fov; }
};
NamedCameraMembers named_camera_members(const nlohmann::json& patch);

/// A camera from the text of a JSON object with members of the state's `camera`; read-only and unknown
/// members are ignored.
tl::expected<CameraOverlay, Error> parse_camera(std::string_view text);

}  // namespace vrut::protocol
