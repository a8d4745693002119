#pragma once

#include "shared_descriptions.hpp"
#include "state.hpp"

/// The members of the state document. For protocol's own .cpp files.
namespace vrut::protocol {

inline void describe(Fields<SceneState::Bounds>& v) {
    v.fixed("min", &SceneState::Bounds::min, kPosition, "The least coordinates.");
    v.fixed("max", &SceneState::Bounds::max, kPosition, "The greatest coordinates.");
}

inline void describe(Fields<SceneState::Seat>& v) {
    v.fixed("eye", &SceneState::Seat::eye, kPosition, "The middle of where the eye is then.");
    v.fixed("radius", &SceneState::Seat::radius, kDuration, "How far from it the eye may be.");
}

inline void describe(Fields<SceneState>& v) {
    v.fixed("name", &SceneState::name, kName, "The scene's title.");
    v.fixed("file", &SceneState::file, Text{kMaxSceneName}, "The name by which `open` takes it.");
    v.fixed("upAxis", &SceneState::up_axis, kUpAxis,
            "The up axis in use; only for formats that do not define it: OBJ, STL and PLY.");
    v.fixed("nodes", &SceneState::nodes, kId, "Number of nodes.");
    v.fixed("materials", &SceneState::materials, kId, "Number of materials.");
    v.fixed("geometries", &SceneState::geometries, kId, "Number of geometries.");
    v.fixed("triangles", &SceneState::triangles, kId, "Number of triangles.");
    v.fixed("bounds", &SceneState::bounds, Object{}, "The scene's box in the world.");
    v.fixed("seats", &SceneState::seats, List{Object{}, 0, kMaxInteger},
            "Where drags that rotate turn the view about the eye.");
    v.fixed("notices", &SceneState::notices, List{kNotice, 0, kMaxInteger},
            "What to know of it, as what of the file is not shown.");
}

inline void describe(Fields<CameraState>& v) {
    v.writable("node", &CameraState::node, kId, "The camera node at which the camera stands.");
    v.fixed("name", &CameraState::name, kName, "Name of the camera node at which the camera stands.");
    describe_pose(v);
    v.fixed("near", &CameraState::near, kDuration,
            "Near end of a clip range for hosts' own drawing; never below 10⁻⁶ of `far`.");
    v.fixed("far", &CameraState::far, kDuration, "Far end of a clip range for hosts' own drawing.");
}

inline void describe(Fields<WallsState>& v) {
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

inline void describe(Fields<Named>& v) { v.fixed("name", &Named::name, kName, "As in the file."); }

inline void describe(Fields<NavigationState>& v) {
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

inline void describe(Fields<RendererState>& v) {
    v.writable("mode", &RendererState::mode, kMode, "How surfaces are drawn.", survives_open);
    v.writable("wireframe", &RendererState::wireframe, Flag{}, "Edges only.", survives_open);
    v.writable("showSelection", &RendererState::show_selection, Flag{}, "Bring out what is selected.",
               survives_open);
    v.fixed("solid", &RendererState::solid, kId, "Geometry nodes that are opaque.");
    v.fixed("transparent", &RendererState::transparent, kId, "Geometry nodes that are transparent.");
    v.fixed("reflective", &RendererState::reflective, kId, "Geometry nodes that reflect.");
}

inline void describe(Fields<LightState>& v) {
    v.fixed("name", &LightState::name, kName, "As in the file.");
    v.fixed("type", &LightState::type, kName, "`point`, `directional` or `spot`.");
    v.writable("color", &LightState::color, kLightColor,
               "Red, green, blue, alpha; above 1 is brighter than white.");
    v.writable("attenuation", &LightState::attenuation, kAttenuation, "[constant, linear, quadratic].");
}

inline void describe(Fields<LightsState>& v) {
    v.writable("active", &LightsState::active, kName,
               "Key of the item that shines; at the start `headlight`.", in_cues);
    v.writable("items", &LightsState::items, Items{}, "By the node's id, or `headlight`.");
}

inline void describe(Fields<BackgroundState>& v) {
    v.fixed("name", &BackgroundState::name, kName, "As in the file.");
    v.writable("color", &BackgroundState::color, kColor, "Red, green, blue, alpha.");
    v.fixed("texture", &BackgroundState::texture, kName, "File of its texture.");
}

inline void describe(Fields<BackgroundsState>& v) {
    v.writable("active", &BackgroundsState::active, kName,
               "Key of the item that is shown, or `color`: the plain one.", in_cues);
    v.writable("color", &BackgroundsState::color, kColor, "Red, green, blue, alpha of the plain background.",
               in_cues);
    v.writable("items", &BackgroundsState::items, Items{}, "By the id of the background.");
}

inline void describe(Fields<SelectionState>& v) {
    v.writable("node", &SelectionState::node, kId, "The node that is selected.", in_cues);
    v.fixed("name", &SelectionState::name, kName, "Name of the selected node.");
    v.fixed("path", &SelectionState::path, List{kName, 0, 32},
            "Names from the root to the selected node, the last 32.");
    v.fixed("pathIds", &SelectionState::path_ids, List{kId, 0, 32}, "Ids of the nodes in `path`.");
    v.fixed("hinge", &SelectionState::hinge, kId, "The innermost node of `path` that has a hinge.");
}

inline void describe(Fields<NodeOverride>& v) {
    v.writable("active", &NodeOverride::active, Flag{}, "False hides the node, with all below it.");
    v.writable("activeChild", &NodeOverride::active_child, kActiveChild,
               "Of a switch: counted from 0, −1 none, −2 all.");
    v.writable("matrix", &NodeOverride::matrix, kMatrix,
               "From the node's space to its parent's; the last row is 0 0 0 1.");
    v.writable("material", &NodeOverride::material, kId, "Id of the material of its geometry.");
}

inline void describe(Fields<SwingState>& v) {
    v.fixed("to", &SwingState::to, Number{0, 1}, "Where it goes: 0 closed, 1 open.");
}

inline void describe(Fields<Marker>& v) {
    v.writable("point", &Marker::point, kPosition,
               "In the world, or in the space of `node`. A new marker must have it.");
    v.writable("node", &Marker::node, kId, "The marker moves with this node.");
    v.writable("text", &Marker::text, Text{1000}, "For clients to show; a frame has the sign only.");
    v.writable("author", &Marker::author, kClientName,
               "Who made it. Of a new marker without one: the client's name, if it has one.");
    v.writable("time", &Marker::time, kDate,
               "When it was made, in milliseconds since 1970 in UTC, by the clock of its client.");
    v.writable("view", &Marker::view, Object{nullptr, &table_of_whole_pose},
               "The camera that it was made from. Of a new marker without one: the present camera.");
    v.writable("done", &Marker::done, Flag{}, "What it asks for is done.");
}

inline void describe(Fields<MeasureState>& v) {
    v.writable("kind", &MeasureState::kind, word("distance", "parallel", "angle", "radius", "length"),
               "What is measured.");
    v.writable("picks", &MeasureState::picks, List{kFeature, 1, 3}, "Where. A new measure must have them.");
}

inline void describe(Fields<MeasuredState>& v) {
    v.fixed("value", &MeasuredState::value, kAny, "In the scene's unit, or degrees.");
    v.fixed("components", &MeasuredState::components, Vector{kAny.min, kAny.max},
            "Of a distance: the way from the first pick to the second, in the world.");
    v.fixed("line", &MeasuredState::line, kLine,
            "To be drawn, in the world; empty where a part is not shown.");
    v.fixed("problem", &MeasuredState::problem, kName, "Why there is no value, if there is none.");
}

inline void describe(Fields<UnitState>& v) {
    v.writable("metres", &UnitState::metres, Number{1e-12, 1e12},
               "Of one unit of the scene; from the file, or 0.001.");
    v.writable("shown", &UnitState::shown, word("mm", "cm", "m", "in"),
               "The unit in which pages show lengths.");
}

inline void describe(Fields<SectionState>& v) {
    v.writable("normal", &SectionState::normal, kPosition,
               "Where it leads is cut away; unit, of any length but 0 in a patch. A new plane must have it.");
    v.writable("distance", &SectionState::distance, Number{-kHuge, kHuge},
               "Of the plane from the world's origin, along `normal`.");
    v.writable("on", &SectionState::on, Flag{}, "False: it cuts nothing.");
    v.writable("caps", &SectionState::caps, Flag{}, "Watertight parts are closed where it cuts them.");
    v.writable("hatched", &SectionState::hatched, Flag{}, "The caps have lines across.");
}

inline void describe(Fields<SectionBoxState>& v) {
    v.writable("min", &SectionBoxState::min, kPosition, "Its lowest corner; below `max` in each direction.");
    v.writable("max", &SectionBoxState::max, kPosition, "Its highest corner; at the start around the scene.");
    v.writable("on", &SectionBoxState::on, Flag{}, "True: nothing outside of the box is shown.");
    v.writable("caps", &SectionBoxState::caps, Flag{}, "Watertight parts are closed where it cuts them.");
    v.writable("hatched", &SectionBoxState::hatched, Flag{}, "The caps have lines across.");
}

inline void describe(Fields<ViewState>& v) {
    describe_pose(v);
    v.writable("order", &ViewState::order, kOrder,
               "For clients to sort by: the lowest first, then those without one, by name.");
}

inline void describe(Fields<QualityState>& v) {
    v.writable("preference", &QualityState::preference, Number{0, 1}, "0 speed, 1 accuracy.");
    v.writable("latencyTargetMs", &QualityState::latency_target_ms, Number{1, 10'000},
               "How old a frame may be when the holder sees it, while things move.");
}

inline void describe(Fields<CueState::Lights>& v) {
    v.writable("active", &CueState::Lights::active, kName, "Key of the light that shines.");
}
inline void describe(Fields<CueState::Backgrounds>& v) {
    using Backgrounds = CueState::Backgrounds;
    v.writable("active", &Backgrounds::active, kName,
               "Key of the background that is shown, or `color`: the plain one.");
    v.writable("color", &Backgrounds::color, kColor, "Red, green, blue, alpha of the plain background.");
}
inline void describe(Fields<CueState::Selection>& v) {
    v.writable("node", &CueState::Selection::node, kId, "The node that is selected.");
}

inline void describe(Fields<CueState>& v) {
    v.writable("order", &CueState::order, kOrder,
               "Cues follow each other by it: the lowest first, then those without one, by name.");
    v.writable("text", &CueState::text, Text{kMaxCueText}, "For who speaks.");
    v.writable("ms", &CueState::ms, kCueMs, "How long it takes to come to it, in milliseconds.");
    v.writable("easing", &CueState::easing, word("smooth", "linear"), "As of `fly`.");
    v.writable("camera", &CueState::camera, Section{}, "Where the camera flies to.");
    v.writable("lights", &CueState::lights, Section{}, "Which light shines.");
    v.writable("backgrounds", &CueState::backgrounds, Section{}, "What stands behind the scene.");
    v.writable("selection", &CueState::selection, Section{}, "What is selected.", from_nothing);
    v.writable("nodes", &CueState::nodes, Entries{kMaxNodes}, "By id: all that differs from the file.",
               from_nothing);
    v.writable("sections", &CueState::sections, Entries{kMaxSections, "normal"},
               "All planes that cut the scene open, by name.", from_nothing);
    v.writable("sectionBox", &CueState::section_box, Section{}, "A box that cuts the scene open.");
}

inline void describe(Fields<ShownCueState>& v) {
    v.fixed("name", &ShownCueState::name, kName, "Its name among the `cues`.");
}

inline void describe(Fields<PointingState>& v) {
    v.writable("watchers", &PointingState::watchers, Flag{},
               "Clients of the roles `view` and `host` may point, too.");
}

inline void describe(Fields<ComfortState>& v) {
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

inline void describe(Fields<ControlState::Asking>& v) {
    v.fixed("client", &ControlState::Asking::client, kName, "The client's id.");
    v.fixed("name", &ControlState::Asking::name, kName, "As in its `hello`.");
}

inline void describe(Fields<ControlState>& v) {
    v.fixed("holder", &ControlState::holder, kName, "Id of the client that holds control.");
    v.fixed("name", &ControlState::name, kName, "As in the holder's `hello`.");
    v.fixed("kept", &ControlState::kept, Flag{}, "True while there is a holder.");
    v.fixed("absent", &ControlState::absent, Flag{},
            "The holder has lost its connection, and may come back.");
    v.fixed("asking", &ControlState::asking, List{Object{}, 0, kMaxInteger},
            "Who asks for control, the first one first.");
}

inline void describe(Fields<ClientState>& v) {
    v.fixed("name", &ClientState::name, kName, "As in `hello`, with its number.");
    v.fixed("role", &ClientState::role, kRole, "The role given.");
}

inline void describe(Fields<RecordingState>& v) {
    v.fixed("name", &RecordingState::name, kName, "Of the event log.");
}

inline void describe(Fields<State>& v) {
    v.fixed("scene", &State::scene, Object{}, "The scene as in the file.");
    v.writable("camera", &State::camera, kCamera, "The one camera of all.", for_hosts);
    v.fixed("walls", &State::walls, Object{}, "The camera that hosts have, while it is behind that of all.");
    v.fixed("cameras", &State::cameras, Table{Object{}}, "Camera nodes, by id.");
    v.writable("navigation", &State::navigation, Section{}, "What input does.", survives_open);
    v.writable("renderer", &State::renderer, Section{}, "How the scene is drawn.");
    v.writable("lights", &State::lights, Section{}, "The lights, of which one shines.");
    v.fixed("materials", &State::materials, Table{Object{}}, "Materials, by id.");
    v.writable("backgrounds", &State::backgrounds, Section{}, "The backgrounds, of which one is shown.");
    v.writable("selection", &State::selection, Section{}, "What is selected.", for_hosts);
    v.writable("nodes", &State::nodes, Entries{kMaxNodes}, "By id: only what differs from the file.",
               kept | for_hosts | in_cues);
    v.fixed("swings", &State::swings, Table{Object{}},
            "Nodes that are on their way about their hinges, by id.");
    v.writable("markers", &State::markers, Entries{kMaxEntries, "point"},
               "Notes on points of the scene, by name.", kept);
    v.writable("views", &State::views, Entries{kMaxEntries}, "Saved cameras, by name.", kept);
    v.writable("sections", &State::sections, Entries{kMaxSections, "normal"},
               "Planes that cut the scene open, by name.", in_cues);
    v.writable("sectionBox", &State::section_box, Section{}, "A box that cuts the scene open.", in_cues);
    v.writable("measures", &State::measures, Entries{kMaxEntries, "picks"},
               "Distances, angles and the like, by name.", kept);
    v.fixed("measured", &State::measured, Table{Object{}},
            "What `measures` come to as the parts stand now, by name.");
    v.writable("unit", &State::unit, Section{}, "Of lengths.", kept);
    v.writable("cues", &State::cues, Entries{kMaxCues}, "What a presentation shows, by name.", kept);
    v.fixed("cue", &State::cue, Object{}, "The cue that was shown last.");
    v.writable("quality", &State::quality, Section{}, "How frames are drawn while things move.",
               survives_open);
    v.writable("pointing", &State::pointing, Section{}, "Who may point.", survives_open);
    v.writable("comfort", &State::comfort, Section{}, "How fast the camera of hosts moves.", survives_open);
    v.fixed("control", &State::control, Object{}, "Who holds control, and who asks.", survives_open);
    v.fixed("clients", &State::clients, Table{Object{}}, "Who is connected, by the client's id.",
            survives_open);
    v.fixed("recording", &State::recording, Object{}, "The event log that is written now.", survives_open);
    v.fixed("notices", &State::notices, List{kNotice, 0, kMaxNotices},
            "What has gone wrong in the server, the newest last.", survives_open);
}

}  // namespace vrut::protocol
