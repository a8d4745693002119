#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "codec.hpp"
#include "examples.hpp"
#include "frame_header.hpp"
#include "repository_files.hpp"
#include "state_document.hpp"

using namespace vrut::protocol;
using nlohmann::json;

namespace {

json definitions() { return json::parse(json_schema())["$defs"]; }

/// Members of an object and of what is inside that have no meaning, or a longer one than a cell may be.
void find_bad_meanings(const json& schema, const std::string& path, std::vector<std::string>& bad) {
    constexpr std::size_t kLongest = 120;
    const auto is_start = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
    if (const auto properties = schema.find("properties"); properties != schema.end())
        for (const auto& [name, member] : properties->items()) {
            const std::string meaning = member.value("description", "");
            const auto length =
                static_cast<std::size_t>(std::count_if(meaning.begin(), meaning.end(), is_start));
            const bool is_its_type = name == "type" || name == "event";
            if (length > kLongest || (length == 0 && !is_its_type)) bad.push_back(path + "." + name);
            find_bad_meanings(member, path + "." + name, bad);
        }
    for (const char* inside : {"items", "additionalProperties"})
        if (schema.contains(inside) && schema[inside].is_object())
            find_bad_meanings(schema[inside], path, bad);
}

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
    CHECK(types.size() == 27);
    CHECK(defs["clientMessage"]["oneOf"].size() == 27);
    CHECK(defs["serverMessage"]["oneOf"].size() == 14);
}

TEST_CASE("every member has a meaning, of at most 120 characters") {
    std::vector<std::string> bad;
    const json defs = definitions();
    for (const auto& [name, schema] : defs.items())
        if (name != "statePatch") find_bad_meanings(schema, name, bad);
    CHECK(bad == std::vector<std::string>{});
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
    const Pose view{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, {0, 0, 0}, 40};
    state.markers.set("Scratch", {{1, 2, 3}, 5, "here", "Bea", 1'764'345'600'000, view, true});
    state.sections.set("Lengthwise", {{0, 0, 1}, 0.25, true, true, false});
    state.control = {"c1", "Bea", true};
    state.clients.set({{"c1", {"Bea", Role::control}}, {"c2", {{}, Role::host}}});
    state.recording = RecordingState{"drive"};
    state.swings.set("5", {0.5});
    state.walls = WallsState{};
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
    add(encode(Pointed{"c2", {}, {}, {}}));
    add(encode(Pointed{"c2", "iPad", {{1, 2, 3}}, {{0, 0, 1}}}));
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
