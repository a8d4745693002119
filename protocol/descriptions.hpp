#pragma once

#include <limits>

#include "fields.hpp"
#include "frame_header.hpp"
#include "messages.hpp"
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
inline constexpr Vector<glm::dvec4> kColor{0, 1};
inline constexpr Vector<glm::dvec4> kLightColor{0, kHuge};  // light may be brighter than white
inline constexpr Vector<glm::dvec3> kAttenuation{0, kHuge};
inline constexpr Number kFov{1, 170};
inline constexpr Number kSpeed{0.01, 100};
inline constexpr Number kOrder{-1e9, 1e9};
inline constexpr Matrix kMatrix{kHuge};
inline constexpr Integer kId{};
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

// --- client to server

template <class V>
void describe(V& v, const Hello*) {
    v.required("role", &Hello::role, kRole);
    v.optional("name", &Hello::name, kClientName);
    v.optional("token", &Hello::token, Text{1000});
    v.optional("resume", &Hello::resume, Text{100});
}

template <class V>
void describe(V& v, const Inset*) {
    v.optional("top", &Inset::top, Number{0, 8192});
    v.optional("right", &Inset::right, Number{0, 8192});
    v.optional("bottom", &Inset::bottom, Number{0, 8192});
    v.optional("left", &Inset::left, Number{0, 8192});
}

template <class V>
void describe(V& v, const Resize*) {
    v.required("width", &Resize::width, Number{1, 8192});
    v.required("height", &Resize::height, Number{1, 8192});
    v.required("pixelRatio", &Resize::pixel_ratio, Number{0.25, 4});
    v.optional("inset", &Resize::inset, Object<Inset>{});
}

template <class V>
void describe(V& v, const FrameGrant*) {
    v.optional("shown", &FrameGrant::shown, Integer{1, kMaxInteger});
}

template <class V>
void describe(V& v, const Modifiers*) {
    v.optional("ctrlKey", &Modifiers::ctrl, Flag{});
    v.optional("shiftKey", &Modifiers::shift, Flag{});
    v.optional("altKey", &Modifiers::alt, Flag{});
    v.optional("metaKey", &Modifiers::meta, Flag{});
}

template <class V>
void describe(V& v, const Pointer*) {
    v.required("pointerId", &Pointer::pointer_id, Integer{-kMaxInteger, kMaxInteger});
    v.required("pointerType", &Pointer::pointer_type, word("mouse", "touch", "pen"));
    v.required("x", &Pointer::x, kCoordinate);
    v.required("y", &Pointer::y, kCoordinate);
    v.required("button", &Pointer::button, Integer{-1, 31});
    v.required("buttons", &Pointer::buttons, Integer{0, std::numeric_limits<std::uint32_t>::max()});
    v.inlined(&Pointer::modifiers);
    v.optional("timeStamp", &Pointer::time_stamp, kTimeStamp);
    v.optional("frame", &Pointer::frame, kId);
}

template <class V>
void describe(V& v, const Wheel*) {
    v.required("x", &Wheel::x, kCoordinate);
    v.required("y", &Wheel::y, kCoordinate);
    v.required("deltaX", &Wheel::delta_x, kDelta);
    v.required("deltaY", &Wheel::delta_y, kDelta);
    v.required("deltaMode", &Wheel::delta_mode, Integer{0, 2});
    v.inlined(&Wheel::modifiers);
    v.optional("timeStamp", &Wheel::time_stamp, kTimeStamp);
}

template <class V>
void describe(V& v, const Key*) {
    v.required("key", &Key::key, Text{64});
    v.required("code", &Key::code, Text{64});
    v.inlined(&Key::modifiers);
    v.optional("timeStamp", &Key::time_stamp, kTimeStamp);
}

template <class V>
void describe(V& v, const Navigate*) {
    v.optional("rotate", &Navigate::rotate, Vector<glm::dvec2>{-1e6, 1e6});
    v.optional("pan", &Navigate::pan, Vector<glm::dvec2>{-1e6, 1e6});
    v.optional("zoom", &Navigate::zoom, Number{1e-6, 1e6});
}

template <class V>
void describe(V& v, const Fit*) {
    v.optional("node", &Fit::node, kId);
}

template <class V>
void describe(V& v, const Swing*) {
    v.required("node", &Swing::node, kId);
    v.optional("open", &Swing::open, Number{0, 1});
    v.optional("ms", &Swing::ms, Number{0, 60'000});
}

template <class V>
void describe(V& v, const Patch*) {
    v.required("patch", &Patch::patch, AnyObject{{{"$ref", "#/$defs/statePatch"}}});
    v.optional("ifRevision", &Patch::if_revision, kId);
}

template <class V>
void describe(V& v, const Pick*) {
    v.required("x", &Pick::x, kCoordinate);
    v.required("y", &Pick::y, kCoordinate);
    v.optional("frame", &Pick::frame, kId);
    v.optional("then", &Pick::then, word("select", "center", "lookAt"));
    v.optional("through", &Pick::through, Flag{});
}

template <class V>
void describe(V& v, const CameraOverlay*) {
    v.optional("node", &CameraOverlay::node, kId);
    v.optional("eye", &CameraOverlay::eye, kPosition);
    v.optional("focus", &CameraOverlay::focus, kPosition);
    v.optional("up", &CameraOverlay::up, kPosition);
    v.optional("center", &CameraOverlay::center, kPosition);
    v.optional("fov", &CameraOverlay::fov, kFov);
}

template <class V>
void describe(V& v, const RendererOverlay*) {
    v.optional("mode", &RendererOverlay::mode, kMode);
    v.optional("wireframe", &RendererOverlay::wireframe, Flag{});
    v.optional("showSelection", &RendererOverlay::show_selection, Flag{});
}

template <class V>
void describe(V& v, const Snapshot*) {
    v.required("width", &Snapshot::width, kPixels);
    v.required("height", &Snapshot::height, kPixels);
    v.optional("format", &Snapshot::format, kFormat);
    v.optional("jpegQuality", &Snapshot::jpeg_quality, kJpegQuality);
    v.optional("camera", &Snapshot::camera, Object<CameraOverlay>{});
    v.optional("renderer", &Snapshot::renderer, Object<RendererOverlay>{});
}

template <class V>
void describe(V& v, const Fly::Keyframe*) {
    v.required("at", &Fly::Keyframe::at, Number{0, 1e9});
    v.required("camera", &Fly::Keyframe::camera, Object<CameraOverlay>{});
}

template <class V>
void describe(V& v, const Fly*) {
    v.required("keyframes", &Fly::keyframes, List<Object<Fly::Keyframe>>{{}, 1, kMaxKeyframes});
    v.optional("easing", &Fly::easing, word("smooth", "linear"));
}

template <class V>
void describe(V& v, const Tree*) {
    v.optional("node", &Tree::node, kId);
    v.optional("depth", &Tree::depth, Integer{0, 1'000'000'000});
    v.optional("search", &Tree::search, Text{1000});
    v.optional("only", &Tree::only, word("switches", "hinges"));
    v.optional("after", &Tree::after, kId);
}

template <class V>
void describe(V& v, const Open*) {
    v.required("scene", &Open::scene, Text{kMaxSceneName});
}

template <class V>
void describe(V&, const Scenes*) {}

template <class V>
void describe(V& v, const Record*) {
    v.required("action", &Record::action, word("start", "stop"));
    v.optional("name", &Record::name, Text{64});
}

template <class V>
void describe(V& v, const Control*) {
    v.required("action", &Control::action, word("take", "release", "ask", "cancel", "give", "decline"));
    v.optional("client", &Control::client, Text{100});
}

template <class V>
void describe(V& v, const Share*) {
    v.optional("page", &Share::page, Text{1000});
}

template <class V>
void describe(V& v, const Shown*) {
    v.required("revision", &Shown::revision, kId);
}

// --- server to client

template <class V>
void describe(V& v, const Limits*) {
    v.required("maxMessage", &Limits::max_message, kId);
    v.required("maxDepth", &Limits::max_depth, kId);
    v.required("maxGrants", &Limits::max_grants, kId);
    v.required("maxPixels", &Limits::max_pixels, kId);
    v.required("messagesPerSecond", &Limits::messages_per_second, kId);
    v.required("maxServerMessage", &Limits::max_server_message, kId);
}

template <class V>
void describe(V& v, const InputRules*) {
    v.required("wheelSteps", &InputRules::wheel_steps, Vector<glm::dvec3>{kDuration.min, kDuration.max});
    v.required("wheelZoom", &InputRules::wheel_zoom, kDuration);
    v.required("dragZoom", &InputRules::drag_zoom, kDuration);
    v.required("drags", &InputRules::drags, ValuesByName<ValuesByName<Text>>{{kName}});
    v.required("keys", &InputRules::keys, List<Text>{kName, 0, kMaxInteger});
    v.required("repeatingKeys", &InputRules::repeating_keys, List<Text>{kName, 0, kMaxInteger});
}

template <class V>
void describe(V& v, const Welcome*) {
    v.required("id", &Welcome::id, kId);
    v.required("version", &Welcome::version, Integer{kVersion, kVersion});
    v.required("server", &Welcome::server, kName);
    v.required("client", &Welcome::client, kName);
    v.required("role", &Welcome::role, kRole);
    v.required("limits", &Welcome::limits, Object<Limits>{});
    v.required("input", &Welcome::input, Object<InputRules>{});
}

template <class V>
void describe(V& v, const Ok*) {
    v.required("id", &Ok::id, kId);
    v.required("revision", &Ok::revision, kId);
    v.required("name", &Ok::name, kName);
}

template <class V>
void describe(V& v, const Picked*) {
    v.required("id", &Picked::id, kId);
    v.required("node", &Picked::node, kId);
    v.required("name", &Picked::name, kName);
    v.required("path", &Picked::path, List<Text>{kName, 0, 32});
    v.required("point", &Picked::point, Vector<glm::dvec3>{kAny.min, kAny.max});
    v.required("normal", &Picked::normal, Vector<glm::dvec3>{-1.001, 1.001});
    v.required("distance", &Picked::distance, kDuration);
    v.required("local", &Picked::local, Vector<glm::dvec3>{kAny.min, kAny.max});
}

template <class V>
void describe(V& v, const Flown*) {
    v.required("id", &Flown::id, kId);
    v.required("completed", &Flown::completed, Flag{});
}

template <class V>
void describe(V& v, const TreeHinge*) {
    v.required("axis", &TreeHinge::axis, Vector<glm::dvec3>{-1.001, 1.001});
    v.required("degrees", &TreeHinge::degrees, Number{-360, 360});
    v.required("closed", &TreeHinge::closed, kMatrix);
}

template <class V>
void describe(V& v, const TreeNode*) {
    v.required("id", &TreeNode::id, kId);
    v.required("name", &TreeNode::name, kName);
    v.required("type", &TreeNode::type, kName);
    v.required("parent", &TreeNode::parent, kId);
    v.required("active", &TreeNode::active, Flag{});
    v.required("children", &TreeNode::children, kId);
    v.required("triangles", &TreeNode::triangles, kId);
    v.required("material", &TreeNode::material, kId);
    v.required("matrix", &TreeNode::matrix, kMatrix);
    v.required("hinge", &TreeNode::hinge, Object<TreeHinge>{});
    v.required("activeChild", &TreeNode::active_child, kActiveChild);
    v.required("choices", &TreeNode::choices, List<Text>{kName, 0, kMaxChoices});
}

template <class V>
void describe(V& v, const TreePage*) {
    v.required("id", &TreePage::id, kId);
    v.required("nodes", &TreePage::nodes, List<Object<TreeNode>>{{}, 0, kMaxInteger});
    v.required("next", &TreePage::next, kId);
}

template <class V>
void describe(V& v, const SceneList*) {
    v.required("id", &SceneList::id, kId);
    v.required("scenes", &SceneList::scenes, List<Text>{Text{kMaxSceneName}, 0, kMaxScenes});
}

template <class V>
void describe(V& v, const SharedAddress*) {
    v.required("id", &SharedAddress::id, kId);
    v.required("address", &SharedAddress::address, kName);
    v.required("qr", &SharedAddress::qr, List<Text>{Text{kMaxQrSize}, 0, kMaxQrSize});
    v.required("loopback", &SharedAddress::loopback, Flag{});
}

template <class V>
void describe(V& v, const Loading*) {
    v.required("scene", &Loading::scene, kName);
    v.required("fraction", &Loading::fraction, Number{0, 1});
    v.required("done", &Loading::done, Flag{});
    v.required("refused", &Loading::refused, kName);
}

template <class V>
void describe(V& v, const Error*) {
    v.required("id", &Error::id, kId);
    v.required("code", &Error::code, kName);
    v.required("message", &Error::message, Text{300});
}

struct NoticeCode : Text {
    Json schema() const { return {{"enum", notice_code::all}}; }
};

template <class V>
void describe(V& v, const Notice*) {
    v.fixed("code", &Notice::code, NoticeCode{kName});
    v.fixed("message", &Notice::message, kName);
}

template <class V>
void describe(V& v, const Quality*) {
    v.required("level", &Quality::level, word("moving", "still"));
    v.required("scale", &Quality::scale, Number{0, 1});
    v.required("samples", &Quality::samples, Integer{1, 65536});
    v.required("detail", &Quality::detail, kDuration);
    v.required("jpegQuality", &Quality::jpeg_quality, kJpegQuality);
    v.required("subsampling", &Quality::subsampling, word("4:2:0", "4:4:4"));
    v.optional("error", &Quality::error, Number{0, 1});
}

template <class V>
void describe(V& v, const Stats::Renderer*) {
    v.required("meanRenderMs", &Stats::Renderer::mean_render_ms, kDuration);
    v.required("medianRenderMs", &Stats::Renderer::median_render_ms, kDuration);
    v.required("p95RenderMs", &Stats::Renderer::p95_render_ms, kDuration);
}

template <class V>
void describe(V& v, const Stats::Host*) {
    v.required("name", &Stats::Host::name, kName);
    v.required("revision", &Stats::Host::revision, kId);
    v.required("lagMs", &Stats::Host::lag_ms, kDuration);
}

template <class V>
void describe(V& v, const Stats*) {
    v.required("renderer", &Stats::renderer, Object<Stats::Renderer>{});
    v.required("quality", &Stats::quality, Object<Quality>{});
    v.required("hosts", &Stats::hosts, Table<Stats::Host>{});
    v.required("clients", &Stats::clients, kId);
    v.required("watchers", &Stats::watchers, kId);
    v.required("framesPerSecond", &Stats::frames_per_second, kDuration);
    v.required("bytesPerSecond", &Stats::bytes_per_second, kDuration);
}

// --- the state document

template <class V>
void describe(V& v, const SceneState::Bounds*) {
    v.fixed("min", &SceneState::Bounds::min, kPosition);
    v.fixed("max", &SceneState::Bounds::max, kPosition);
}

template <class V>
void describe(V& v, const SceneState*) {
    v.fixed("name", &SceneState::name, kName);
    v.fixed("file", &SceneState::file, Text{kMaxSceneName});
    v.fixed("nodes", &SceneState::nodes, kId);
    v.fixed("materials", &SceneState::materials, kId);
    v.fixed("geometries", &SceneState::geometries, kId);
    v.fixed("triangles", &SceneState::triangles, kId);
    v.fixed("bounds", &SceneState::bounds, Object<SceneState::Bounds>{});
    v.fixed("notices", &SceneState::notices, List<Object<Notice>>{{}, 0, kMaxInteger});
}

template <class V>
void describe(V& v, const CameraState*) {
    v.writable("node", &CameraState::node, kId);
    v.fixed("name", &CameraState::name, kName);
    v.writable("eye", &CameraState::eye, kPosition);
    v.writable("focus", &CameraState::focus, kPosition);
    v.writable("up", &CameraState::up, kPosition);
    v.writable("center", &CameraState::center, kPosition);
    v.writable("fov", &CameraState::fov, kFov);
    v.fixed("near", &CameraState::near, kDuration);
    v.fixed("far", &CameraState::far, kDuration);
}

template <class V>
void describe(V& v, const Named*) {
    v.fixed("name", &Named::name, kName);
}

template <class V>
void describe(V& v, const NavigationState*) {
    v.writable("style", &NavigationState::style, kStyle);
    v.writable("keepUpright", &NavigationState::keep_upright, Flag{});
    v.writable("turnAbout", &NavigationState::turn_about, kTurnAbout);
    v.writable("rotateSpeed", &NavigationState::rotate_speed, kSpeed);
    v.writable("panSpeed", &NavigationState::pan_speed, kSpeed);
    v.writable("zoomSpeed", &NavigationState::zoom_speed, kSpeed);
    v.writable("tapSwings", &NavigationState::tap_swings, Flag{});
}

template <class V>
void describe(V& v, const RendererState*) {
    v.writable("mode", &RendererState::mode, kMode);
    v.writable("wireframe", &RendererState::wireframe, Flag{});
    v.writable("showSelection", &RendererState::show_selection, Flag{});
    v.fixed("solid", &RendererState::solid, kId);
    v.fixed("transparent", &RendererState::transparent, kId);
    v.fixed("reflective", &RendererState::reflective, kId);
}

template <class V>
void describe(V& v, const LightState*) {
    v.fixed("name", &LightState::name, kName);
    v.fixed("type", &LightState::type, kName);
    v.writable("color", &LightState::color, kLightColor);
    v.writable("attenuation", &LightState::attenuation, kAttenuation);
}

template <class V>
void describe(V& v, const LightsState*) {
    v.writable("active", &LightsState::active, kName);
    v.writable("items", &LightsState::items, SharedTable<Items<LightState>>{});
}

template <class V>
void describe(V& v, const BackgroundState*) {
    v.fixed("name", &BackgroundState::name, kName);
    v.writable("color", &BackgroundState::color, kColor);
    v.fixed("texture", &BackgroundState::texture, kName);
}

template <class V>
void describe(V& v, const BackgroundsState*) {
    v.writable("active", &BackgroundsState::active, kName);
    v.writable("color", &BackgroundsState::color, kColor);
    v.writable("items", &BackgroundsState::items, SharedTable<Items<BackgroundState>>{});
}

template <class V>
void describe(V& v, const SelectionState*) {
    v.writable("node", &SelectionState::node, kId);
    v.fixed("name", &SelectionState::name, kName);
    v.fixed("path", &SelectionState::path, List<Text>{kName, 0, 32});
    v.fixed("pathIds", &SelectionState::path_ids, List<Integer>{kId, 0, 32});
    v.fixed("hinge", &SelectionState::hinge, kId);
}

template <class V>
void describe(V& v, const NodeOverride*) {
    v.writable("active", &NodeOverride::active, Flag{});
    v.writable("activeChild", &NodeOverride::active_child, kActiveChild);
    v.writable("matrix", &NodeOverride::matrix, kMatrix);
    v.writable("material", &NodeOverride::material, kId);
}

template <class V>
void describe(V& v, const SwingState*) {
    v.fixed("to", &SwingState::to, Number{0, 1});
}

template <class V>
void describe(V& v, const Marker*) {
    v.writable("point", &Marker::point, kPosition);
    v.writable("node", &Marker::node, kId);
    v.writable("text", &Marker::text, Text{1000});
}

template <class V>
void describe(V& v, const ViewState*) {
    v.writable("eye", &ViewState::eye, kPosition);
    v.writable("focus", &ViewState::focus, kPosition);
    v.writable("up", &ViewState::up, kPosition);
    v.writable("center", &ViewState::center, kPosition);
    v.writable("fov", &ViewState::fov, kFov);
    v.writable("order", &ViewState::order, kOrder);
}

template <class V>
void describe(V& v, const QualityState*) {
    v.writable("preference", &QualityState::preference, Number{0, 1});
    v.writable("latencyTargetMs", &QualityState::latency_target_ms, Number{1, 10'000});
}

template <class V>
void describe(V& v, const ControlState::Asking*) {
    v.fixed("client", &ControlState::Asking::client, kName);
    v.fixed("name", &ControlState::Asking::name, kName);
}

template <class V>
void describe(V& v, const ControlState*) {
    v.fixed("holder", &ControlState::holder, kName);
    v.fixed("name", &ControlState::name, kName);
    v.fixed("kept", &ControlState::kept, Flag{});
    v.fixed("absent", &ControlState::absent, Flag{});
    v.fixed("asking", &ControlState::asking, List<Object<ControlState::Asking>>{{}, 0, kMaxInteger});
}

template <class V>
void describe(V& v, const ClientState*) {
    v.fixed("name", &ClientState::name, kName);
    v.fixed("role", &ClientState::role, kRole);
}

template <class V>
void describe(V& v, const RecordingState*) {
    v.fixed("name", &RecordingState::name, kName);
}

template <class V>
void describe(V& v, const State*) {
    v.fixed("scene", &State::scene, SharedKind<Object<SceneState>>{});
    v.writable("camera", &State::camera, Section<CameraState>{});
    v.fixed("cameras", &State::cameras, SharedKind<Table<Named>>{});
    v.writable("navigation", &State::navigation, Section<NavigationState>{});
    v.writable("renderer", &State::renderer, Section<RendererState>{});
    v.writable("lights", &State::lights, Section<LightsState>{});
    v.fixed("materials", &State::materials, SharedKind<Table<Named>>{});
    v.writable("backgrounds", &State::backgrounds, Section<BackgroundsState>{});
    v.writable("selection", &State::selection, Section<SelectionState>{});
    v.writable("nodes", &State::nodes, SharedTable<Entries<NodeOverride>>{{{}, kMaxNodes, nullptr}});
    v.fixed("swings", &State::swings, SharedTable<Table<SwingState>>{});
    v.writable("markers", &State::markers, SharedTable<Entries<Marker>>{{{}, kMaxEntries, "point"}});
    v.writable("views", &State::views, SharedTable<Entries<ViewState>>{{{}, kMaxEntries, nullptr}});
    v.writable("quality", &State::quality, Section<QualityState>{});
    v.fixed("control", &State::control, Object<ControlState>{});
    v.fixed("clients", &State::clients, SharedTable<Table<ClientState>>{});
    v.fixed("recording", &State::recording, Object<RecordingState>{});
    v.fixed("notices", &State::notices, List<Object<Notice>>{{}, 0, kMaxNotices});
}

// --- the frame header

template <class V>
void describe(V& v, const FrameHeader::Camera*) {
    v.inlined(&FrameHeader::Camera::pose);
    v.required("viewMatrix", &FrameHeader::Camera::view_matrix, Matrix{kAny.max});
    v.required("projectionMatrix", &FrameHeader::Camera::projection_matrix, Matrix{kAny.max});
}

template <class V>
void describe(V& v, const FrameHeader::Renderer*) {
    v.required("mode", &FrameHeader::Renderer::mode, kMode);
    v.required("wireframe", &FrameHeader::Renderer::wireframe, Flag{});
    v.required("showSelection", &FrameHeader::Renderer::show_selection, Flag{});
}

template <class V>
void describe(V& v, const FrameHeader::Timing*) {
    v.required("renderMs", &FrameHeader::Timing::render_ms, kDuration);
    v.required("readbackMs", &FrameHeader::Timing::readback_ms, kDuration);
    v.required("encodeMs", &FrameHeader::Timing::encode_ms, kDuration);
    v.required("sinceInputMs", &FrameHeader::Timing::since_input_ms, kDuration);
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
void describe(V& v, const FrameHeader*) {
    v.required("frame", &FrameHeader::frame, kId);
    v.required("revision", &FrameHeader::revision, kId);
    v.required("handled", &FrameHeader::handled, kId);
    v.required("snapshot", &FrameHeader::snapshot, kId);
    v.required("camera", &FrameHeader::camera, Object<FrameHeader::Camera>{});
    v.required("width", &FrameHeader::width, kId);
    v.required("height", &FrameHeader::height, kId);
    v.required("view", &FrameHeader::view, SizeAlone{});
    v.required("renderer", &FrameHeader::renderer, Object<FrameHeader::Renderer>{});
    v.required("quality", &FrameHeader::quality, Object<Quality>{});
    v.required("timing", &FrameHeader::timing, Object<FrameHeader::Timing>{});
    v.optional("markers", &FrameHeader::markers,
               ValuesByName<Vector<glm::dvec3>>{Vector<glm::dvec3>{kAny.min, kAny.max}});
}

}  // namespace vrut::protocol
