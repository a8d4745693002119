#pragma once

#include "shared_descriptions.hpp"

/// The members of what clients send. For protocol's own .cpp files.
namespace vrut::protocol {

inline void describe(Fields<Hello>& v) {
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

inline void describe(Fields<Inset>& v) {
    v.optional("top", &Inset::top, Number{0, 8192}, "Covered at the top.");
    v.optional("right", &Inset::right, Number{0, 8192}, "Covered at the right.");
    v.optional("bottom", &Inset::bottom, Number{0, 8192}, "Covered at the bottom.");
    v.optional("left", &Inset::left, Number{0, 8192}, "Covered at the left.");
}

inline void describe(Fields<Resize>& v) {
    v.required("width", &Resize::width, Number{1, 8192}, "CSS pixels; fractions are allowed.");
    v.required("height", &Resize::height, Number{1, 8192}, "CSS pixels; fractions are allowed.");
    v.required("pixelRatio", &Resize::pixel_ratio, Number{0.25, 4}, "Pixels of the image to a CSS pixel.");
    v.optional("inset", &Resize::inset, Object{},
               "What lies on the view's sides and covers it, in CSS pixels.");
}

inline void describe(Fields<FrameGrant>& v) {
    v.optional(
        "shown", &FrameGrant::shown, Integer{1, kMaxInteger},
        "Number of the newest frame that the client has displayed: acknowledges it and all before it.");
}

inline void describe(Fields<Modifiers>& v) {
    v.optional("ctrlKey", &Modifiers::ctrl, Flag{}, "Control is held.");
    v.optional("shiftKey", &Modifiers::shift, Flag{}, "Shift is held.");
    v.optional("altKey", &Modifiers::alt, Flag{}, "Alt is held.");
    v.optional("metaKey", &Modifiers::meta, Flag{}, "Meta is held.");
}

inline void describe(Fields<Pointer>& v) {
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

inline void describe(Fields<Wheel>& v) {
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

inline void describe(Fields<Key>& v) {
    v.required("key", &Key::key, Text{64}, "What the key means, as in W3C UI Events: `f`, `ArrowLeft`.");
    v.required("code", &Key::code, Text{64}, "Which key it is, as in W3C UI Events: `KeyF`, `ArrowLeft`.");
    v.inlined(&Key::modifiers);
    v.optional("timeStamp", &Key::time_stamp, kTimeStamp,
               "When it happened, in milliseconds of the client's own clock.");
}

inline void describe(Fields<Navigate>& v) {
    v.optional("rotate", &Navigate::rotate, Vector{-1e6, 1e6}, "[right, down] in degrees, as if dragged.");
    v.optional("pan", &Navigate::pan, Vector{-1e6, 1e6},
               "[right, down]: how far the image moves, in view heights, in the plane through `focus`.");
    v.optional("zoom", &Navigate::zoom, Number{1e-6, 1e6}, "Divides the distance from eye to focus.");
}

inline void describe(Fields<Fit>& v) {
    v.optional("node", &Fit::node, kId, "The node to fit, with all below it; without it the scene.");
}

inline void describe(Fields<Swing>& v) {
    v.required("node", &Swing::node, kId, "A node with a hinge, or one below it.");
    v.optional("open", &Swing::open, Number{0, 1},
               "0 closed, 1 open; without it closed, or open where it is closed already.");
    v.optional("ms", &Swing::ms, Number{0, 60'000}, "The time from one end to the other.");
}

inline void describe(Fields<Patch>& v) {
    v.required("patch", &Patch::patch, AnyObject{"statePatch"},
               "A merge patch (RFC 7396) on the state document.");
    v.optional("ifRevision", &Patch::if_revision, kId,
               "The patch is refused where something that it names has changed since this revision.");
}

inline void describe(Fields<Cue>& v) {
    v.optional("name", &Cue::name, Text{100}, "Which. Without `step`.");
    v.optional("step", &Cue::step, Integer{-static_cast<std::int64_t>(kMaxCues), kMaxCues},
               "How many after the one that was shown last, in their order. Without `name`.");
    v.optional("camera", &Cue::camera, kCameraOverlay,
               "Laid over the camera of the cue, which does not change.");
    v.optional("ms", &Cue::ms, kCueMs, "How long it takes to come to it; without it the cue's own time.");
}

inline void describe(Fields<Check>& v) {
    v.required("cues", &Check::cues, AnyObject{"cueList"}, "A list of cues as in its file.");
}

inline void describe(Fields<SnapRequest>& v) {
    v.required("within", &SnapRequest::within, Number{0, 100}, "CSS pixels from the point of the view.");
    v.optional("to", &SnapRequest::to, List{kSnap, 0, kSnaps}, "What may be found; empty: all but `loop`.");
}

inline void describe(Fields<Pick>& v) {
    v.required("x", &Pick::x, kCoordinate, "CSS pixels from the view's left edge.");
    v.required("y", &Pick::y, kCoordinate, "CSS pixels from the view's top edge.");
    v.optional(
        "frame", &Pick::frame, kId,
        "The frame whose camera counts, one of the last 64 of the view; without it the present camera.");
    v.optional("then", &Pick::then, word("select", "center", "lookAt"),
               "Select the node, make the point the centre of rotation, or look at it, too.");
    v.optional("through", &Pick::through, Flag{},
               "Pass transparent parts; the realistic mode always passes those of alpha 0.");
    v.optional("snap", &Pick::snap, Object{}, "Find a corner, an edge or the like near by, too.");
}

inline void describe(Fields<Point>& v) {
    v.optional("x", &Point::x, kCoordinate,
               "CSS pixels from the view's left edge. Without `y` it must be missing.");
    v.optional("y", &Point::y, kCoordinate,
               "CSS pixels from the view's top edge. Without `x` it must be missing.");
    v.optional("frame", &Point::frame, kId,
               "The frame whose camera counts, as of `pick`; without it the present camera.");
}

inline void describe(Fields<RendererOverlay>& v) {
    v.optional("mode", &RendererOverlay::mode, kMode, "How surfaces are drawn.");
    v.optional("wireframe", &RendererOverlay::wireframe, Flag{}, "Edges only.");
    v.optional("showSelection", &RendererOverlay::show_selection, Flag{}, "Bring out what is selected.");
}

inline void describe(Fields<Snapshot>& v) {
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
    v.optional("renderer", &Snapshot::renderer, Object{},
               "Laid over the shared renderer, which does not change.");
}

inline void describe(Fields<Fly::Keyframe>& v) {
    v.required("at", &Fly::Keyframe::at, Number{0, 1e9}, "Milliseconds from the start; they rise strictly.");
    v.required("camera", &Fly::Keyframe::camera, kCameraOverlay,
               "Laid over the camera of the keyframe before, the first over the present one.");
}

inline void describe(Fields<Fly>& v) {
    v.required("keyframes", &Fly::keyframes, List{Object{}, 1, kMaxKeyframes},
               "The cameras to pass, the last of them exactly.");
    v.optional("easing", &Fly::easing, word("smooth", "linear"),
               "`smooth` eases the whole flight at its start and end; it does not stop at keyframes.");
}

inline void describe(Fields<Tree>& v) {
    v.optional("node", &Tree::node, kId, "Where to begin; without it at the root.");
    v.optional("depth", &Tree::depth, Integer{0, 1'000'000'000},
               "Levels below the node; without it 1, or all with `search` or `only`.");
    v.optional("search", &Tree::search, Text{1000},
               "Only nodes whose name has this part; A to Z count in either case.");
    v.optional("only", &Tree::only, word("switches", "hinges"), "Only switches, or only what has a hinge.");
    v.optional("after", &Tree::after, kId, "What the page before had as `next`.");
}

inline void describe(Fields<Open>& v) {
    v.required("scene", &Open::scene, Text{kMaxSceneName}, "A name as in the answer to `scenes`.");
    v.optional("upAxis", &Open::up_axis, kUpAxis,
               "The up axis, for formats that do not define it; without it the last choice.");
}

inline void describe(Fields<Scenes>&) {}

inline void describe(Fields<Record>& v) {
    v.required("action", &Record::action, word("start", "stop"), "Begin or end the log.");
    v.optional("name", &Record::name, Text{64},
               "Of the log: A to Z, a to z, 0 to 9, `_`, `-`. Without it a name is made of the time.");
}

inline void describe(Fields<Control>& v) {
    v.required("action", &Control::action, word("take", "release", "ask", "cancel", "give", "decline"),
               "What is to happen with control.");
    v.optional("client", &Control::client, Text{100},
               "Required with `give` and `decline`: the client that gets control, or does not.");
}

inline void describe(Fields<Share>& v) {
    v.optional("page", &Share::page, Text{1000},
               "Where the client has opened the page: an address of HTTP without query and fragment.");
}

inline void describe(Fields<Shown>& v) {
    v.required("revision", &Shown::revision, kId, "What the host's walls show now.");
}

}  // namespace vrut::protocol
