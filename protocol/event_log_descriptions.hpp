#pragma once

#include "client_descriptions.hpp"
#include "event_log.hpp"
#include "state_descriptions.hpp"

/// The members of an event log's lines. For protocol's own .cpp files.
namespace vrut::protocol {

inline constexpr const char* kLog = "vrut-preview";
inline constexpr Number kLogTime{-1e12, 1e12};
inline constexpr Text kClientId{100};
inline constexpr Object kView{"view"};

inline void describe(Fields<LoggedFrame>& v) {
    v.required("frame", &LoggedFrame::frame, kId, "Number of the frame.");
    v.required("camera", &LoggedFrame::camera, kCamera, "The camera through which it was drawn.");
    v.required("view", &LoggedFrame::view, kView, "The size of the view that it shows.");
}

inline void describe(Fields<LogHeader::Client>& v) {
    v.required("client", &LogHeader::Client::client, kClientId, "The client's id.");
    v.required("role", &LogHeader::Client::role, kRole, "The role given.");
    v.optional("name", &LogHeader::Client::name, kClientName, "As in its `hello`.");
    v.optional("resume", &LogHeader::Client::resume, Text{1000},
               "As in its `hello`; only in a shared room's log.");
    v.optional("sequence", &LogHeader::Client::sequence, Integer{},
               "Of its last message; only in a shared room's log.");
}

/// The size that it asked for stands in the same object, where it asked for one.
struct LoggedClient {};
KindPtr bind(const LoggedClient& client, Of<LogHeader::Client>);

inline void describe(Fields<LogHeader::Flight>& v) {
    v.required("client", &LogHeader::Flight::client, kName, "Who sent the `fly`.");
    v.required("id", &LogHeader::Flight::id, kId, "Of the `fly`; 0: none.");
    v.required("since", &LogHeader::Flight::since, kDuration, "Milliseconds that it had lasted.");
    v.required("from", &LogHeader::Flight::from, kCamera, "Where it began.");
    v.required("fly", &LogHeader::Flight::fly, Object{}, "Its `keyframes` and `easing`.");
}

inline void describe(Fields<LogHeader::Walls>& v) {
    v.required("camera", &LogHeader::Walls::camera, Object{}, "Where it was.");
    v.required("guide", &LogHeader::Walls::guide, Object{},
               "What it followed, on the way to the room's camera at the speeds allowed.");
    v.required("velocity", &LogHeader::Walls::velocity, kPosition, "Of the eye, in scene units a second.");
    v.required("spin", &LogHeader::Walls::spin, kPosition,
               "Of the view, about an axis of the world, in radians a second.");
    v.required("due", &LogHeader::Walls::due, Number{0, 16}, "Milliseconds until its next step.");
}

inline void describe(Fields<LogHeader>& v) {
    v.required("scene", &LogHeader::scene, kName, "Name of the scene that is shown.");
    v.required("sceneSha256", &LogHeader::scene_sha256, kName, "SHA-256 of the scene's file.");
    v.optional("upAxis", &LogHeader::up_axis, kUpAxis,
               "The up axis in use; only for formats that do not define it.");
    v.required("started", &LogHeader::started, kName, "When the log began, by ISO 8601.");
    v.required("state", &LogHeader::state, AnyObject{"stateDocument"}, "The state document.");
    v.required("clients", &LogHeader::clients, List{LoggedClient{}, 0, 100'000},
               "Who was connected; a size only where the client had asked for one.");
    v.required("view", &LogHeader::view, kView, "The size in force.");
    v.optional("atHome", &LogHeader::at_home, Flag{}, "Nobody had moved the camera yet.");
    v.optional("home", &LogHeader::home, Object{},
               "The view \"home\" as it was at loading, which depends on the view's size then.");
    v.optional("frames", &LogHeader::frames, List{Object{}, 0, 1000}, "Frames that clients may still name.");
    v.optional("flight", &LogHeader::flight, Object{}, "The flight that was going on.");
    v.optional("walls", &LogHeader::walls, Object{}, "The camera of hosts, where that was on its way.");
    v.optional("revision", &LogHeader::revision, Integer{}, "Of the state; only in a shared room's log.");
}

/// The text of an object.
struct ObjectText {};
KindPtr bind(const ObjectText& text, Of<std::string>);

inline void describe(Fields<LogLine::Connected>& v) {
    v.required("role", &LogLine::Connected::role, kRole, "The role given.");
    v.optional("name", &LogLine::Connected::name, kClientName, "As in its `hello`.");
    v.optional("resume", &LogLine::Connected::resume, Text{1000},
               "As in its `hello`; only in a shared room's log.");
}
inline void describe(Fields<LogLine::Disconnected>&) {}
inline void describe(Fields<LogLine::ControlPassed>&) {}
inline void describe(Fields<LogLine::Opened>& v) {
    v.required("scene", &LogLine::Opened::scene, Text{kMaxSceneName}, "Name of the scene.");
    v.required("sceneSha256", &LogLine::Opened::sha256, Text{100}, "SHA-256 of the scene's file.");
    v.optional("upAxis", &LogLine::Opened::up_axis, kUpAxis,
               "The up axis in use; only for formats that do not define it.");
    v.optional("changes", &LogLine::Opened::changes, ObjectText{},
               "What was kept of the scene: a patch with `views`, `markers` and `nodes`.");
}
inline void describe(Fields<LogLine::Drawn>& v) {
    v.required("frame", &LogLine::Drawn::frame, Integer{1, kMaxInteger}, "Number of the frame.");
}

inline void describe(Fields<LogLine::Revised>& v) {
    v.required("revision", &LogLine::Revised::revision, Integer{1, kMaxInteger}, "Of the state.");
    v.optional("notices", &LogLine::Revised::notices, List{kNotice, 0, kMaxNotices},
               "The server's; missing: unchanged.");
    v.optional("recording", &LogLine::Revised::recording, Text{1000},
               "The event log that is being recorded, empty: none; missing: unchanged.");
}

/// Calls `use(event, client, prototype)` for each line that is no message: the word in `event`, what its
/// `client` means (null: it is nobody's doing), and a value of its type.
template <class Use>
void for_each_event(Use use) {
    use("connected", "Who came.", LogLine::Connected{});
    use("disconnected", "Who left.", LogLine::Disconnected{});
    use("control", "Who holds control from here on; missing: nobody.", LogLine::ControlPassed{});
    use("opened", nullptr, LogLine::Opened{});
    use("drawn", nullptr, LogLine::Drawn{});
    use("revised", nullptr, LogLine::Revised{});
}

}  // namespace vrut::protocol
