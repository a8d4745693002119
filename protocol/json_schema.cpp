#include <algorithm>
#include <cctype>

#include "client_codec.hpp"
#include "codec.hpp"
#include "event_log_descriptions.hpp"
#include "file_descriptions.hpp"
#include "message_table.hpp"
#include "server_descriptions.hpp"

namespace vrut::protocol {

namespace {

std::string capitalized(std::string name) {
    name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    return name;
}

Json reference(const std::string& name) {
    Json schema;
    schema["$ref"] = "#/$defs/" + name;
    return schema;
}

Json with_type(Json schema, const char* type) {
    schema["properties"]["type"]["const"] = type;
    schema["required"].push_back("type");
    return schema;
}

/// Adds `schema` under `name` and to the alternatives of `group`.
void add(Json& defs, const char* group, const std::string& name, Json schema) {
    defs[name] = std::move(schema);
    defs[group]["oneOf"].push_back(reference(name));
}

void add_client_messages(Json& defs) {
    for (const auto& [traits, prototype] : client_message_types()) {
        Json schema = with_type(schema_of(table_of_message(prototype)), traits.type);
        Json& id = schema["properties"]["id"] = schema_of(Integer{1, kMaxInteger});
        id["description"] = "Asks for exactly one answer, which has the same `id`. It rises.";
        add(defs, "clientMessage", "client" + capitalized(traits.type), std::move(schema));
    }
    defs["clientRecord"]["properties"]["name"]["pattern"] = "^[A-Za-z0-9_-]*$";
    defs["clientPoint"]["dependentRequired"] =
        Json::parse(R"({"x": ["y"], "y": ["x"], "frame": ["x", "y"]})");
}

/// An object with these properties. All of them are required, except those in `may_be_missing`.
Json object_with(std::initializer_list<std::pair<const char*, Json>> properties,
                 std::initializer_list<std::string_view> may_be_missing = {}) {
    Json schema = Json::parse(R"({"type": "object", "properties": {}, "required": []})");
    for (const auto& [name, property] : properties) {
        schema["properties"][name] = property;
        if (std::ranges::find(may_be_missing, name) == may_be_missing.end())
            schema["required"].push_back(name);
    }
    return schema;
}

Json described(Json schema, const char* meaning) {
    schema["description"] = meaning;
    return schema;
}

void add_server_messages(Json& defs) {
    for (const auto& [name, table] : server_message_types())
        add(defs, "serverMessage", "server" + capitalized(name), with_type(schema_of(table), name));
    const Json revision = described(schema_of(Integer{1, kMaxInteger}), "Of the state, once this is in it.");
    const Json state = described(reference("stateDocument"), "The whole document.");
    add(defs, "serverMessage", "serverState",
        with_type(object_with({{"revision", revision}, {"state", state}}), "state"));
    const Json patch = described(Json::parse(R"({"type": "object"})"),
                                 "From the document that this client got last to the present one.");
    const Json by = described(schema_of(kName),
                              "The client whose doing it is; missing: the server's, or several clients'.");
    add(defs, "serverMessage", "serverPatch",
        with_type(object_with({{"revision", revision}, {"patch", patch}, {"by", by}}, {"by"}), "patch"));
}

/// A line of an event log. `client` tells what its member of this name means; null: it has none.
Json event_log_line(Json schema, const char* client) {
    schema["properties"]["at"] =
        described(schema_of(kLogTime), "Milliseconds since the log began, in whole microseconds.");
    schema["required"].push_back("at");
    if (client) schema["properties"]["client"] = described(schema_of(kClientId), client);
    return schema;
}

/// Lines of an event log: the first, and all others.
void add_event_log(Json& defs) {
    Json& header = defs["eventLogHeader"] = schema_of(table_of<LogHeader>());
    header["properties"].update(Json::parse(R"({
        "log": {"description": "Tells that the file is an event log."},
        "version": {"description": "Of the protocol."}})"));
    header["properties"]["log"]["const"] = kLog;
    header["properties"]["version"]["const"] = kVersion;
    header["required"].insert(header["required"].begin(), {"log", "version"});
    Json message = event_log_line(Json::parse(R"({"type": "object", "required": ["client", "message"]})"),
                                  "Who sent it.");
    message["properties"]["message"] = described(reference("clientMessage"), "As it came.");
    add(defs, "eventLogLine", "eventLogMessage", std::move(message));
    for_each_event([&](const char* name, const char* client, const auto& prototype) {
        Json line = event_log_line(schema_of(table_of_value(prototype)), client);
        line["properties"]["event"]["const"] = name;
        line["required"].push_back("event");
        add(defs, "eventLogLine", "eventLog" + capitalized(name), std::move(line));
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
    const std::pair<const char*, const FieldTable&> structs[] = {{"cameraOverlay", table_of<CameraOverlay>()},
                                                                 {"camera", table_of<CameraState>()},
                                                                 {"notice", table_of<Notice>()},
                                                                 {"feature", table_of<Feature>()},
                                                                 {"quality", table_of<Quality>()},
                                                                 {"view", table_of<Resize>()},
                                                                 {"cueList", table_of<CueList>()},
                                                                 {"levelTable", table_of<LevelTable>()},
                                                                 {"renderJob", table_of<RenderJob>()},
                                                                 {"frameHeader", table_of<FrameHeader>()},
                                                                 {"stateDocument", table_of<State>()}};
    for (const auto& [name, table] : structs) defs[name] = schema_of(table);
    defs["cues"] = bind(Entries{}, Of<SharedMap<CueState>>{})->patch_schema();
    defs["statePatch"] = patch_schema_of(table_of<State>());
    Json schema = Json::parse(R"({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": "urn:vrut-preview:protocol:1",
        "title": "VRUT Preview, wire protocol, version 1",
        "anyOf": [{"$ref": "#/$defs/clientMessage"}, {"$ref": "#/$defs/serverMessage"}]})");
    schema["$defs"] = std::move(defs);
    return schema.dump(1) + "\n";
}

}  // namespace vrut::protocol
