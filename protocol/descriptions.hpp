#pragma once

#include <limits>

#include "cue_list.hpp"
#include "fields.hpp"
#include "frame_header.hpp"
#include "level_table.hpp"
#include "messages.hpp"
#include "render_job.hpp"
#include "state.hpp"
#include "state_fields.hpp"

/// Every member of everything that travels: its name, what it may be, and whether it must be there. Decoding,
/// encoding and the JSON Schema follow from this. For protocol's own .cpp files.
namespace vrut::protocol {

// --- limits

// Far beyond any screen, near enough that sums and products stay finite.
inline constexpr Number kCoordinate{-1e6, 1e6};
inline constexpr Number kDelta{-1e9, 1e9};
inline constexpr Number kTimeStamp{-1e15, 1e15};
inline constexpr Number kAny{-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
inline constexpr Number kDuration{0, std::numeric_limits<double>::max()};
inline constexpr double kHuge = kFarthest;
inline constexpr Vector<glm::dvec3> kPosition{-kHuge, kHuge};
inline constexpr List<Vector<glm::dvec3>> kLine{{kAny.min, kAny.max}, 0, kMaxLine};
inline constexpr Vector<glm::dvec4> kColor{0, 1};
inline constexpr Vector<glm::dvec4> kLightColor{0, kHuge};  // light may be brighter than white
inline constexpr Vector<glm::dvec3> kAttenuation{0, kHuge};
inline constexpr Number kFov{1, 170};
inline constexpr Number kSpeed{0.01, 100};
inline constexpr Number kOrder{-1e9, 1e9};
inline constexpr Number kCueMs{0, 60'000};
inline constexpr Matrix kMatrix{kHuge};
inline constexpr Integer kId{};
inline constexpr Integer kDate{0, kLatestDate};
inline constexpr Integer kPixels{1, 8192};
inline constexpr Integer kJpegQuality{1, 100};
inline constexpr Text kName{std::numeric_limits<std::uint32_t>::max()};
inline constexpr Text kClientName{kMaxClientName};
inline constexpr std::size_t kMaxKeyframes = 1000;
inline constexpr std::size_t kMaxQrSize = 177;  // modules of a side, in version 40

inline constexpr Integer kActiveChild{-2, std::numeric_limits<int>::max()};
inline constexpr auto kRole = word("control", "view", "host");
inline constexpr auto kMode = word("realistic", "stylized");
inline constexpr auto kFormat = word("jpeg", "png");
inline constexpr auto kStyle = word("vrut", "maya", "catia", "cinema4d");
inline constexpr auto kTurnAbout = word("center", "touched");
inline constexpr auto kUpAxis = word("y", "z");
inline constexpr auto kSnap = word("point", "vertex", "midpoint", "center", "edge", "loop", "plane");

// Definitions of the schema's own.
inline constexpr Defined<Object<CameraOverlay>> kCameraOverlay{{}, "cameraOverlay"};
inline constexpr Defined<Object<Quality>> kQuality{{}, "quality"};
inline constexpr Defined<Object<Notice>> kNotice{{}, "notice"};
inline constexpr Defined<Section<CameraState>> kCamera{{}, "camera"};
inline constexpr Defined<Object<Feature>> kFeature{{}, "feature"};

// --- client to server

template <class V>
void describe(V& v, const Hello*) {
    v.required("role", &Hello::role, kRole,
               "The role asked for; `welcome` tells the one given, which the token decides.");
    v.optional("name", &Hello::name, kClientName,
               "How others see the client; of two of the same name one gets a number, as \"iPad 2\".");
    v.optional("token", &Hello::token, Text{1000},
               "The control token or the view token, where the server has tokens.");
    v.optional("resume", &Hello::resume, Text{100},
               "A secret of the client's own, by which it gets control back after a lost connection.");
    v.optional("depth", &Hello::depth, Flag{},
               "Frames shall hold depth, by which the client draws them from another camera.");
}

template <class V>
void describe(V& v, const Inset*) {
    v.optional("top", &Inset::top, Number{0, 8192}, "Covered at the top.");
    v.optional("right", &Inset::right, Number{0, 8192}, "Covered at the right.");
    v.optional("bottom", &Inset::bottom, Number{0, 8192}, "Covered at the bottom.");
    v.optional("left", &Inset::left, Number{0, 8192}, "Covered at the left.");
}

template <class V>
void describe(V& v, const Resize*) {
    v.required("width", &Resize::width, Number{1, 8192}, "CSS pixels; fractions are allowed.");
    v.required("height", &Resize::height, Number{1, 8192}, "CSS pixels; fractions are allowed.");
    v.required("pixelRatio", &Resize::pixel_ratio, Number{0.25, 4}, "Pixels of the image to a CSS pixel.");
    v.optional("inset", &Resize::inset, Object<Inset>{},
               "What lies on the view's sides and covers it, in CSS pixels.");
}

template <class V>
void describe(V& v, const FrameGrant*) {
    v.optional(
        "shown", &FrameGrant::shown, Integer{1, kMaxInteger},
        "Number of the newest frame that the client has displayed: acknowledges it and all before it.");
}

template <class V>
void describe(V& v, const Modifiers*) {
    v.optional("ctrlKey", &Modifiers::ctrl, Flag{}, "Control is held.");
    v.optional("shiftKey", &Modifiers::shift, Flag{}, "Shift is held.");
    v.optional("altKey", &Modifiers::alt, Flag{}, "Alt is held.");
    v.optional("metaKey", &Modifiers::meta, Flag{}, "Meta is held.");
}

template <class V>
void describe(V& v, const Pointer*) {
    v.required("pointerId", &Pointer::pointer_id, Integer{-kMaxInteger, kMaxInteger},
               "Tells one finger from another, as in W3C Pointer Events.");
    v.required("pointerType", &Pointer::pointer_type, word("mouse", "touch", "pen"), "What points.");
    v.required("x", &Pointer::x, kCoordinate, "CSS pixels from the view's left edge.");
    v.required("y", &Pointer::y, kCoordinate, "CSS pixels from the view's top edge.");
    v.required("button", &Pointer::button, Integer{-1, 31},
               "The button that changed: −1 none, 0 left, 1 middle, 2 right.");
    v.required("buttons", &Pointer::buttons, Integer{0, std::numeric_limits<std::uint32_t>::max()},
               "The sum of the buttons that are down: 1 left, 2 right, 4 middle.");
    v.inlined(&Pointer::modifiers);
    v.optional("timeStamp", &Pointer::time_stamp, kTimeStamp,
               "When it happened, in milliseconds of the client's own clock.");
    v.optional("frame", &Pointer::frame, kId,
               "Number of the frame that the user saw; without it the newest drawn counts.");
    v.optional("touched", &Pointer::touched, kPosition,
               "With the first move of a drag: what the client's own picture shows there.");
}

template <class V>
void describe(V& v, const Wheel*) {
    v.required("x", &Wheel::x, kCoordinate, "CSS pixels from the view's left edge.");
    v.required("y", &Wheel::y, kCoordinate, "CSS pixels from the view's top edge.");
    v.required("deltaX", &Wheel::delta_x, kDelta, "Sideways; without effect.");
    v.required("deltaY", &Wheel::delta_y, kDelta, "Towards the user, in the unit of `deltaMode`.");
    v.required("deltaMode", &Wheel::delta_mode, Integer{0, 2}, "The unit: 0 pixels, 1 lines, 2 pages.");
    v.inlined(&Wheel::modifiers);
    v.optional("timeStamp", &Wheel::time_stamp, kTimeStamp,
               "When it happened, in milliseconds of the client's own clock.");
    v.optional("touched", &Wheel::touched, kPosition, "What the client's own picture shows there.");
}

template <class V>
void describe(V& v, const Key*) {
    v.required("key", &Key::key, Text{64}, "What the key means, as in W3C UI Events: `f`, `ArrowLeft`.");
    v.required("code", &Key::code, Text{64}, "Which key it is, as in W3C UI Events: `KeyF`, `ArrowLeft`.");
    v.inlined(&Key::modifiers);
    v.optional("timeStamp", &Key::time_stamp, kTimeStamp,
               "When it happened, in milliseconds of the client's own clock.");
}

template <class V>
void describe(V& v, const Navigate*) {
    v.optional("rotate", &Navigate::rotate, Vector<glm::dvec2>{-1e6, 1e6},
               "[right, down] in degrees, as if dragged.");
    v.optional("pan", &Navigate::pan, Vector<glm::dvec2>{-1e6, 1e6},
               "[right, down]: how far the image moves, in view heights, in the plane through `focus`.");
    v.optional("zoom", &Navigate::zoom, Number{1e-6, 1e6}, "Divides the distance from eye to focus.");
}

template <class V>
void describe(V& v, const Fit*) {
    v.optional("node", &Fit::node, kId, "The node to fit, with all below it; without it the scene.");
}

template <class V>
void describe(V& v, const Swing*) {
    v.required("node", &Swing::node, kId, "A node with a hinge, or one below it.");
    v.optional("open", &Swing::open, Number{0, 1},
               "0 closed, 1 open; without it closed, or open where it is closed already.");
    v.optional("ms", &Swing::ms, Number{0, 60'000}, "The time from one end to the other.");
}

template <class V>
void describe(V& v, const Patch*) {
    v.required("patch", &Patch::patch, AnyObject{{{"$ref", "#/$defs/statePatch"}}},
               "A merge patch (RFC 7396) on the state document.");
    v.optional("ifRevision", &Patch::if_revision, kId,
               "The patch is refused where something that it names has changed since this revision.");
}

template <class V>
void describe(V& v, const Cue*) {
    v.optional("name", &Cue::name, Text{100}, "Which. Without `step`.");
    v.optional("step", &Cue::step, Integer{-static_cast<std::int64_t>(kMaxCues), kMaxCues},
               "How many after the one that was shown last, in their order. Without `name`.");
    v.optional("camera", &Cue::camera, kCameraOverlay,
               "Laid over the camera of the cue, which does not change.");
    v.optional("ms", &Cue::ms, kCueMs, "How long it takes to come to it; without it the cue's own time.");
}

template <class V>
void describe(V& v, const Check*) {
    v.required("cues", &Check::cues, AnyObject{{{"$ref", "#/$defs/cueList"}}},
               "A list of cues as in its file.");
}

template <class V>
void describe(V& v, const Checked::Problem*) {
    v.optional("cue", &Checked::Problem::cue, kName, "The cue; missing: it is the whole list.");
    v.required("message", &Checked::Problem::message, kName, "What is wrong, a sentence.");
}

template <class V>
void describe(V& v, const Checked*) {
    v.required("id", &Checked::id, kId, "Of the `check`.");
    v.required("problems", &Checked::problems, List<Object<Checked::Problem>>{{}, 0, kMaxCueProblems},
               "What does not go with the scene; empty: all of it does.");
    v.required("fitting", &Checked::fitting, List<Text>{Text{100}, 0, kMaxCues},
               "Names of the cues that do.");
}

template <class V>
void describe(V& v, const Feature*) {
    v.required("node", &Feature::node, kId, "The node whose surface it is on.");
    v.required("snap", &Feature::snap, kSnap, "What it is.");
    v.required("points", &Feature::points, List<Vector<glm::dvec3>>{kPosition, 1, 3},
               "Of the node's own space: one, and for the last four kinds two more.");
}

template <class V>
void describe(V& v, const SnapRequest*) {
    v.required("within", &SnapRequest::within, Number{0, 100}, "CSS pixels from the point of the view.");
    v.optional("to", &SnapRequest::to, List<decltype(kSnap)>{kSnap, 0, kSnaps},
               "What may be found; empty: all but `loop`.");
}

template <class V>
void describe(V& v, const Pick*) {
    v.required("x", &Pick::x, kCoordinate, "CSS pixels from the view's left edge.");
    v.required("y", &Pick::y, kCoordinate, "CSS pixels from the view's top edge.");
    v.optional(
        "frame", &Pick::frame, kId,
        "The frame whose camera counts, one of the last 64 of the view; without it the present camera.");
    v.optional("then", &Pick::then, word("select", "center", "lookAt"),
               "Select the node, make the point the centre of rotation, or look at it, too.");
    v.optional("through", &Pick::through, Flag{},
               "Pass transparent parts; the realistic mode always passes those of alpha 0.");
    v.optional("snap", &Pick::snap, Object<SnapRequest>{},
               "Find a corner, an edge or the like near by, too.");
}

template <class V>
void describe(V& v, const Point*) {
    v.optional("x", &Point::x, kCoordinate,
               "CSS pixels from the view's left edge. Without `y` it must be missing.");
    v.optional("y", &Point::y, kCoordinate,
               "CSS pixels from the view's top edge. Without `x` it must be missing.");
    v.optional("frame", &Point::frame, kId,
               "The frame whose camera counts, as of `pick`; without it the present camera.");
}

template <class V>
void describe(V& v, const CameraOverlay*) {
    v.optional("node", &CameraOverlay::node, kId, "A camera node, whose pose is laid over first.");
    v.optional("eye", &CameraOverlay::eye, kPosition, "Where the camera stands.");
    v.optional("focus", &CameraOverlay::focus, kPosition, "What it looks at.");
    v.optional("up", &CameraOverlay::up, kPosition, "Which way is up in the image.");
    v.optional("center", &CameraOverlay::center, kPosition, "The centre of rotation.");
    v.optional("fov", &CameraOverlay::fov, kFov, "The vertical angle of view in degrees.");
}

template <class V>
void describe(V& v, const RendererOverlay*) {
    v.optional("mode", &RendererOverlay::mode, kMode, "How surfaces are drawn.");
    v.optional("wireframe", &RendererOverlay::wireframe, Flag{}, "Edges only.");
    v.optional("showSelection", &RendererOverlay::show_selection, Flag{}, "Bring out what is selected.");
}

template <class V>
void describe(V& v, const Snapshot*) {
    v.required("width", &Snapshot::width, kPixels, "Pixels.");
    v.required("height", &Snapshot::height, kPixels, "Pixels.");
    v.optional("format", &Snapshot::format, kFormat, "Of the file.");
    v.optional("jpegQuality", &Snapshot::jpeg_quality, kJpegQuality, "Of a JPEG file.");
    v.optional("samples", &Snapshot::samples, Integer{1, 16},
               "A pixel; without it as many as at full accuracy.");
    v.optional("cue", &Snapshot::cue, Text{100},
               "The scene as this cue shows it; it is not shown to others.");
    v.optional("camera", &Snapshot::camera, kCameraOverlay,
               "Laid over the shared camera, which does not change.");
    v.optional("renderer", &Snapshot::renderer, Object<RendererOverlay>{},
               "Laid over the shared renderer, which does not change.");
}

template <class V>
void describe(V& v, const Fly::Keyframe*) {
    v.required("at", &Fly::Keyframe::at, Number{0, 1e9}, "Milliseconds from the start; they rise strictly.");
    v.required("camera", &Fly::Keyframe::camera, kCameraOverlay,
               "Laid over the camera of the keyframe before, the first over the present one.");
}

template <class V>
void describe(V& v, const Fly*) {
    v.required("keyframes", &Fly::keyframes, List<Object<Fly::Keyframe>>{{}, 1, kMaxKeyframes},
               "The cameras to pass, the last of them exactly.");
    v.optional("easing", &Fly::easing, word("smooth", "linear"),
               "`smooth` eases the whole flight at its start and end; it does not stop at keyframes.");
}

template <class V>
void describe(V& v, const Tree*) {
    v.optional("node", &Tree::node, kId, "Where to begin; without it at the root.");
    v.optional("depth", &Tree::depth, Integer{0, 1'000'000'000},
               "Levels below the node; without it 1, or all with `search` or `only`.");
    v.optional("search", &Tree::search, Text{1000},
               "Only nodes whose name has this part; A to Z count in either case.");
    v.optional("only", &Tree::only, word("switches", "hinges"), "Only switches, or only what has a hinge.");
    v.optional("after", &Tree::after, kId, "What the page before had as `next`.");
}

template <class V>
void describe(V& v, const Open*) {
    v.required("scene", &Open::scene, Text{kMaxSceneName}, "A name as in the answer to `scenes`.");
    v.optional("upAxis", &Open::up_axis, kUpAxis,
               "The up axis, for formats that do not define it; without it the last choice.");
}

template <class V>
void describe(V&, const Scenes*) {}

template <class V>
void describe(V& v, const Record*) {
    v.required("action", &Record::action, word("start", "stop"), "Begin or end the log.");
    v.optional("name", &Record::name, Text{64},
               "Of the log: A to Z, a to z, 0 to 9, `_`, `-`. Without it a name is made of the time.");
}

template <class V>
void describe(V& v, const Control*) {
    v.required("action", &Control::action, word("take", "release", "ask", "cancel", "give", "decline"),
               "What is to happen with control.");
    v.optional("client", &Control::client, Text{100},
               "Required with `give` and `decline`: the client that gets control, or does not.");
}

template <class V>
void describe(V& v, const Share*) {
    v.optional("page", &Share::page, Text{1000},
               "Where the client has opened the page: an address of HTTP without query and fragment.");
}

template <class V>
void describe(V& v, const Shown*) {
    v.required("revision", &Shown::revision, kId, "What the host's walls show now.");
}

// --- server to client

template <class V>
void describe(V& v, const Limits*) {
    v.required("maxMessage", &Limits::max_message, kId, "Bytes of a client's message.");
    v.required("maxDepth", &Limits::max_depth, kId, "Levels of nesting in a client's message.");
    v.required("maxGrants", &Limits::max_grants, kId, "Grants that the server keeps of a client.");
    v.required("maxPixels", &Limits::max_pixels, kId, "Pixels of an image; a larger view is drawn smaller.");
    v.required("messagesPerSecond", &Limits::messages_per_second, kId,
               "What a client sends faster is read more slowly.");
    v.required("maxServerMessage", &Limits::max_server_message, kId, "Bytes of a server's message.");
}

template <class V>
void describe(V& v, const InputRules*) {
    v.required("wheelSteps", &InputRules::wheel_steps, Vector<glm::dvec3>{kDuration.min, kDuration.max},
               "[pixels, lines, pages] that make one step of the wheel.");
    v.required("wheelZoom", &InputRules::wheel_zoom, kDuration,
               "A step away from the user divides the distance by it.");
    v.required("dragZoom", &InputRules::drag_zoom, kDuration,
               "A zooming drag upwards over the view's height divides the distance by it.");
    v.required("drags", &InputRules::drags, ValuesByName<ValuesByName<Text>>{{kName}},
               "By style, by `buttons`: `rotate`, `pan`, `zoom`. Styles that use keys are left out.");
    v.required("keys", &InputRules::keys, List<Text>{kName, 0, kMaxInteger},
               "The `key` of each key that has a meaning.");
    v.required("repeatingKeys", &InputRules::repeating_keys, List<Text>{kName, 0, kMaxInteger},
               "Of `keys`, those that go on while they are held.");
}

template <class V>
void describe(V& v, const Welcome*) {
    v.required("id", &Welcome::id, kId, "Of the `hello`, where it had one.");
    v.required("version", &Welcome::version, Integer{kVersion, kVersion}, "Of this protocol.");
    v.required("server", &Welcome::server, kName, "Version of the program.");
    v.required("client", &Welcome::client, kName, "This client's id.");
    v.required("role", &Welcome::role, kRole, "The role given.");
    v.required("limits", &Welcome::limits, Object<Limits>{}, "What holds for messages and images.");
    v.required("input", &Welcome::input, Object<InputRules>{},
               "What a client needs to foretell what input does, or to pass on what has a meaning only.");
}

template <class V>
void describe(V& v, const Ok*) {
    v.required("id", &Ok::id, kId, "Of the message.");
    v.required("revision", &Ok::revision, kId, "Of the state that the message led to.");
    v.required("name", &Ok::name, kName, "Of the event log.");
}

template <class V>
void describe(V& v, const Snapped*) {
    v.required("feature", &Snapped::feature, kFeature, "To be one of the `picks` of a measure.");
    v.required("point", &Snapped::point, Vector<glm::dvec3>{kAny.min, kAny.max},
               "Its first point, in the world.");
    v.required("line", &Snapped::line, kLine, "Of an edge, a circle or a loop, in the world; else empty.");
}

template <class V>
void describe(V& v, const Picked*) {
    v.required("id", &Picked::id, kId, "Of the `pick`.");
    v.required("node", &Picked::node, kId, "The node that was hit.");
    v.required("name", &Picked::name, kName, "Of the node.");
    v.required("path", &Picked::path, List<Text>{kName, 0, 32},
               "Names from the root to the node that was hit, the last 32.");
    v.required("point", &Picked::point, Vector<glm::dvec3>{kAny.min, kAny.max}, "In the world.");
    v.required("normal", &Picked::normal, Vector<glm::dvec3>{-1.001, 1.001},
               "Of the face, unit, towards the viewer.");
    v.required("distance", &Picked::distance, kDuration, "From the eye.");
    v.required(
        "local", &Picked::local, Vector<glm::dvec3>{kAny.min, kAny.max},
        "The point in the node's own space, for a marker that moves with it; none of a flattened node.");
    v.required("snapped", &Picked::snapped, Object<Snapped>{}, "What `snap` has found, if anything.");
}

template <class V>
void describe(V& v, const Pointed*) {
    v.required("client", &Pointed::client, kName, "Who points.");
    v.required("name", &Pointed::name, kName, "As others see that client, where it has a name.");
    v.required("point", &Pointed::point, Vector<glm::dvec3>{kAny.min, kAny.max},
               "In the world; missing: that client points at nothing any more.");
    v.required("normal", &Pointed::normal, Vector<glm::dvec3>{-1.001, 1.001},
               "Of the face, unit, towards who points; with `point`.");
}

template <class V>
void describe(V& v, const Flown*) {
    v.required("id", &Flown::id, kId, "Of the `fly`.");
    v.required("completed", &Flown::completed, Flag{}, "False where the flight was stopped.");
}

template <class V>
void describe(V& v, const TreeHinge*) {
    v.required("axis", &TreeHinge::axis, Vector<glm::dvec3>{-1.001, 1.001},
               "Unit, in the node's own space, through its origin.");
    v.required("degrees", &TreeHinge::degrees, Number{-360, 360},
               "How far it opens; the sign tells which way.");
    v.required("closed", &TreeHinge::closed, kMatrix, "The node's matrix as in the file.");
}

template <class V>
void describe(V& v, const TreeNode*) {
    v.required("id", &TreeNode::id, kId, "The node's id.");
    v.required("name", &TreeNode::name, kName, "The node's name.");
    v.required(
        "type", &TreeNode::type, kName,
        "`assembly`, `root`, `camera`, `geometry`, `light`, `lod`, `switch`, `background` or `sound`.");
    v.required("parent", &TreeNode::parent, kId, "The parent's id; none of the root.");
    v.required("active", &TreeNode::active, Flag{}, "False where it is hidden, with all below it.");
    v.required("children", &TreeNode::children, kId, "Number of children.");
    v.required("triangles", &TreeNode::triangles, kId, "Number of triangles of its own geometry.");
    v.required("material", &TreeNode::material, kId, "Id of its geometry's material.");
    v.required("matrix", &TreeNode::matrix, kMatrix, "As it is now; where it is missing, the identity.");
    v.required("hinge", &TreeNode::hinge, Object<TreeHinge>{}, "What a door turns about.");
    v.required("activeChild", &TreeNode::active_child, kActiveChild,
               "Of a switch, as in the file: counted from 0, −1 none, −2 all.");
    v.required("choices", &TreeNode::choices, List<Text>{kName, 0, kMaxChoices},
               "The children's names, of a switch with at most 64 of them and 16 KiB of names.");
}

template <class V>
void describe(V& v, const TreePage*) {
    v.required("id", &TreePage::id, kId, "Of the `tree`.");
    v.required("nodes", &TreePage::nodes, List<Object<TreeNode>>{{}, 0, kMaxInteger},
               "Depth first, children by rising id.");
    v.required("next", &TreePage::next, kId, "There is more: send it as `after`.");
}

template <class V>
void describe(V& v, const SceneList*) {
    v.required("id", &SceneList::id, kId, "Of the `scenes`.");
    v.required("scenes", &SceneList::scenes, List<Text>{Text{kMaxSceneName}, 0, kMaxScenes},
               "Names for `open`, sorted by their bytes.");
}

template <class V>
void describe(V& v, const SharedAddress*) {
    v.required("id", &SharedAddress::id, kId, "Of the `share`.");
    v.required("address", &SharedAddress::address, kName,
               "Of the page, to watch only, with the view token where there is one.");
    v.required("qr", &SharedAddress::qr, List<Text>{Text{kMaxQrSize}, 0, kMaxQrSize},
               "The address as a QR code: rows of 0, light, and 1, dark, without the quiet zone.");
    v.required("loopback", &SharedAddress::loopback, Flag{},
               "True where no other machine reaches the address.");
}

template <class V>
void describe(V& v, const Loading*) {
    v.required("scene", &Loading::scene, kName, "Name of the scene that is loaded.");
    v.required("fraction", &Loading::fraction, Number{0, 1}, "How much of it is loaded.");
    v.required("done", &Loading::done, Flag{}, "Once, at the end: the scene is ready.");
    v.required("refused", &Loading::refused, kName,
               "Once, at the end: a sentence that tells why the scene is not shown.");
}

struct ErrorCode : Text {
    Json schema() const { return {{"enum", error_code::all}}; }
};

template <class V>
void describe(V& v, const Error*) {
    v.required("id", &Error::id, kId, "Of the message, where it could be read.");
    v.required("code", &Error::code, ErrorCode{kName}, "For programs.");
    v.required("message", &Error::message, Text{300}, "One sentence for a person, which names the culprit.");
}

struct NoticeCode : Text {
    Json schema() const { return {{"enum", notice_code::all}}; }
};

template <class V>
void describe(V& v, const Notice*) {
    v.fixed("code", &Notice::code, NoticeCode{kName}, "For programs.");
    v.fixed("message", &Notice::message, kName, "A sentence for a person.");
}

template <class V>
void describe(V& v, const Quality*) {
    v.required("level", &Quality::level, word("moving", "still"),
               "`moving` while things change, `still` at rest.");
    v.required("scale", &Quality::scale, Number{0, 1}, "By which the frame is drawn smaller than the view.");
    v.required("samples", &Quality::samples, Integer{1, 65536}, "To a pixel.");
    v.required("detail", &Quality::detail, kDuration,
               "Pixels of error allowed in the meshes; 0 draws every triangle.");
    v.required("jpegQuality", &Quality::jpeg_quality, kJpegQuality, "Of the JPEG file.");
    v.required("subsampling", &Quality::subsampling, word("4:2:0", "4:4:4"),
               "Of the colours in the JPEG file.");
    v.optional("error", &Quality::error, Number{0, 1},
               "Mean FLIP against full accuracy, 0 none, as measured for the level; missing where unknown.");
}

template <class V>
void describe(V& v, const Stats::Renderer*) {
    v.required("meanRenderMs", &Stats::Renderer::mean_render_ms, kDuration, "Mean of the last 100 frames.");
    v.required("medianRenderMs", &Stats::Renderer::median_render_ms, kDuration,
               "Median of the last 100 frames.");
    v.required("p95RenderMs", &Stats::Renderer::p95_render_ms, kDuration,
               "95 of 100 took no longer, of the last 100 frames.");
}

template <class V>
void describe(V& v, const Stats::Host*) {
    v.required("name", &Stats::Host::name, kName, "As in its `hello`.");
    v.required("revision", &Stats::Host::revision, kId, "What its walls show.");
    v.required("lagMs", &Stats::Host::lag_ms, kDuration,
               "From that revision's making to the host's report, by the server's clock.");
}

template <class V>
void describe(V& v, const Stats*) {
    v.required("renderer", &Stats::renderer, Object<Stats::Renderer>{},
               "Times of drawing; none before the first frame.");
    v.required("quality", &Stats::quality, kQuality, "Of the newest frame; none before the first.");
    v.required("hosts", &Stats::hosts, Table<Stats::Host>{}, "By the client's id.");
    v.required("clients", &Stats::clients, kId, "Clients that are connected.");
    v.required("watchers", &Stats::watchers, kId, "Clients of the role `view`.");
    v.required("framesPerSecond", &Stats::frames_per_second, kDuration, "Sent to all clients.");
    v.required("bytesPerSecond", &Stats::bytes_per_second, kDuration, "Sent to all clients.");
}

// --- the state document

template <class V>
void describe(V& v, const SceneState::Bounds*) {
    v.fixed("min", &SceneState::Bounds::min, kPosition, "The least coordinates.");
    v.fixed("max", &SceneState::Bounds::max, kPosition, "The greatest coordinates.");
}

template <class V>
void describe(V& v, const SceneState::Seat*) {
    v.fixed("eye", &SceneState::Seat::eye, kPosition, "The middle of where the eye is then.");
    v.fixed("radius", &SceneState::Seat::radius, kDuration, "How far from it the eye may be.");
}

template <class V>
void describe(V& v, const SceneState*) {
    v.fixed("name", &SceneState::name, kName, "The scene's title.");
    v.fixed("file", &SceneState::file, Text{kMaxSceneName}, "The name by which `open` takes it.");
    v.fixed("upAxis", &SceneState::up_axis, kUpAxis,
            "The up axis in use; only for formats that do not define it: OBJ, STL and PLY.");
    v.fixed("nodes", &SceneState::nodes, kId, "Number of nodes.");
    v.fixed("materials", &SceneState::materials, kId, "Number of materials.");
    v.fixed("geometries", &SceneState::geometries, kId, "Number of geometries.");
    v.fixed("triangles", &SceneState::triangles, kId, "Number of triangles.");
    v.fixed("bounds", &SceneState::bounds, Object<SceneState::Bounds>{}, "The scene's box in the world.");
    v.fixed("seats", &SceneState::seats, List<Object<SceneState::Seat>>{{}, 0, kMaxInteger},
            "Where drags that rotate turn the view about the eye.");
    v.fixed("notices", &SceneState::notices, List<Defined<Object<Notice>>>{kNotice, 0, kMaxInteger},
            "What to know of it, as what of the file is not shown.");
}

template <class V>
void describe(V& v, const CameraState*) {
    v.writable("node", &CameraState::node, kId, "The camera node at which the camera stands.");
    v.fixed("name", &CameraState::name, kName, "Name of the camera node at which the camera stands.");
    v.writable("eye", &CameraState::eye, kPosition, "Where the camera stands.");
    v.writable("focus", &CameraState::focus, kPosition, "What it looks at.");
    v.writable("up", &CameraState::up, kPosition,
               "Which way is up in the image; unit, at right angles to the view.");
    v.writable("center", &CameraState::center, kPosition, "The centre of rotation.");
    v.writable("fov", &CameraState::fov, kFov, "The vertical angle of view in degrees.");
    v.fixed("near", &CameraState::near, kDuration,
            "Near end of a clip range for hosts' own drawing; never below 10⁻⁶ of `far`.");
    v.fixed("far", &CameraState::far, kDuration, "Far end of a clip range for hosts' own drawing.");
}

template <class V>
void describe(V& v, const WallsState*) {
    v.fixed("eye", &WallsState::eye, kPosition, "Where that camera stands.");
    v.fixed("focus", &WallsState::focus, kPosition, "What it looks at.");
    v.fixed("up", &WallsState::up, kPosition, "Which way is up; unit, at right angles to the view.");
    v.fixed("center", &WallsState::center, kPosition, "The centre of rotation.");
    v.fixed("fov", &WallsState::fov, kFov, "The vertical angle of view in degrees.");
    v.fixed("near", &WallsState::near, kDuration, "Near end of its clip range.");
    v.fixed("far", &WallsState::far, kDuration, "Far end of its clip range.");
    v.fixed("behindDegrees", &WallsState::behind_degrees, Number{0, 180}, "How far its view has to turn.");
    v.fixed("behindMetres", &WallsState::behind_metres, kDuration,
            "How far its eye has to move, by the scene's unit.");
}

template <class V>
void describe(V& v, const Named*) {
    v.fixed("name", &Named::name, kName, "As in the file.");
}

template <class V>
void describe(V& v, const NavigationState*) {
    v.writable("style", &NavigationState::style, kStyle, "Which buttons and keys do what.");
    v.writable("keepUpright", &NavigationState::keep_upright, Flag{},
               "Turn about the scene's vertical, and stop at the poles.");
    v.writable("turnAbout", &NavigationState::turn_about, kTurnAbout,
               "What a drag turns about: the camera's `center`, or the surface point that was touched.");
    v.writable("rotateSpeed", &NavigationState::rotate_speed, kSpeed, "Multiplies turns by input.");
    v.writable("panSpeed", &NavigationState::pan_speed, kSpeed, "Multiplies pans by input.");
    v.writable("zoomSpeed", &NavigationState::zoom_speed, kSpeed, "Multiplies zooms by input.");
    v.writable("tapSwings", &NavigationState::tap_swings, Flag{},
               "A tap opens or closes what turns about a hinge.");
}

template <class V>
void describe(V& v, const RendererState*) {
    v.writable("mode", &RendererState::mode, kMode, "How surfaces are drawn.");
    v.writable("wireframe", &RendererState::wireframe, Flag{}, "Edges only.");
    v.writable("showSelection", &RendererState::show_selection, Flag{}, "Bring out what is selected.");
    v.fixed("solid", &RendererState::solid, kId, "Geometry nodes that are opaque.");
    v.fixed("transparent", &RendererState::transparent, kId, "Geometry nodes that are transparent.");
    v.fixed("reflective", &RendererState::reflective, kId, "Geometry nodes that reflect.");
}

template <class V>
void describe(V& v, const LightState*) {
    v.fixed("name", &LightState::name, kName, "As in the file.");
    v.fixed("type", &LightState::type, kName, "`point`, `directional` or `spot`.");
    v.writable("color", &LightState::color, kLightColor,
               "Red, green, blue, alpha; above 1 is brighter than white.");
    v.writable("attenuation", &LightState::attenuation, kAttenuation, "[constant, linear, quadratic].");
}

template <class V>
void describe(V& v, const LightsState*) {
    v.writable("active", &LightsState::active, kName,
               "Key of the item that shines; at the start `headlight`.");
    v.writable("items", &LightsState::items, SharedTable<Items<LightState>>{},
               "By the node's id, or `headlight`.");
}

template <class V>
void describe(V& v, const BackgroundState*) {
    v.fixed("name", &BackgroundState::name, kName, "As in the file.");
    v.writable("color", &BackgroundState::color, kColor, "Red, green, blue, alpha.");
    v.fixed("texture", &BackgroundState::texture, kName, "File of its texture.");
}

template <class V>
void describe(V& v, const BackgroundsState*) {
    v.writable("active", &BackgroundsState::active, kName,
               "Key of the item that is shown, or `color`: the plain one.");
    v.writable("color", &BackgroundsState::color, kColor, "Red, green, blue, alpha of the plain background.");
    v.writable("items", &BackgroundsState::items, SharedTable<Items<BackgroundState>>{},
               "By the id of the background.");
}

template <class V>
void describe(V& v, const SelectionState*) {
    v.writable("node", &SelectionState::node, kId, "The node that is selected.");
    v.fixed("name", &SelectionState::name, kName, "Name of the selected node.");
    v.fixed("path", &SelectionState::path, List<Text>{kName, 0, 32},
            "Names from the root to the selected node, the last 32.");
    v.fixed("pathIds", &SelectionState::path_ids, List<Integer>{kId, 0, 32}, "Ids of the nodes in `path`.");
    v.fixed("hinge", &SelectionState::hinge, kId, "The innermost node of `path` that has a hinge.");
}

template <class V>
void describe(V& v, const NodeOverride*) {
    v.writable("active", &NodeOverride::active, Flag{}, "False hides the node, with all below it.");
    v.writable("activeChild", &NodeOverride::active_child, kActiveChild,
               "Of a switch: counted from 0, −1 none, −2 all.");
    v.writable("matrix", &NodeOverride::matrix, kMatrix,
               "From the node's space to its parent's; the last row is 0 0 0 1.");
    v.writable("material", &NodeOverride::material, kId, "Id of the material of its geometry.");
}

template <class V>
void describe(V& v, const SwingState*) {
    v.fixed("to", &SwingState::to, Number{0, 1}, "Where it goes: 0 closed, 1 open.");
}

template <class V>
void describe(V& v, const Marker::View*) {
    using View = Marker::View;
    v.required("eye", &View::eye, kPosition, "Where the camera stands.");
    v.required("focus", &View::focus, kPosition, "What it looks at.");
    v.required("up", &View::up, kPosition,
               "Which way is up in the image; unit, at right angles to the view.");
    v.required("center", &View::center, kPosition, "The centre of rotation.");
    v.required("fov", &View::fov, kFov, "The vertical angle of view in degrees.");
}
template <class V>
void describe(V& v, const Marker*) {
    v.writable("point", &Marker::point, kPosition,
               "In the world, or in the space of `node`. A new marker must have it.");
    v.writable("node", &Marker::node, kId, "The marker moves with this node.");
    v.writable("text", &Marker::text, Text{1000}, "For clients to show; a frame has the sign only.");
    v.writable("author", &Marker::author, kClientName,
               "Who made it. Of a new marker without one: the client's name, if it has one.");
    v.writable("time", &Marker::time, kDate,
               "When it was made, in milliseconds since 1970 in UTC, by the clock of its client.");
    v.writable("view", &Marker::view, Object<Marker::View>{},
               "The camera that it was made from. Of a new marker without one: the present camera.");
    v.writable("done", &Marker::done, Flag{}, "What it asks for is done.");
}

template <class V>
void describe(V& v, const MeasureState*) {
    v.writable("kind", &MeasureState::kind, word("distance", "parallel", "angle", "radius", "length"),
               "What is measured.");
    v.writable("picks", &MeasureState::picks, List<Defined<Object<Feature>>>{kFeature, 1, 3},
               "Where. A new measure must have them.");
}

template <class V>
void describe(V& v, const MeasuredState*) {
    v.fixed("value", &MeasuredState::value, kAny, "In the scene's unit, or degrees.");
    v.fixed("components", &MeasuredState::components, Vector<glm::dvec3>{kAny.min, kAny.max},
            "Of a distance: the way from the first pick to the second, in the world.");
    v.fixed("line", &MeasuredState::line, kLine,
            "To be drawn, in the world; empty where a part is not shown.");
    v.fixed("problem", &MeasuredState::problem, kName, "Why there is no value, if there is none.");
}

template <class V>
void describe(V& v, const UnitState*) {
    v.writable("metres", &UnitState::metres, Number{1e-12, 1e12},
               "Of one unit of the scene; from the file, or 0.001.");
    v.writable("shown", &UnitState::shown, word("mm", "cm", "m", "in"),
               "The unit in which pages show lengths.");
}

template <class V>
void describe(V& v, const SectionState*) {
    v.writable("normal", &SectionState::normal, kPosition,
               "Where it leads is cut away; unit, of any length but 0 in a patch. A new plane must have it.");
    v.writable("distance", &SectionState::distance, Number{-kHuge, kHuge},
               "Of the plane from the world's origin, along `normal`.");
    v.writable("on", &SectionState::on, Flag{}, "False: it cuts nothing.");
    v.writable("caps", &SectionState::caps, Flag{}, "Watertight parts are closed where it cuts them.");
    v.writable("hatched", &SectionState::hatched, Flag{}, "The caps have lines across.");
}

template <class V>
void describe(V& v, const SectionBoxState*) {
    v.writable("min", &SectionBoxState::min, kPosition, "Its lowest corner; below `max` in each direction.");
    v.writable("max", &SectionBoxState::max, kPosition, "Its highest corner; at the start around the scene.");
    v.writable("on", &SectionBoxState::on, Flag{}, "True: nothing outside of the box is shown.");
    v.writable("caps", &SectionBoxState::caps, Flag{}, "Watertight parts are closed where it cuts them.");
    v.writable("hatched", &SectionBoxState::hatched, Flag{}, "The caps have lines across.");
}

template <class V>
void describe(V& v, const ViewState*) {
    v.writable("eye", &ViewState::eye, kPosition, "Where the camera stands.");
    v.writable("focus", &ViewState::focus, kPosition, "What it looks at.");
    v.writable("up", &ViewState::up, kPosition,
               "Which way is up in the image; unit, at right angles to the view.");
    v.writable("center", &ViewState::center, kPosition, "The centre of rotation.");
    v.writable("fov", &ViewState::fov, kFov, "The vertical angle of view in degrees.");
    v.writable("order", &ViewState::order, kOrder,
               "For clients to sort by: the lowest first, then those without one, by name.");
}

template <class V>
void describe(V& v, const QualityState*) {
    v.writable("preference", &QualityState::preference, Number{0, 1}, "0 speed, 1 accuracy.");
    v.writable("latencyTargetMs", &QualityState::latency_target_ms, Number{1, 10'000},
               "How old a frame may be when the holder sees it, while things move.");
}

template <class V>
void describe(V& v, const CueState::Camera*) {
    using Camera = CueState::Camera;
    v.writable("eye", &Camera::eye, kPosition, "Where the camera stands.");
    v.writable("focus", &Camera::focus, kPosition, "What it looks at.");
    v.writable("up", &Camera::up, kPosition,
               "Which way is up in the image; unit, at right angles to the view.");
    v.writable("center", &Camera::center, kPosition, "The centre of rotation.");
    v.writable("fov", &Camera::fov, kFov, "The vertical angle of view in degrees.");
}
template <class V>
void describe(V& v, const CueState::Lights*) {
    v.writable("active", &CueState::Lights::active, kName, "Key of the light that shines.");
}
template <class V>
void describe(V& v, const CueState::Backgrounds*) {
    using Backgrounds = CueState::Backgrounds;
    v.writable("active", &Backgrounds::active, kName,
               "Key of the background that is shown, or `color`: the plain one.");
    v.writable("color", &Backgrounds::color, kColor, "Red, green, blue, alpha of the plain background.");
}
template <class V>
void describe(V& v, const CueState::Selection*) {
    v.writable("node", &CueState::Selection::node, kId, "The node that is selected.");
}

template <class V>
void describe(V& v, const CueState*) {
    v.writable("order", &CueState::order, kOrder,
               "Cues follow each other by it: the lowest first, then those without one, by name.");
    v.writable("text", &CueState::text, Text{kMaxCueText}, "For who speaks.");
    v.writable("ms", &CueState::ms, kCueMs, "How long it takes to come to it, in milliseconds.");
    v.writable("easing", &CueState::easing, word("smooth", "linear"), "As of `fly`.");
    v.writable("camera", &CueState::camera, Section<CueState::Camera>{}, "Where the camera flies to.");
    v.writable("lights", &CueState::lights, Section<CueState::Lights>{}, "Which light shines.");
    v.writable("backgrounds", &CueState::backgrounds, Section<CueState::Backgrounds>{},
               "What stands behind the scene.");
    v.writable("selection", &CueState::selection, FromNothing<Section<CueState::Selection>>{},
               "What is selected.");
    v.writable("nodes", &CueState::nodes,
               FromNothing<SharedTable<Entries<NodeOverride>>>{{{{}, kMaxNodes, nullptr}}},
               "By id: all that differs from the file.");
    v.writable("sections", &CueState::sections,
               FromNothing<SharedTable<Entries<SectionState>>>{{{{}, kMaxSections, "normal"}}},
               "All planes that cut the scene open, by name.");
    v.writable("sectionBox", &CueState::section_box, Section<SectionBoxState>{},
               "A box that cuts the scene open.");
}

template <class V>
void describe(V& v, const ShownCueState*) {
    v.fixed("name", &ShownCueState::name, kName, "Its name among the `cues`.");
}

template <class V>
void describe(V& v, const PointingState*) {
    v.writable("watchers", &PointingState::watchers, Flag{},
               "Clients of the roles `view` and `host` may point, too.");
}

template <class V>
void describe(V& v, const ComfortState*) {
    v.writable("on", &ComfortState::on, Flag{}, "The camera of hosts keeps to these limits.");
    v.writable("degreesPerSecond", &ComfortState::degrees_per_second, Number{10, 720},
               "How fast the view turns at most.");
    v.writable("degreesPerSecondSquared", &ComfortState::degrees_per_second_squared, Number{10, 10'000},
               "How fast that speed changes at most.");
    v.writable("metresPerSecond", &ComfortState::metres_per_second, Number{0.1, 100},
               "How fast the eye moves at most, by the scene's unit.");
    v.writable("metresPerSecondSquared", &ComfortState::metres_per_second_squared, Number{0.1, 1000},
               "How fast that speed changes at most.");
}

template <class V>
void describe(V& v, const ControlState::Asking*) {
    v.fixed("client", &ControlState::Asking::client, kName, "The client's id.");
    v.fixed("name", &ControlState::Asking::name, kName, "As in its `hello`.");
}

template <class V>
void describe(V& v, const ControlState*) {
    v.fixed("holder", &ControlState::holder, kName, "Id of the client that holds control.");
    v.fixed("name", &ControlState::name, kName, "As in the holder's `hello`.");
    v.fixed("kept", &ControlState::kept, Flag{}, "True while there is a holder.");
    v.fixed("absent", &ControlState::absent, Flag{},
            "The holder has lost its connection, and may come back.");
    v.fixed("asking", &ControlState::asking, List<Object<ControlState::Asking>>{{}, 0, kMaxInteger},
            "Who asks for control, the first one first.");
}

template <class V>
void describe(V& v, const ClientState*) {
    v.fixed("name", &ClientState::name, kName, "As in `hello`, with its number.");
    v.fixed("role", &ClientState::role, kRole, "The role given.");
}

template <class V>
void describe(V& v, const RecordingState*) {
    v.fixed("name", &RecordingState::name, kName, "Of the event log.");
}

template <class V>
void describe(V& v, const State*) {
    v.fixed("scene", &State::scene, SharedKind<Object<SceneState>>{}, "The scene as in the file.");
    v.writable("camera", &State::camera, kCamera, "The one camera of all.");
    v.fixed("walls", &State::walls, Object<WallsState>{},
            "The camera that hosts have, while it is behind that of all.");
    v.fixed("cameras", &State::cameras, SharedKind<Table<Named>>{}, "Camera nodes, by id.");
    v.writable("navigation", &State::navigation, Section<NavigationState>{}, "What input does.");
    v.writable("renderer", &State::renderer, Section<RendererState>{}, "How the scene is drawn.");
    v.writable("lights", &State::lights, Section<LightsState>{}, "The lights, of which one shines.");
    v.fixed("materials", &State::materials, SharedKind<Table<Named>>{}, "Materials, by id.");
    v.writable("backgrounds", &State::backgrounds, Section<BackgroundsState>{},
               "The backgrounds, of which one is shown.");
    v.writable("selection", &State::selection, Section<SelectionState>{}, "What is selected.");
    v.writable("nodes", &State::nodes, SharedTable<Entries<NodeOverride>>{{{}, kMaxNodes, nullptr}},
               "By id: only what differs from the file.");
    v.fixed("swings", &State::swings, SharedTable<Table<SwingState>>{},
            "Nodes that are on their way about their hinges, by id.");
    v.writable("markers", &State::markers, SharedTable<Entries<Marker>>{{{}, kMaxEntries, "point"}},
               "Notes on points of the scene, by name.");
    v.writable("views", &State::views, SharedTable<Entries<ViewState>>{{{}, kMaxEntries, nullptr}},
               "Saved cameras, by name.");
    v.writable("sections", &State::sections, SharedTable<Entries<SectionState>>{{{}, kMaxSections, "normal"}},
               "Planes that cut the scene open, by name.");
    v.writable("sectionBox", &State::section_box, Section<SectionBoxState>{},
               "A box that cuts the scene open.");
    v.writable("measures", &State::measures, SharedTable<Entries<MeasureState>>{{{}, kMaxEntries, "picks"}},
               "Distances, angles and the like, by name.");
    v.fixed("measured", &State::measured, SharedTable<Table<MeasuredState>>{},
            "What `measures` come to as the parts stand now, by name.");
    v.writable("unit", &State::unit, Section<UnitState>{}, "Of lengths.");
    v.writable("cues", &State::cues, SharedTable<Entries<CueState>>{{{}, kMaxCues, nullptr}},
               "What a presentation shows, by name.");
    v.fixed("cue", &State::cue, Object<ShownCueState>{}, "The cue that was shown last.");
    v.writable("quality", &State::quality, Section<QualityState>{},
               "How frames are drawn while things move.");
    v.writable("pointing", &State::pointing, Section<PointingState>{}, "Who may point.");
    v.writable("comfort", &State::comfort, Section<ComfortState>{}, "How fast the camera of hosts moves.");
    v.fixed("control", &State::control, Object<ControlState>{}, "Who holds control, and who asks.");
    v.fixed("clients", &State::clients, SharedTable<Table<ClientState>>{},
            "Who is connected, by the client's id.");
    v.fixed("recording", &State::recording, Object<RecordingState>{}, "The event log that is written now.");
    v.fixed("notices", &State::notices, List<Defined<Object<Notice>>>{kNotice, 0, kMaxNotices},
            "What has gone wrong in the server, the newest last.");
}

// --- the frame header

template <class V>
void describe(V& v, const FrameHeader::Camera*) {
    v.inlined(&FrameHeader::Camera::pose);
    v.required("viewMatrix", &FrameHeader::Camera::view_matrix, Matrix{kAny.max},
               "From the world to the camera's space.");
    v.required("projectionMatrix", &FrameHeader::Camera::projection_matrix, Matrix{kAny.max},
               "From the camera's space to clip space.");
}

template <class V>
void describe(V& v, const FrameHeader::Renderer*) {
    v.required("mode", &FrameHeader::Renderer::mode, kMode, "How surfaces were drawn.");
    v.required("wireframe", &FrameHeader::Renderer::wireframe, Flag{}, "Edges only.");
    v.required("showSelection", &FrameHeader::Renderer::show_selection, Flag{},
               "What is selected was brought out.");
}

template <class V>
void describe(V& v, const FrameHeader::Timing*) {
    v.required("renderMs", &FrameHeader::Timing::render_ms, kDuration, "Drawing.");
    v.required("readbackMs", &FrameHeader::Timing::readback_ms, kDuration, "Reading the pixels back.");
    v.required("encodeMs", &FrameHeader::Timing::encode_ms, kDuration, "Encoding the file.");
    v.required("sinceInputMs", &FrameHeader::Timing::since_input_ms, kDuration,
               "From the arrival of the newest input that it shows to its hand-over to the socket.");
}

/// Without the inset, which is the client's own business.
struct SizeAlone : Object<Resize> {
    Json write(Resize size) const {
        size.inset = {};
        return Object::write(size);
    }
    Json schema() const {
        Json schema = Object::schema();
        schema["properties"].erase("inset");
        return schema;
    }
};

template <class V>
void describe(V& v, const FrameHeader::Pose*) {
    v.required("eye", &FrameHeader::Pose::eye, kPosition, "Where the camera stands.");
    v.required("focus", &FrameHeader::Pose::focus, kPosition, "What it looks at.");
    v.required("up", &FrameHeader::Pose::up, kPosition, "Which way is up in the image.");
    v.required("center", &FrameHeader::Pose::center, kPosition, "The centre of rotation.");
    v.required("fov", &FrameHeader::Pose::fov, kFov, "The vertical angle of view in degrees.");
}

template <class V>
void describe(V& v, const FrameHeader::Depth*) {
    v.required("frame", &FrameHeader::Depth::frame, kId, "The frame that the map was made for.");
    v.required("columns", &FrameHeader::Depth::columns, Integer{1, kMostDepthBlocks}, "Blocks in a row.");
    v.required("rows", &FrameHeader::Depth::rows, Integer{1, kMostDepthBlocks}, "Rows of blocks.");
    v.required("scale", &FrameHeader::Depth::scale, Number{0, kAny.max},
               "Reciprocal distance of the nearest surface along the view.");
    v.required("backgroundTurns", &FrameHeader::Depth::background_turns, Flag{},
               "What is infinitely far turns with the camera; else it stays where it is in the image.");
    v.required("camera", &FrameHeader::Depth::camera, Object<FrameHeader::Pose>{},
               "Where image and map were drawn from; missing: from the header's `camera`.");
    v.required("bytes", &FrameHeader::Depth::bytes, kId,
               "Of the map behind this file; 0: this client has it already.");
}

template <class V>
void describe(V& v, const FrameHeader*) {
    v.required("frame", &FrameHeader::frame, kId, "Number of the frame; it rises.");
    v.required("revision", &FrameHeader::revision, kId, "Of the state that it shows.");
    v.required("handled", &FrameHeader::handled, kId,
               "Highest `id` of this client that was handled when the state was taken; 0 before the first.");
    v.required("snapshot", &FrameHeader::snapshot, kId, "The `id` of the `snapshot` that asked for it.");
    v.required(
        "lease", &FrameHeader::lease, kId,
        "Of the server that drew it, where several share the room: it rises with each that takes over.");
    v.required("camera", &FrameHeader::camera, Object<FrameHeader::Camera>{},
               "The state's camera, with matrices.");
    v.required("width", &FrameHeader::width, kId, "Pixels of this file.");
    v.required("height", &FrameHeader::height, kId, "Pixels of this file.");
    v.required("view", &FrameHeader::view, SizeAlone{}, "The size of the view in force.");
    v.required("renderer", &FrameHeader::renderer, Object<FrameHeader::Renderer>{}, "How it was drawn.");
    v.required("quality", &FrameHeader::quality, kQuality, "With what accuracy.");
    v.required("timing", &FrameHeader::timing, Object<FrameHeader::Timing>{},
               "Milliseconds that were spent.");
    v.required("depth", &FrameHeader::depth, Object<FrameHeader::Depth>{},
               "How far away is what it shows, for clients that asked for it.");
    v.optional("markers", &FrameHeader::markers,
               ValuesByName<Vector<glm::dvec3>>{Vector<glm::dvec3>{kAny.min, kAny.max}},
               "Where the markers' signs stand in the world, by name.");
}

// --- level tables

inline constexpr Number kCost{0, 1e9};  // ms or bytes: their ratios stay numbers

template <class V>
void describe(V& v, const Level*) {
    v.required("quality", &Level::quality, kQuality,
               "As frame headers tell it. One with `level` `still` tells the `error` at rest.");
    v.required("ms", &Level::ms, kCost, "Median of drawing, reading back and encoding.");
    v.required("bytes", &Level::bytes, kCost, "Median of the files.");
    v.optional("reason", &Level::reason, Text{1000}, "Why it is in the table: a sentence.");
}

template <class V>
void describe(V& v, const LevelTable*) {
    v.required("scene", &LevelTable::scene, Text{100}, "SHA-256 of the scene's file.");
    v.required("renderer", &LevelTable::renderer, Text{1000}, "What draws, as the server's log tells it.");
    v.required("width", &LevelTable::width, kPixels, "Of the frames measured, at scale 1.");
    v.required("height", &LevelTable::height, kPixels, "Of the frames measured, at scale 1.");
    v.required("levels", &LevelTable::levels, List<Object<Level>>{{}, 1, kMaxLevels}, "By rising accuracy.");
}

// --- the file of a presentation

template <class V>
void describe(V& v, const CueList*) {
    v.required("format", &CueList::format, word("vrut-preview-cues"), "What the file is.");
    v.required("version", &CueList::version, Integer{1, CueList::kVersion}, "Of this format.");
    v.optional("scene", &CueList::scene, Text{1000}, "Name of the scene's file; missing: any.");
    v.required("cues", &CueList::cues, AnyObject{{{"$ref", "#/$defs/cues"}}}, "As the state's `cues`.");
}

// --- the queue of images

template <class V>
void describe(V& v, const RenderJob*) {
    v.required("run", &RenderJob::run, Text{100}, "By which the images of one film are known.");
    v.required("image", &RenderJob::image, Integer{1, kMaxFilmImages}, "Its number in the film.");
    v.required("scene", &RenderJob::scene, Text{1000}, "The scene's name in the workers' folder of scenes.");
    v.required("sha256", &RenderJob::sha256, Text{100}, "SHA-256 of all that the scene shows.");
    v.required("upAxis", &RenderJob::up_axis, kUpAxis, "Of a file that does not define it.");
    v.required("studio", &RenderJob::studio, word("automatic", "on", "off"),
               "Whether the scene is shown in a studio.");
    v.required("width", &RenderJob::width, kPixels, "Pixels.");
    v.required("height", &RenderJob::height, kPixels, "Pixels.");
    v.required("samples", &RenderJob::samples, Integer{1, 4096}, "A pixel.");
    v.required("detail", &RenderJob::detail, Number{0, 1000}, "By how many pixels surfaces may lie off.");
    v.required("format", &RenderJob::format, kFormat, "Of the image's file.");
    v.required("jpegQuality", &RenderJob::jpeg_quality, kJpegQuality, "Of a JPEG file.");
    v.required("patches", &RenderJob::patches, List<Text>{{kMaxMessageBytes}, 0, 100},
               "Merge patches of the state, as text.");
    v.required("camera", &RenderJob::camera, kCameraOverlay, "The whole camera.");
}

}  // namespace vrut::protocol
