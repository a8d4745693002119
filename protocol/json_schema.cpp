#include <cctype>

#include "codec.hpp"
#include "descriptions.hpp"
#include "event_log.hpp"
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
        schema["properties"]["id"] = Integer{1, kMaxInteger}.schema();
        add(defs, "clientMessage", "client" + capitalized(traits.type), std::move(schema));
    });
    defs["clientRecord"]["properties"]["name"]["pattern"] = "^[A-Za-z0-9_-]*$";
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
    add_server_message<Flown>(defs, "flown");
    add_server_message<TreePage>(defs, "tree");
    add_server_message<SceneList>(defs, "scenes");
    add_server_message<SharedAddress>(defs, "shared");
    add_server_message<Loading>(defs, "loading");
    add_server_message<Stats>(defs, "stats");
    add_server_message<Error>(defs, "error");
    defs["serverError"]["properties"]["code"] = {{"enum", error_code::all}};
    const Json revision = Integer{1, kMaxInteger}.schema();
    add(defs, "serverMessage", "serverState",
        with_type({{"type", "object"},
                   {"properties", {{"revision", revision}, {"state", reference("stateDocument")}}},
                   {"required", {"revision", "state"}}},
                  "state"));
    add(defs, "serverMessage", "serverPatch",
        with_type({{"type", "object"},
                   {"properties",
                    {{"revision", revision}, {"patch", {{"type", "object"}}}, {"by", {{"type", "string"}}}}},
                   {"required", {"revision", "patch"}}},
                  "patch"));
}

}  // namespace

std::string json_schema() {
    Json defs = Json::object();
    add_client_messages(defs);
    add_server_messages(defs);
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
