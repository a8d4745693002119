#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "codec.hpp"
#include "event_log.hpp"
#include "examples.hpp"
#include "frame_header.hpp"

using namespace vrut::protocol;
using nlohmann::json;

namespace {

const std::string kProtocol = VRUT_TEST_DATA "/../../../protocol/";

std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// A committed file that follows from the sources is renewed by whoever asks for it.
void check_file(const std::string& path, const std::string& text) {
    if (std::getenv("VRUT_RENEW")) std::ofstream(path, std::ios::binary) << text;
    const bool same = text_of(path) == text;
    CHECK_MESSAGE(same, path << " is not what the sources give; VRUT_RENEW=1 test_protocol writes it anew");
}

/// Names of members in a schema, those of what is inside as well.
void add_members(const json& schema, std::set<std::string>& names) {
    if (!schema.is_object()) return;
    if (const auto properties = schema.find("properties"); properties != schema.end())
        for (const auto& [name, property] : properties->items()) {
            names.insert(name);
            add_members(property, names);
        }
    for (const char* inside : {"items", "additionalProperties"})
        if (schema.contains(inside)) add_members(schema[inside], names);
}

std::set<std::string> members(const json& schema) {
    std::set<std::string> names;
    add_members(schema, names);
    return names;
}

/// The line of PROTOCOL.md that begins with one of `starts`, and the words there in backquotes.
std::set<std::string> backquoted(const std::string& text) {
    std::set<std::string> words;
    for (std::size_t begin = text.find('`'); begin != std::string::npos;) {
        const std::size_t end = text.find('`', begin + 1);
        if (end == std::string::npos) break;
        words.insert(text.substr(begin + 1, end - begin - 1));
        begin = text.find('`', end + 1);
    }
    return words;
}

/// The part of the document under a heading.
std::string chapter(const std::string& document, const std::string& heading) {
    const std::size_t begin = document.find("\n## " + heading + "\n");
    INFO(heading);
    REQUIRE(begin != std::string::npos);
    return document.substr(begin, document.find("\n## ", begin + 1) - begin);
}

/// The line of `text` whose first words, up to `end`, hold `word` in backquotes.
std::string line_of(const std::string& text, const std::string& word, char end) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find_first_not_of("|- ");
        if (first == std::string::npos) continue;
        if (backquoted(line.substr(first, line.find(end, first) - first)).contains(word)) return line;
    }
    return {};
}

void check_named(const std::set<std::string>& names, const std::string& where, const std::string& text) {
    const auto words = backquoted(text);
    for (const std::string& name : names)
        CHECK_MESSAGE(words.contains(name), "PROTOCOL.md does not name '" << name << "' of " << where);
}

json definitions() { return json::parse(json_schema())["$defs"]; }

}  // namespace

TEST_CASE("the schema in the repository is the one that the server gives") {
    check_file(kProtocol + "protocol.schema.json", json_schema());
}

TEST_CASE("the examples have all members that the schema has") {
    const json defs = definitions();
    std::set<std::string> types;
    for (const json& type : examples::messages()["members"]) {
        const json& example = type["example"];
        std::string name = example["type"];
        types.insert(name);
        name[0] = static_cast<char>(name[0] - 'a' + 'A');
        std::set<std::string> tested, all;
        const json flat = example.flatten();
        for (const auto& [path, value] : flat.items()) {
            static_cast<void>(value);
            if (path != "/type" && path != "/id") tested.insert(path.substr(1, path.find('/', 1) - 1));
        }
        for (const json& member : type["members"]) {
            const std::string path = member["path"];
            all.insert(path.substr(1, path.find('/', 1) - 1));
        }
        CHECK(tested == all);
        all.insert({"type", "id"});
        std::set<std::string> described;
        for (const auto& [member, schema] : defs["client" + name]["properties"].items()) {
            static_cast<void>(schema);
            described.insert(member);
        }
        CHECK(described == all);
    }
    CHECK(types.size() == 24);
    CHECK(defs["clientMessage"]["oneOf"].size() == 24);
    CHECK(defs["serverMessage"]["oneOf"].size() == 12);
}

TEST_CASE("what the server says, for the schema to be tried on") {
    State state = examples::start();
    const auto first = StateDocument::next({}, state);
    json messages = json::array();
    const auto add = [&](const std::string& text) { messages.push_back(json::parse(text)); };
    add(encode(Welcome{1,
                       "0.1",
                       "c1",
                       Role::control,
                       {65536, 32, 2, 16'000'000, 10'000, 1'000'000},
                       {{100, 3, 0.5}, 1.1, 4, {{"vrut", {{"2", "pan"}}}}, {"f", "+"}, {"+"}}}));
    add(first->encode());
    state.camera.node = 4, state.camera.name = "Driver";
    state.selection = {5, "Door", {{"Car", "Door"}}, {{0, 5}}, 5};
    state.nodes.set("5", {false, -1, glm::dmat4(1), 3});
    state.markers.set("Scratch", {{1, 2, 3}, 5, "here"});
    state.control = {"c1", "Bea", true};
    state.clients.set({{"c1", {"Bea", Role::control}}, {"c2", {{}, Role::host}}});
    state.recording = RecordingState{"drive"};
    state.swings.set("5", {0.5});
    state.notices = {{"recording-ended", "The recording 'drive' has ended: No space left on device"}};
    auto background = state.backgrounds.items->at("11");
    background.texture = "sky.png";
    state.backgrounds.items.set("11", background);
    auto names = std::make_shared<Names>();
    (*names)["4"] = {"Driver"};
    state.cameras.value = names, state.materials.value = names;
    const auto second = StateDocument::next(*first, state);
    add(second->encode());
    add(second->encode_patch_from(*first, "c1"));
    add(StateDocument::next(*second, examples::start())->encode_patch_from(*second, ""));
    add(encode(Ok{5, 12, {}}));
    add(encode(Ok{5, 12, "drive"}));
    add(encode(Picked{4, {}, {}, {}, {}, {}, {}, {}}));
    add(encode(Picked{4, 7, "Door", {{"Car", "Door"}}, {{1, 2, 3}}, {{0, 0, 1}}, 5, {{1, 2, 0}}}));
    add(encode(Flown{6, true}));
    add(encode(TreePage{7, {}, {}}));
    add(encode(TreePage{
        7, {{1, "Car", "group", {}, true, 2, 0, {}}, {2, "Door", "geometry", 1, false, 0, 9, 3}}, 2}));
    TreePage switches{7, {{4, "Rim", "switch", 1, true, 2, 0, {}}}, {}};
    switches.nodes[0].active_child = -1;
    switches.nodes[0].choices = {"Five spokes", "Ten spokes"};
    add(encode(switches));
    TreePage hinged{7, {{3, "Door", "assembly", 1, true, 0, 0, {}}}, {}};
    hinged.nodes[0].hinge = {{0, 1, 0}, -65, glm::dmat4(1)};
    add(encode(hinged));
    add(encode(SceneList{8, {}}));
    add(encode(SceneList{8, {"car.vrut", "more/bus.vrut"}}));
    add(encode(SharedAddress{9, "http://192.0.2.7:8080/#watch", {"101", "010", "111"}, false}));
    add(encode(Loading{"car", 0.5, {}, {}}));
    add(encode(Loading{"car", 1, true, {}}));
    add(encode(Loading{"car", 0, {}, "no such file"}));
    add(encode(Stats{}));
    Stats stats;
    stats.renderer = {1, 2, 3};
    stats.quality = Quality{};
    stats.hosts["c2"] = {"Wall", 12, 3.5};
    add(encode(stats));
    for (const char* code : error_code::all) add(encode(Error{{}, code, "'x' is wrong"}));
    add(encode(Error{3, "busy", "too much"}));
    FrameHeader header;
    header.frame = 3;
    const json plain = json::parse(encode(header));
    header.snapshot = 17, header.camera.pose = state.camera, header.timing.since_input_ms = 2.5;
    header.markers["Scratch"] = {1, 2, 3};
    header.quality.error = 0.031;
    const json all = {{"serverMessage", messages},
                      {"frameHeader", {plain, json::parse(encode(header))}},
                      {"stateDocument", {first->json(), second->json()}}};
    check_file(VRUT_TEST_DATA "/server_messages.json", all.dump(1) + "\n");
}

TEST_CASE("PROTOCOL.md names every message and every member of it") {
    const std::string document = text_of(kProtocol + "PROTOCOL.md");
    const json defs = definitions();
    const auto check_side = [&](const char* side, const char* heading) {
        const std::string table = chapter(document, heading);
        for (const json& reference : defs[side]["oneOf"]) {
            const json& schema = defs[reference["$ref"].get<std::string>().substr(8)];
            const std::string type = schema["properties"]["type"]["const"];
            std::string row = line_of(table, type, '|');
            CHECK_MESSAGE(!row.empty(), "PROTOCOL.md has no row for '" << type << "'");
            // Said once for all that have them.
            if (row.find("modifier keys") != std::string::npos)
                row += "`ctrlKey` `shiftKey` `altKey` `metaKey`";
            if (row.find("{camera members}") != std::string::npos)
                row += "`node` `eye` `focus` `up` `center` `fov`";
            if (row.find("as in the frame header") != std::string::npos)
                row += chapter(document, "The frame header");
            std::set<std::string> names = members(schema);
            names.erase("type");
            names.erase("id");
            check_named(names, type, row);
        }
    };
    check_side("clientMessage", "Client to server");
    check_side("serverMessage", "Server to client");
    check_named({"type", "id"}, "every message", chapter(document, "Transport"));
}

TEST_CASE("PROTOCOL.md names the state document's and the frame header's members, and the errors") {
    const std::string document = text_of(kProtocol + "PROTOCOL.md");
    const json defs = definitions();
    const std::string state = chapter(document, "The state document");
    for (const auto& [section, schema] : defs["stateDocument"]["properties"].items())
        check_named(members(schema), section, line_of(state, section, ':'));
    const std::string header = chapter(document, "The frame header");
    std::set<std::string> names = members(defs["frameHeader"]);
    for (const auto& [name, schema] : defs["stateDocument"]["properties"]["camera"]["properties"].items()) {
        static_cast<void>(schema);
        names.erase(name);
    }
    check_named(names, "the frame header", header);
    const std::string server = chapter(document, "Server to client");
    check_named({error_code::all.begin(), error_code::all.end()}, "the error codes", server);
    CHECK(defs["serverError"]["properties"]["code"]["enum"].size() == 13);
}

TEST_CASE("PROTOCOL.md names the event log's members") {
    const std::string log = chapter(text_of(kProtocol + "PROTOCOL.md"), "The event log");
    LogHeader header;
    header.state = std::make_shared<const json>(json::object());
    header.at_home = true;
    header.home.emplace();
    header.clients = {{"c1", Role::view, Resize{}}};
    header.frames = {{}};
    LogHeader::Flight flight;
    flight.fly.keyframes = {{}};
    header.flight = flight;
    std::set<std::string> names = {"at", "client", "message", "event", "role"};
    const json written = json::parse(encode(header));
    for (const auto& [name, value] : written.items()) {
        names.insert(name);
        if (name != "state" && value.is_structured())
            for (const auto& [part, inner] : (value.is_array() ? value[0] : value).items()) {
                static_cast<void>(inner);
                names.insert(part);
            }
    }
    names.insert({"connected", "disconnected", "opened", "drawn"});
    check_named(names, "the event log", log);
}
