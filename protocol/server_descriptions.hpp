#pragma once

#include "server_messages.hpp"
#include "shared_descriptions.hpp"

/// The members of what the server answers. For protocol's own .cpp files.
namespace vrut::protocol {

inline void describe(Fields<Limits>& v) {
    v.required("maxMessage", &Limits::max_message, kId, "Bytes of a client's message.");
    v.required("maxDepth", &Limits::max_depth, kId, "Levels of nesting in a client's message.");
    v.required("maxGrants", &Limits::max_grants, kId, "Grants that the server keeps of a client.");
    v.required("maxPixels", &Limits::max_pixels, kId, "Pixels of an image; a larger view is drawn smaller.");
    v.required("messagesPerSecond", &Limits::messages_per_second, kId,
               "What a client sends faster is read more slowly.");
    v.required("maxServerMessage", &Limits::max_server_message, kId, "Bytes of a server's message.");
}

inline void describe(Fields<InputRules>& v) {
    v.required("wheelSteps", &InputRules::wheel_steps, Vector{kDuration.min, kDuration.max},
               "[pixels, lines, pages] that make one step of the wheel.");
    v.required("wheelZoom", &InputRules::wheel_zoom, kDuration,
               "A step away from the user divides the distance by it.");
    v.required("dragZoom", &InputRules::drag_zoom, kDuration,
               "A zooming drag upwards over the view's height divides the distance by it.");
    v.required("drags", &InputRules::drags, Table<Table<Text>>{{kName}},
               "By style, by `buttons`: `rotate`, `pan`, `zoom`. Styles that use keys are left out.");
    v.required("keys", &InputRules::keys, List{kName, 0, kMaxInteger},
               "The `key` of each key that has a meaning.");
    v.required("repeatingKeys", &InputRules::repeating_keys, List{kName, 0, kMaxInteger},
               "Of `keys`, those that go on while they are held.");
}

inline void describe(Fields<Welcome>& v) {
    v.required("id", &Welcome::id, kId, "Of the `hello`, where it had one.");
    v.required("version", &Welcome::version, Integer{kVersion, kVersion}, "Of this protocol.");
    v.required("server", &Welcome::server, kName, "Version of the program.");
    v.required("client", &Welcome::client, kName, "This client's id.");
    v.required("role", &Welcome::role, kRole, "The role given.");
    v.required("limits", &Welcome::limits, Object{}, "What holds for messages and images.");
    v.required("input", &Welcome::input, Object{},
               "What a client needs to foretell what input does, or to pass on what has a meaning only.");
}

inline void describe(Fields<Ok>& v) {
    v.required("id", &Ok::id, kId, "Of the message.");
    v.required("revision", &Ok::revision, kId, "Of the state that the message led to.");
    v.required("name", &Ok::name, kName, "Of the event log.");
}

inline void describe(Fields<Snapped>& v) {
    v.required("feature", &Snapped::feature, kFeature, "To be one of the `picks` of a measure.");
    v.required("point", &Snapped::point, Vector{kAny.min, kAny.max}, "Its first point, in the world.");
    v.required("line", &Snapped::line, kLine, "Of an edge, a circle or a loop, in the world; else empty.");
}

inline void describe(Fields<Picked>& v) {
    v.required("id", &Picked::id, kId, "Of the `pick`.");
    v.required("node", &Picked::node, kId, "The node that was hit.");
    v.required("name", &Picked::name, kName, "Of the node.");
    v.required("path", &Picked::path, List{kName, 0, 32},
               "Names from the root to the node that was hit, the last 32.");
    v.required("point", &Picked::point, Vector{kAny.min, kAny.max}, "In the world.");
    v.required("normal", &Picked::normal, Vector{-1.001, 1.001}, "Of the face, unit, towards the viewer.");
    v.required("distance", &Picked::distance, kDuration, "From the eye.");
    v.required(
        "local", &Picked::local, Vector{kAny.min, kAny.max},
        "The point in the node's own space, for a marker that moves with it; none of a flattened node.");
    v.required("snapped", &Picked::snapped, Object{}, "What `snap` has found, if anything.");
}

inline void describe(Fields<Pointed>& v) {
    v.required("client", &Pointed::client, kName, "Who points.");
    v.required("name", &Pointed::name, kName, "As others see that client, where it has a name.");
    v.required("point", &Pointed::point, Vector{kAny.min, kAny.max},
               "In the world; missing: that client points at nothing any more.");
    v.required("normal", &Pointed::normal, Vector{-1.001, 1.001},
               "Of the face, unit, towards who points; with `point`.");
}

inline void describe(Fields<Flown>& v) {
    v.required("id", &Flown::id, kId, "Of the `fly`.");
    v.required("completed", &Flown::completed, Flag{}, "False where the flight was stopped.");
}

inline void describe(Fields<TreeHinge>& v) {
    v.required("axis", &TreeHinge::axis, Vector{-1.001, 1.001},
               "Unit, in the node's own space, through its origin.");
    v.required("degrees", &TreeHinge::degrees, Number{-360, 360},
               "How far it opens; the sign tells which way.");
    v.required("closed", &TreeHinge::closed, kMatrix, "The node's matrix as in the file.");
}

inline void describe(Fields<TreeNode>& v) {
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
    v.required("hinge", &TreeNode::hinge, Object{}, "What a door turns about.");
    v.required("activeChild", &TreeNode::active_child, kActiveChild,
               "Of a switch, as in the file: counted from 0, −1 none, −2 all.");
    v.required("choices", &TreeNode::choices, List{kName, 0, kMaxChoices},
               "The children's names, of a switch with at most 64 of them and 16 KiB of names.");
}

inline void describe(Fields<TreePage>& v) {
    v.required("id", &TreePage::id, kId, "Of the `tree`.");
    v.required("nodes", &TreePage::nodes, List{Object{}, 0, kMaxInteger},
               "Depth first, children by rising id.");
    v.required("next", &TreePage::next, kId, "There is more: send it as `after`.");
}

inline void describe(Fields<Checked::Problem>& v) {
    v.optional("cue", &Checked::Problem::cue, kName, "The cue; missing: it is the whole list.");
    v.required("message", &Checked::Problem::message, kName, "What is wrong, a sentence.");
}

inline void describe(Fields<Checked>& v) {
    v.required("id", &Checked::id, kId, "Of the `check`.");
    v.required("problems", &Checked::problems, List{Object{}, 0, kMaxCueProblems},
               "What does not go with the scene; empty: all of it does.");
    v.required("fitting", &Checked::fitting, List{Text{100}, 0, kMaxCues}, "Names of the cues that do.");
}

inline void describe(Fields<SceneList>& v) {
    v.required("id", &SceneList::id, kId, "Of the `scenes`.");
    v.required("scenes", &SceneList::scenes, List{Text{kMaxSceneName}, 0, kMaxScenes},
               "Names for `open`, sorted by their bytes.");
}

inline void describe(Fields<SharedAddress>& v) {
    v.required("id", &SharedAddress::id, kId, "Of the `share`.");
    v.required("address", &SharedAddress::address, kName,
               "Of the page, to watch only, with the view token where there is one.");
    v.required("qr", &SharedAddress::qr, List{Text{kMaxQrSize}, 0, kMaxQrSize},
               "The address as a QR code: rows of 0, light, and 1, dark, without the quiet zone.");
    v.required("loopback", &SharedAddress::loopback, Flag{},
               "True where no other machine reaches the address.");
}

inline void describe(Fields<Loading>& v) {
    v.required("scene", &Loading::scene, kName, "Name of the scene that is loaded.");
    v.required("fraction", &Loading::fraction, Number{0, 1}, "How much of it is loaded.");
    v.required("done", &Loading::done, Flag{}, "Once, at the end: the scene is ready.");
    v.required("refused", &Loading::refused, kName,
               "Once, at the end: a sentence that tells why the scene is not shown.");
}

inline void describe(Fields<Error>& v) {
    v.required("id", &Error::id, kId, "Of the message, where it could be read.");
    v.required("code", &Error::code, Text{kName.max, error_code::all}, "For programs.");
    v.required("message", &Error::message, Text{300}, "One sentence for a person, which names the culprit.");
}

inline void describe(Fields<Stats::Renderer>& v) {
    v.required("meanRenderMs", &Stats::Renderer::mean_render_ms, kDuration, "Mean of the last 100 frames.");
    v.required("medianRenderMs", &Stats::Renderer::median_render_ms, kDuration,
               "Median of the last 100 frames.");
    v.required("p95RenderMs", &Stats::Renderer::p95_render_ms, kDuration,
               "95 of 100 took no longer, of the last 100 frames.");
}

inline void describe(Fields<Stats::Host>& v) {
    v.required("name", &Stats::Host::name, kName, "As in its `hello`.");
    v.required("revision", &Stats::Host::revision, kId, "What its walls show.");
    v.required("lagMs", &Stats::Host::lag_ms, kDuration,
               "From that revision's making to the host's report, by the server's clock.");
}

inline void describe(Fields<Stats>& v) {
    v.required("renderer", &Stats::renderer, Object{}, "Times of drawing; none before the first frame.");
    v.required("quality", &Stats::quality, kQuality, "Of the newest frame; none before the first.");
    v.required("hosts", &Stats::hosts, Table{Object{}}, "By the client's id.");
    v.required("clients", &Stats::clients, kId, "Clients that are connected.");
    v.required("watchers", &Stats::watchers, kId, "Clients of the role `view`.");
    v.required("framesPerSecond", &Stats::frames_per_second, kDuration, "Sent to all clients.");
    v.required("bytesPerSecond", &Stats::bytes_per_second, kDuration, "Sent to all clients.");
}

}  // namespace vrut::protocol
