#include <cctype>

#include "codec.hpp"
#include "event_log_descriptions.hpp"
#include "message_table.hpp"

namespace vrut::protocol {

namespace {

std::string capitalized(std::string name) {
    name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    return name;
}

Json reference(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }

Json with_type(Json schema, const char* type) {
    schema["properties"]["type"] = {{"const", type}};
    schema["required"].push_back("type");
    return schema;
}

/// Adds `schema` under `name` and to the alternatives of `group`.
void add(Json& defs, const char* group, const std::string& name, Json schema) {
    defs[name] = std::move(schema);
    defs[group]["oneOf"].push_back(reference(name));
}

void add_client_messages(Json& defs) {
    for_each_client_type([&](const MessageTraits& traits, const auto& prototype) {
        Json schema = with_type(schema_of_struct<std::decay_t<decltype(prototype)>>(), traits.type);
        Json& id = schema["properties"]["id"] = Integer{1, kMaxInteger}.schema();
        id["description"] = "Asks for exactly one answer, which has the same `id`. It rises.";
        add(defs, "clientMessage", "client" + capitalized(traits.type), std::move(schema));
    });
    defs["clientRecord"]["properties"]["name"]["pattern"] = "^[A-Za-z0-9_-]*$";
    defs["clientPoint"]["dependentRequired"] = {{"x", {"y"}}, {"y", {"x"}}, {"frame", {"x", "y"}}};
}

template <class Message>
void add_server_message(Json& defs, const char* type) {
    Json schema = with_type(schema_of_struct<Message>(), type);
    add(defs, "serverMessage", "server" + capitalized(type), std::move(schema));
}

void add_server_messages(Json& defs) {
    add_server_message<Welcome>(defs, "welcome");
    add_server_message<Ok>(defs, "ok");
    add_server_message<Picked>(defs, "picked");
    add_server_message<Pointed>(defs, "pointed");
    add_server_message<Flown>(defs, "flown");
    add_server_message<TreePage>(defs, "tree");
    add_server_message<Checked>(defs, "checked");
    add_server_message<SceneList>(defs, "scenes");
    add_server_message<SharedAddress>(defs, "shared");
    add_server_message<Loading>(defs, "loading");
    add_server_message<Stats>(defs, "stats");
    add_server_message<Error>(defs, "error");
    const auto described = [](Json schema, const char* meaning) {
        schema["description"] = meaning;
        return schema;
    };
    const Json revision = described(Integer{1, kMaxInteger}.schema(), "Of the state, once this is in it.");
    add(defs, "serverMessage", "serverState",
        with_type({{"type", "object"},
                   {"properties",
                    {{"revision", revision},
                     {"state", described(reference("stateDocument"), "The whole document.")}}},
                   {"required", {"revision", "state"}}},
                  "state"));
    add(defs, "serverMessage", "serverPatch",
        with_type(
            {{"type", "object"},
             {"properties",
              {{"revision", revision},
               {"patch", described({{"type", "object"}},
                                   "From the document that this client got last to the present one.")},
               {"by",
                described(kName.schema(),
                          "The client whose doing it is; missing: the server's, or several clients'.")}}},
             {"required", {"revision", "patch"}}},
            "patch"));
}

/// Lines of an event log: the first, and all others.
void add_event_log(Json& defs) {
    Json& header = defs["eventLogHeader"] = schema_of_struct<LogHeader>();
    header["properties"]["log"] = {{"const", kLog}, {"description", "Tells that the file is an event log."}};
    header["properties"]["version"] = {{"const", kVersion}, {"description", "Of the protocol."}};
    header["required"].insert(header["required"].begin(), {"log", "version"});
    const auto line = [](Json schema, const char* client) {
        Json& at = schema["properties"]["at"] = kLogTime.schema();
        at["description"] = "Milliseconds since the log began, in whole microseconds.";
        schema["required"].push_back("at");
        if (!client) return schema;
        schema["properties"]["client"] = kClientId.schema();
        schema["properties"]["client"]["description"] = client;
        return schema;
    };
    Json message = {{"description", "As it came."}, {"$ref", "#/$defs/clientMessage"}};
    add(defs, "eventLogLine", "eventLogMessage",
        line({{"type", "object"},
              {"properties", {{"message", std::move(message)}}},
              {"required", {"client", "message"}}},
             "Who sent it."));
    for_each_event([&](const char* name, const char* client, const auto& prototype) {
        Json schema = line(schema_of_struct<std::decay_t<decltype(prototype)>>(), client);
        schema["properties"]["event"] = {{"const", name}};
        schema["required"].push_back("event");
        add(defs, "eventLogLine", "eventLog" + capitalized(name), std::move(schema));
    });
    for (const char* of_a_client : {"eventLogConnected", "eventLogDisconnected"})
        defs[of_a_client]["required"].push_back("client");
}

}  // namespace

std::string json_schema() {
    Json defs = Json::object();
    add_client_messages(defs);
    add_server_messages(defs);
    add_event_log(defs);
    defs["cameraOverlay"] = schema_of_struct<CameraOverlay>();
    defs["camera"] = schema_of_struct<CameraState>();
    defs["notice"] = schema_of_struct<Notice>();
    defs["feature"] = schema_of_struct<Feature>();
    defs["quality"] = schema_of_struct<Quality>();
    defs["view"] = schema_of_struct<Resize>();
    defs["cueList"] = schema_of_struct<CueList>();
    defs["cues"] = SharedTable<Entries<CueState>>{}.patch_schema();
    defs["levelTable"] = schema_of_struct<LevelTable>();
    defs["renderJob"] = schema_of_struct<RenderJob>();
    defs["frameHeader"] = schema_of_struct<FrameHeader>();
    defs["stateDocument"] = schema_of_struct<State>();
    defs["statePatch"] = patch_schema_of_struct<State>();
    const Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                         {"$id", "urn:vrut-preview:protocol:1"},
                         {"title", "VRUT Preview, wire protocol, version 1"},
                         {"anyOf", {reference("clientMessage"), reference("serverMessage")}},
                         {"$defs", std::move(defs)}};
    return schema.dump(1) + "\n";
}

}  // namespace vrut::protocol
