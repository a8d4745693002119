#pragma once

#include "descriptions.hpp"
#include "event_log.hpp"

/// The members of an event log's lines. For protocol's own .cpp files.
namespace vrut::protocol {

inline constexpr const char* kLog = "vrut-preview";
inline constexpr Number kLogTime{-1e12, 1e12};
inline constexpr Text kClientId{100};
inline constexpr Defined<Object<Resize>> kView{{}, "view"};

template <class V>
void describe(V& v, const LoggedFrame*) {
    v.required("frame", &LoggedFrame::frame, kId, "Number of the frame.");
    v.required("camera", &LoggedFrame::camera, kCamera, "The camera through which it was drawn.");
    v.required("view", &LoggedFrame::view, kView, "The size of the view that it shows.");
}

template <class V>
void describe(V& v, const LogHeader::Client*) {
    v.required("client", &LogHeader::Client::client, kClientId, "The client's id.");
    v.required("role", &LogHeader::Client::role, kRole, "The role given.");
    v.optional("name", &LogHeader::Client::name, kClientName, "As in its `hello`.");
    v.optional("resume", &LogHeader::Client::resume, Text{1000},
               "As in its `hello`; only in a shared room's log.");
    v.optional("sequence", &LogHeader::Client::sequence, Integer{},
               "Of its last message; only in a shared room's log.");
}

/// The size that it asked for stands in the same object, where it asked for one.
struct LoggedClient : Object<LogHeader::Client> {
    LogHeader::Client read(const Json& json, const std::string& path) const {
        LogHeader::Client client = Object::read(json, path);
        if (json.contains("width")) client.wanted = read_struct<Resize>(json, path);
        return client;
    }
    Json write(const LogHeader::Client& client) const {
        Json json = Object::write(client);
        if (client.wanted) json.update(write_struct(*client.wanted));
        return json;
    }
    Json schema() const {
        Json schema = Object::schema();
        schema["properties"].update(schema_of_struct<Resize>()["properties"]);
        return schema;
    }
};

template <class V>
void describe(V& v, const LogHeader::Flight*) {
    v.required("client", &LogHeader::Flight::client, kName, "Who sent the `fly`.");
    v.required("id", &LogHeader::Flight::id, kId, "Of the `fly`; 0: none.");
    v.required("since", &LogHeader::Flight::since, kDuration, "Milliseconds that it had lasted.");
    v.required("from", &LogHeader::Flight::from, kCamera, "Where it began.");
    v.required("fly", &LogHeader::Flight::fly, Object<Fly>{}, "Its `keyframes` and `easing`.");
}

template <class V>
void describe(V& v, const LogHeader::Walls*) {
    v.required("camera", &LogHeader::Walls::camera, Object<ViewState>{}, "Where it was.");
    v.required("guide", &LogHeader::Walls::guide, Object<ViewState>{},
               "What it followed, on the way to the room's camera at the speeds allowed.");
    v.required("velocity", &LogHeader::Walls::velocity, kPosition, "Of the eye, in scene units a second.");
    v.required("spin", &LogHeader::Walls::spin, kPosition,
               "Of the view, about an axis of the world, in radians a second.");
    v.required("due", &LogHeader::Walls::due, Number{0, 16}, "Milliseconds until its next step.");
}

template <class V>
void describe(V& v, const LogHeader*) {
    v.required("scene", &LogHeader::scene, kName, "Name of the scene that is shown.");
    v.required("sceneSha256", &LogHeader::scene_sha256, kName, "SHA-256 of the scene's file.");
    v.optional("upAxis", &LogHeader::up_axis, kUpAxis,
               "The up axis in use; only for formats that do not define it.");
    v.required("started", &LogHeader::started, kName, "When the log began, by ISO 8601.");
    v.required("state", &LogHeader::state, AnyObject{{{"$ref", "#/$defs/stateDocument"}}},
               "The state document.");
    v.required("clients", &LogHeader::clients, List<LoggedClient>{{}, 0, 100'000},
               "Who was connected; a size only where the client had asked for one.");
    v.required("view", &LogHeader::view, kView, "The size in force.");
    v.optional("atHome", &LogHeader::at_home, Flag{}, "Nobody had moved the camera yet.");
    v.optional("home", &LogHeader::home, Object<ViewState>{},
               "The view \"home\" as it was at loading, which depends on the view's size then.");
    v.optional("frames", &LogHeader::frames, List<Object<LoggedFrame>>{{}, 0, 1000},
               "Frames that clients may still name.");
    v.optional("flight", &LogHeader::flight, Object<LogHeader::Flight>{}, "The flight that was going on.");
    v.optional("walls", &LogHeader::walls, Object<LogHeader::Walls>{},
               "The camera of hosts, where that was on its way.");
    v.optional("revision", &LogHeader::revision, Integer{}, "Of the state; only in a shared room's log.");
}

/// The text of an object.
struct ObjectText {
    std::string read(const Json& json, const std::string& path) const {
        return dump(read_object(json, path));
    }
    Json write(const std::string& text) const { return text.empty() ? Json::object() : Json::parse(text); }
    Json schema() const { return {{"$ref", "#/$defs/statePatch"}}; }
};

template <class V>
void describe(V& v, const LogLine::Connected*) {
    v.required("role", &LogLine::Connected::role, kRole, "The role given.");
    v.optional("name", &LogLine::Connected::name, kClientName, "As in its `hello`.");
    v.optional("resume", &LogLine::Connected::resume, Text{1000},
               "As in its `hello`; only in a shared room's log.");
}
template <class V>
void describe(V&, const LogLine::Disconnected*) {}
template <class V>
void describe(V&, const LogLine::ControlPassed*) {}
template <class V>
void describe(V& v, const LogLine::Opened*) {
    v.required("scene", &LogLine::Opened::scene, Text{kMaxSceneName}, "Name of the scene.");
    v.required("sceneSha256", &LogLine::Opened::sha256, Text{100}, "SHA-256 of the scene's file.");
    v.optional("upAxis", &LogLine::Opened::up_axis, kUpAxis,
               "The up axis in use; only for formats that do not define it.");
    v.optional("changes", &LogLine::Opened::changes, ObjectText{},
               "What was kept of the scene: a patch with `views`, `markers` and `nodes`.");
}
template <class V>
void describe(V& v, const LogLine::Drawn*) {
    v.required("frame", &LogLine::Drawn::frame, Integer{1, kMaxInteger}, "Number of the frame.");
}

template <class V>
void describe(V& v, const LogLine::Revised*) {
    v.required("revision", &LogLine::Revised::revision, Integer{1, kMaxInteger}, "Of the state.");
    v.optional("notices", &LogLine::Revised::notices, List<Defined<Object<Notice>>>{kNotice, 0, kMaxNotices},
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
