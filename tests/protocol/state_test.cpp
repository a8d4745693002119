#include "state.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "codec.hpp"
#include "examples.hpp"
#include "repetitions.hpp"
#include "state_document.hpp"
#include "tokens.hpp"

using namespace vrut::protocol;
using nlohmann::json;

namespace {

using examples::start;

State after(const State& state, const char* patch) {
    auto result = patched(state, start(), json::parse(patch));
    REQUIRE_MESSAGE(result.has_value(), result.error().message);
    return *result;
}

Error rejection(const char* patch) {
    auto result = patched(start(), start(), json::parse(patch));
    REQUIRE_FALSE(result.has_value());
    return result.error();
}

/// RFC 7396, appendix A, written down from the text of the standard.
json merged(json target, const json& patch) {
    if (!patch.is_object()) return patch;
    if (!target.is_object()) target = json::object();
    for (const auto& [name, value] : patch.items()) {
        if (value.is_null())
            target.erase(name);
        else
            target[name] = merged(target[name], value);
    }
    return target;
}

}  // namespace

TEST_CASE("a patch changes what it names, to the bit, and nothing else") {
    const State state = after(start(), R"({"camera":{"eye":[0.1,0.2,0.30000000000000004],"fov":33}})");
    CHECK(state.camera.eye == glm::dvec3(0.1, 0.2, 0.30000000000000004));
    CHECK(state.camera.fov == 33);
    State expected = start();
    expected.camera.eye = state.camera.eye;
    expected.camera.fov = 33;
    CHECK(state == expected);
    CHECK(after(start(), "{}") == start());
}

TEST_CASE("every writable member can be patched and given back") {
    const char* patches[] = {
        R"({"camera":{"eye":[1,2,3]}})",
        R"({"camera":{"focus":[1,2,3]}})",
        R"({"camera":{"up":[1,2,3]}})",
        R"({"camera":{"center":[1,2,3]}})",
        R"({"camera":{"fov":170}})",
        R"({"navigation":{"keepUpright":false}})",
        R"({"navigation":{"rotateSpeed":0.01}})",
        R"({"navigation":{"panSpeed":100}})",
        R"({"navigation":{"zoomSpeed":2}})",
        R"({"navigation":{"style":"maya"}})",
        R"({"navigation":{"style":"catia"}})",
        R"({"navigation":{"style":"cinema4d"}})",
        R"({"renderer":{"mode":"stylized"}})",
        R"({"renderer":{"wireframe":true}})",
        R"({"renderer":{"showSelection":false}})",
        R"({"camera":{"node":0}})",
        R"({"lights":{"active":"7"}})",
        R"({"lights":{"items":{"7":{"color":[0,0,0,0]}}}})",
        R"({"nodes":{"5":{"active":false}}})",
        R"({"nodes":{"5":{"activeChild":-2}}})",
        R"({"nodes":{"5":{"matrix":[1,0,0,0.5,0,1,0,0,0,0,1,0,0,0,0,1]}}})",
        R"({"nodes":{"5":{"material":3}}})",
        R"({"views":{"home":{"eye":[1,2,3]}}})",
        R"({"views":{"home":{"focus":[1,2,3]}}})",
        R"({"views":{"home":{"up":[1,2,3]}}})",
        R"({"views":{"home":{"center":[1,2,3]}}})",
        R"({"views":{"home":{"fov":1}}})",
        R"({"views":{"home":{"order":1}}})",
        R"({"quality":{"preference":0}})",
        R"({"quality":{"latencyTargetMs":10000}})",
        R"({"lights":{"items":{"headlight":{"color":[1,0.5,0,1]}}}})",
        R"({"lights":{"items":{"headlight":{"attenuation":[1,0.5,0]}}}})",
        R"({"backgrounds":{"active":"11"}})",
        R"({"backgrounds":{"color":[0,0,0,1]}})",
        R"({"backgrounds":{"items":{"11":{"color":[0,0,0,1]}}}})",
        R"({"selection":{"node":5}})",
    };
    for (const char* patch : patches) {
        INFO(std::string(patch));
        const State changed = after(start(), patch);
        CHECK(changed != start());
        // null in place of the innermost value, then of each level above it up to the section.
        json reset = json::parse(patch);
        const std::string pointer = reset.flatten().begin().key();
        for (json::json_pointer at(pointer); !at.empty(); at = at.parent_pointer()) {
            if (reset.at(at.parent_pointer()).is_array()) continue;
            reset[at] = nullptr;
            INFO(reset.dump());
            State given_back = after(changed, reset.dump().c_str());
            if (*given_back.nodes == std::map<std::string, NodeOverride>{{"5", {}}}) given_back.nodes = {};
            CHECK(given_back == start());
        }
    }
}

TEST_CASE("what is patched has the value that was given") {
    const State state = after(start(), R"({
        "camera": {"node": 4, "eye": [1,2,3], "focus": [4,5,6], "up": [0,0,1], "center": [7,8,9], "fov": 1},
        "navigation": {"style": "cinema4d", "keepUpright": false, "turnAbout": "touched",
                       "rotateSpeed": 0.01, "panSpeed": 100, "zoomSpeed": 2},
        "renderer": {"mode": "stylized", "wireframe": true, "showSelection": false},
        "lights": {"active": "7", "items": {"7": {"color": [0,0.25,0.5,1], "attenuation": [0,1,2]}}},
        "backgrounds": {"active": "11", "color": [0,0,0,1], "items": {"11": {"color": [1,1,1,0.5]}}},
        "selection": {"node": 5},
        "nodes": {"5": {"active": false, "activeChild": -1, "matrix": [1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16],
                        "material": 3}},
        "markers": {"Scratch": {"point": [1,2,3], "node": 5, "text": "here", "author": "Bea", "time": 7, "done": true,
                    "view": {"eye": [5,0,0], "focus": [1,0,0], "up": [0,0,1], "center": [2,0,0], "fov": 60}}},
        "views": {"side": {"eye": [5,0,0], "focus": [1,0,0], "up": [0,0,1], "center": [2,0,0], "fov": 60, "order": -1.5}},
        "sections": {"cut": {"normal": [0,0,-2], "distance": 1.5, "on": false, "caps": false, "hatched": true}},
        "sectionBox": {"min": [-1,-2,-3], "max": [1,2,3], "on": true, "caps": false, "hatched": true},
        "measures": {"gap": {"kind": "length", "picks": [
            {"node": 3, "snap": "edge", "points": [[1,2,3],[0,0,0],[4,5,6]]}]}},
        "unit": {"metres": 0.0254, "shown": "in"},
        "quality": {"preference": 0.25, "latencyTargetMs": 20}})");
    State expected = start();
    expected.camera.node = 4;
    expected.camera.eye = {1, 2, 3}, expected.camera.focus = {4, 5, 6}, expected.camera.up = {0, 0, 1};
    expected.camera.center = {7, 8, 9}, expected.camera.fov = 1;
    expected.navigation = {
        NavigationState::Style::cinema4d, false, NavigationState::TurnAbout::touched, 0.01, 100, 2};
    expected.renderer = {DrawMode::stylized, true, false, 0, 0, 0};
    expected.lights.active = "7";
    expected.lights.items.set("7", {"Sun", "directional", {0, 0.25, 0.5, 1}, {0, 1, 2}});
    expected.backgrounds.active = "11";
    expected.backgrounds.color = {0, 0, 0, 1};
    expected.backgrounds.items.set("11", {"Studio", {1, 1, 1, 0.5}, {}});
    expected.selection.node = 5;
    // Row by row: the second number is in the first row's second column.
    const glm::dmat4 matrix{{1, 5, 9, 13}, {2, 6, 10, 14}, {3, 7, 11, 15}, {4, 8, 12, 16}};
    expected.nodes.set("5", {false, -1, matrix, 3});
    const Pose view{{5, 0, 0}, {1, 0, 0}, {0, 0, 1}, {2, 0, 0}, 60};
    expected.markers.set("Scratch", {{1, 2, 3}, 5, "here", "Bea", 7, view, true});
    expected.views.set("side", {{{5, 0, 0}, {1, 0, 0}, {0, 0, 1}, {2, 0, 0}, 60}, -1.5});
    expected.sections.set("cut", {{0, 0, -1}, 1.5, false, false, true});
    expected.section_box = {{-1, -2, -3}, {1, 2, 3}, true, false, true};
    expected.measures.set("gap", {MeasureKind::length, {{3, Snap::edge, {{1, 2, 3}, {0, 0, 0}, {4, 5, 6}}}}});
    expected.unit = {0.0254, UnitState::Shown::in};
    expected.quality = {0.25, 20};
    CHECK(state == expected);
}

namespace {

/// A member of the state: its place in a patch, and texts of what it may be, may not be by type, and may not
/// be by value.
struct Member {
    std::string path;
    std::vector<const char*> good, wrong_type, out_of_range;
};

const std::vector<const char*> kNoVector = {"5",          "true",        "\"x\"",    "{}",
                                            "[0,1,null]", "[0,1,\"1\"]", "[0,1,[1]]"};
const std::vector<const char*> kNoPosition = {"[]", "[1,2]", "[1,2,3,4]", "[1,2,1.1e30]", "[-1.1e30,2,3]"};
const std::vector<const char*> kNoNumber = {"true", "\"1\"", "[]", "{}"};
const std::vector<const char*> kNoFlag = {"0", "1", "\"true\"", "[]", "{}"};
const std::vector<const char*> kNoText = {"0", "true", "[]", "{}"};
const std::vector<const char*> kNoId = {"-1", "1.5", "9007199254740992"};
const std::vector<const char*> kNoColorType = {"5", "{}", "[0,1,1,null]", "[0,1,1,\"1\"]", "[0,1,1,true]"};
const std::vector<const char*> kNoColor = {"[]", "[1,1,1]", "[1,1,1,1,1]", "[1,1,1,1.01]", "[-0.01,0,0,0]"};
const std::vector<const char*> kNoLightColor = {"[]", "[1,1,1]", "[1,1,1,1,1]", "[2e30,1,1,1]",
                                                "[-0.01,0,0,0]"};
const std::vector<const char*> kNoSpeed = {"0", "0.0099", "100.1", "-1"};
const std::vector<const char*> kNoFov = {"0.999", "170.001", "-5"};

const std::vector<Member> kMembersOfSections = {
    {"/camera/node", {"0", "9007199254740991"}, kNoNumber, kNoId},
    {"/camera/eye", {"[1e30,-1e30,0]"}, kNoVector, kNoPosition},
    {"/camera/focus", {"[1e30,-1e30,0]"}, kNoVector, kNoPosition},
    {"/camera/up", {"[1e30,-1e30,0]"}, kNoVector, kNoPosition},
    {"/camera/center", {"[1e30,-1e30,0]"}, kNoVector, kNoPosition},
    {"/camera/fov", {"1", "170"}, kNoNumber, kNoFov},
    {"/navigation/style",
     {"\"vrut\"", "\"maya\"", "\"catia\"", "\"cinema4d\""},
     kNoText,
     {"\"\"", "\"Maya\""}},
    {"/navigation/keepUpright", {"true", "false"}, kNoFlag, {}},
    {"/navigation/turnAbout", {"\"center\"", "\"touched\""}, kNoText, {"\"\"", "\"Center\""}},
    {"/navigation/tapSwings", {"true", "false"}, kNoFlag, {}},
    {"/navigation/rotateSpeed", {"0.01", "100"}, kNoNumber, kNoSpeed},
    {"/navigation/panSpeed", {"0.01", "100"}, kNoNumber, kNoSpeed},
    {"/navigation/zoomSpeed", {"0.01", "100"}, kNoNumber, kNoSpeed},
    {"/renderer/mode", {"\"realistic\"", "\"stylized\""}, kNoText, {"\"\"", "\"fast\""}},
    {"/renderer/wireframe", {"true", "false"}, kNoFlag, {}},
    {"/renderer/showSelection", {"true", "false"}, kNoFlag, {}},
    {"/lights/active", {"\"7\"", "\"headlight\""}, kNoText, {}},
    {"/lights/items/7/color", {"[0,0,0,0]", "[1.08,40,1e30,1]"}, kNoColorType, kNoLightColor},
    {"/lights/items/7/attenuation",
     {"[0,0,1e30]"},
     kNoVector,
     {"[]", "[1,1]", "[1,1,1,1]", "[-0.1,0,0]", "[0,0,1.1e30]"}},
    {"/backgrounds/active", {"\"11\"", "\"color\""}, kNoText, {}},
    {"/backgrounds/color", {"[0,0,0,0]", "[1,1,1,1]"}, kNoColorType, kNoColor},
    {"/backgrounds/items/11/color", {"[0,0,0,0]", "[1,1,1,1]"}, kNoColorType, kNoColor},
    {"/selection/node", {"0", "9007199254740991"}, kNoNumber, kNoId},
    {"/nodes/5/active", {"true", "false"}, kNoFlag, {}},
    {"/nodes/5/activeChild", {"-2", "2147483647"}, kNoNumber, {"-3", "0.5", "2147483648"}},
    {"/nodes/5/matrix",
     {"[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1e30]"},
     {"5", "true", "\"x\"", "{}", "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,null]"},
     {"[]", "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0]", "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1.1e30]"}},
    {"/nodes/5/material", {"0", "9007199254740991"}, kNoNumber, kNoId},
    {"/markers/here/point", {"[1e30,-1e30,0]"}, kNoVector, kNoPosition},
    {"/markers/here/node", {"0", "9007199254740991"}, kNoNumber, kNoId},
    {"/markers/here/text", {"\"\"", "\"Žluťoučký kůň\""}, kNoText, {}},
    {"/markers/here/author", {"\"\"", "\"Jiří\""}, kNoText, {}},
    {"/markers/here/time", {"0", "253402300799999"}, kNoNumber, {"-1", "0.5", "253402300800000"}},
    {"/markers/here/view",
     {R"({"eye":[1e30,0,0],"focus":[0,0,0],"up":[0,1,0],"center":[0,0,0],"fov":170})"},
     {"5", "true", "\"x\"", "[]"},
     {}},
    {"/markers/here/done", {"true", "false"}, kNoFlag, {}},
    {"/views/home/eye", {"[1e30,-1e30,0]"}, kNoVector, kNoPosition},
    {"/views/home/focus", {"[1e30,-1e30,0]"}, kNoVector, kNoPosition},
    {"/views/home/up", {"[1e30,-1e30,0]"}, kNoVector, kNoPosition},
    {"/views/home/center", {"[1e30,-1e30,0]"}, kNoVector, kNoPosition},
    {"/views/home/fov", {"1", "170"}, kNoNumber, kNoFov},
    {"/views/home/order", {"-1e9", "0.5", "1e9"}, kNoNumber, {"-1.1e9", "1.1e9"}},
    {"/sections/cut/normal", {"[0,-1,0]", "[0.6,0,0.8]"}, kNoVector, kNoPosition},
    {"/sections/cut/distance", {"-1e30", "1e30"}, kNoNumber, {"-1.1e30", "1.1e30"}},
    {"/sections/cut/on", {"true", "false"}, kNoFlag, {}},
    {"/sections/cut/caps", {"true", "false"}, kNoFlag, {}},
    {"/sections/cut/hatched", {"true", "false"}, kNoFlag, {}},
    {"/sectionBox/min", {"[-1e30,-1,-1]"}, kNoVector, kNoPosition},
    {"/sectionBox/max", {"[1e30,1,1]"}, kNoVector, kNoPosition},
    {"/sectionBox/on", {"true", "false"}, kNoFlag, {}},
    {"/sectionBox/caps", {"true", "false"}, kNoFlag, {}},
    {"/sectionBox/hatched", {"true", "false"}, kNoFlag, {}},
    {"/measures/gap/kind",
     {"\"distance\"", "\"parallel\"", "\"angle\"", "\"radius\"", "\"length\""},
     kNoText,
     {"\"\"", "\"Angle\""}},
    {"/measures/gap/picks",
     {R"([{"node":0,"snap":"loop","points":[[1,2,3],[0,0,0],[1e30,1,1]]}])"},
     {"5", "true", "{}", "\"x\""},
     {"[]"}},
    {"/unit/metres", {"1e-12", "1e12"}, kNoNumber, {"0", "1.1e12", "-1"}},
    {"/unit/shown", {"\"mm\"", "\"cm\"", "\"m\"", "\"in\""}, kNoText, {"\"\"", "\"km\""}},
    {"/quality/preference", {"0", "1"}, kNoNumber, {"-0.01", "1.01"}},
    {"/quality/latencyTargetMs", {"1", "10000"}, kNoNumber, {"0.9", "10001"}},
    {"/pointing/watchers", {"true", "false"}, kNoFlag, {}},
    {"/comfort/on", {"true", "false"}, kNoFlag, {}},
    {"/comfort/degreesPerSecond", {"10", "720"}, kNoNumber, {"0", "-45", "721"}},
    {"/comfort/degreesPerSecondSquared", {"10", "10000"}, kNoNumber, {"0", "-1", "10001"}},
    {"/comfort/metresPerSecond", {"0.1", "100"}, kNoNumber, {"0", "-1", "101"}},
    {"/comfort/metresPerSecondSquared", {"0.1", "1000"}, kNoNumber, {"0", "-1", "1001"}},
};

/// A cue's own, and those that are the same as in the state.
std::vector<Member> members_of_cue() {
    std::vector<Member> members = {
        {"/cues/door/order", {"-1e9", "3.5"}, kNoNumber, {"1.1e9"}},
        {"/cues/door/text", {"\"\"", "\"Téměř\""}, kNoText, {}},
        {"/cues/door/ms", {"0", "60000"}, kNoNumber, {"-1", "60001"}},
        {"/cues/door/easing", {"\"smooth\"", "\"linear\""}, kNoText, {"\"\"", "\"ease\""}},
    };
    const std::vector<std::string> same{
        "/lights/active", "/backgrounds/active", "/backgrounds/color", "/selection/",
        "/nodes/",        "/sections/",          "/sectionBox/"};
    for (Member member : kMembersOfSections) {
        const bool is_pose = member.path.starts_with("/views/home/") && member.path != "/views/home/order";
        const bool is_same = std::ranges::any_of(
            same, [&](const std::string& start) { return member.path.starts_with(start); });
        if (!is_pose && !is_same) continue;
        member.path = "/cues/door" + (is_pose ? "/camera" + member.path.substr(11) : member.path);
        members.push_back(member);
    }
    return members;
}

const std::vector<Member> kMembers = [] {
    std::vector<Member> members = kMembersOfSections;
    const std::vector<Member> of_cue = members_of_cue();
    members.insert(members.end(), of_cue.begin(), of_cue.end());
    return members;
}();

const std::vector<const char*> kReadOnly = {"/scene",
                                            "/walls",
                                            "/cameras",
                                            "/materials",
                                            "/control",
                                            "/recording",
                                            "/measured",
                                            "/cue",
                                            "/notices",
                                            "/camera/name",
                                            "/camera/near",
                                            "/camera/far",
                                            "/renderer/solid",
                                            "/lights/items/7/name",
                                            "/lights/items/7/type",
                                            "/backgrounds/items/11/name",
                                            "/backgrounds/items/11/texture",
                                            "/selection/name",
                                            "/selection/path",
                                            "/renderer/transparent",
                                            "/renderer/reflective"};

State with_entries() {
    return after(start(), R"({"markers":{"here":{"point":[1,2,3]}},"sections":{"cut":{"normal":[0,0,1]}},
        "measures":{"gap":{"picks":[{"node":1,"snap":"point","points":[[1,2,3]]}]}},
        "cues":{"door":{"sections":{"cut":{"normal":[0,0,1]}}}}})");
}

json patch_at(const std::string& path, const json& value) {
    json patch = json::object();
    json* place = &patch;
    std::size_t begin = 1;  // keys, not array indices, though they be digits
    for (std::size_t end = path.find('/', begin); end != std::string::npos; end = path.find('/', begin)) {
        place = &(*place)[path.substr(begin, end - begin)];
        begin = end + 1;
    }
    (*place)[path.substr(begin)] = value;
    return patch;
}

std::string dotted(std::string path) {
    path.erase(0, 1);
    std::replace(path.begin(), path.end(), '/', '.');
    return "'" + path + "'";
}

void check_refused(const json& patch, const char* code, const std::string& culprit) {
    INFO(patch.dump());
    const auto result = patched(with_entries(), start(), patch);
    REQUIRE_FALSE(result.has_value());
    CHECK(result.error().code == code);
    CHECK_MESSAGE(result.error().message.find(culprit) != std::string::npos, result.error().message);
}

}  // namespace

TEST_CASE("each member of the state: types and ranges") {
    for (const Member& member : kMembers) {
        const std::string name = dotted(member.path);
        for (const char* value : member.wrong_type)
            check_refused(patch_at(member.path, json::parse(value)), "bad-message", name);
        for (const char* value : member.out_of_range)
            check_refused(patch_at(member.path, json::parse(value)), "out-of-range", name);
        for (const char* value : member.good) {
            const json patch = patch_at(member.path, json::parse(value));
            INFO(patch.dump());
            const auto result = patched(with_entries(), start(), patch);
            REQUIRE(result.has_value());
            // The document has it as it was given.
            const json document = StateDocument::next({}, *result)->json();
            CHECK(merged(document, patch) == document);
        }
        const std::string parent = member.path;
        const std::string sibling = parent.substr(0, parent.rfind('/')) + "/nose";
        check_refused(patch_at(sibling, 1), "unknown-member", dotted(sibling));
        check_refused(patch_at(sibling, nullptr), "unknown-member", dotted(sibling));
    }
}

TEST_CASE("what is read-only is refused, whatever it is given") {
    for (const char* path : kReadOnly)
        for (const json& value : {json(), json(1), json("x"), json::object(), json::array()})
            check_refused(patch_at(path, value), "read-only", dotted(path));
}

TEST_CASE("the state has the members that are tested here, and no others") {
    const json schema = json::parse(json_schema())["$defs"]["statePatch"]["properties"];
    std::size_t leaves = 0;
    std::function<void(const json&)> count = [&](const json& properties) {
        for (const json& property : properties) {
            const json& value = property["anyOf"][1];
            const bool is_whole = value.contains("required");  // a list of members, given all at once
            if (value.contains("properties") && !is_whole)
                count(value["properties"]);
            else if (value.contains("additionalProperties"))
                count(value["additionalProperties"]["anyOf"][1]["properties"]);
            else
                ++leaves;
        }
    };
    count(schema);
    CHECK(leaves == kMembers.size());
}

TEST_CASE("sections and entries are objects") {
    for (const char* path : {"/camera",
                             "/navigation",
                             "/renderer",
                             "/lights",
                             "/lights/items",
                             "/lights/items/7",
                             "/backgrounds",
                             "/backgrounds/items",
                             "/backgrounds/items/11",
                             "/selection",
                             "/nodes",
                             "/nodes/5",
                             "/markers",
                             "/markers/here",
                             "/markers/new",
                             "/views",
                             "/views/home",
                             "/views/new",
                             "/sections",
                             "/sections/new",
                             "/sectionBox",
                             "/measures",
                             "/measures/new",
                             "/unit",
                             "/cues",
                             "/cues/door",
                             "/cues/new",
                             "/cues/new/camera",
                             "/cues/new/nodes",
                             "/cues/new/selection",
                             "/quality"})
        for (const json& value : {json(1), json(true), json("x"), json::array()})
            check_refused(patch_at(path, value), "bad-message", dotted(path));
    for (const json& patch : {json(), json(1), json("x"), json::array()})
        check_refused(patch, "bad-message", "'patch'");
}

TEST_CASE("the scene's own items neither come nor go") {
    check_refused(json::parse(R"({"lights":{"items":{"8":{}}}})"), "unknown-node", "'8'");
    check_refused(json::parse(R"({"lights":{"items":{"8":null}}})"), "unknown-node", "'8'");
    check_refused(json::parse(R"({"backgrounds":{"items":{"7":{}}}})"), "unknown-node", "'7'");
    check_refused(json::parse(R"({"lights":{"active":"color"}})"), "unknown-node", "'color'");
    check_refused(json::parse(R"({"backgrounds":{"active":"headlight"}})"), "unknown-node", "'headlight'");
    State changed =
        after(start(), R"({"lights":{"items":{"7":{"color":[0,0,0,1]},"headlight":{"color":[0,0,0,1]}}}})");
    changed = after(changed, R"({"lights":{"items":{"7":null}}})");
    CHECK(changed.lights.items->at("7") == start().lights.items->at("7"));
    CHECK(changed.lights.items->at("headlight").color == glm::dvec4(0, 0, 0, 1));
    CHECK(after(changed, R"({"lights":{"items":null}})") == start());
    CHECK(after(changed, R"({"lights":{"items":{"7":{}}}})") == changed);
}

TEST_CASE("sections are added, changed and removed, and their normals are unit") {
    State state =
        after(start(), R"({"sections":{"a":{"normal":[3,0,4],"distance":2},"b":{"normal":[0,1e30,0]}}})");
    CHECK(state.sections->at("a") == SectionState{{0.6, 0, 0.8}, 2});
    CHECK(state.sections->at("b") == SectionState{{0, 1, 0}, 0});
    const glm::dvec3 unit = glm::normalize(glm::dvec3(0.3, -0.7, 0.1));
    State turned = after(state, R"({"sections":{"a":{"normal":[0.3,-0.7,0.1]}}})");
    CHECK(glm::distance(turned.sections->at("a").normal, unit) < 1e-15);
    CHECK(after(turned, R"({"sections":{"a":{"on":false}}})").sections->at("a").normal ==
          turned.sections->at("a").normal);
    state = after(state, R"({"sections":{"a":null,"never":null}})");
    CHECK(state.sections->size() == 1);
    CHECK(after(state, R"({"sections":null})").sections->empty());
    check_refused(json::parse(R"({"sections":{"new":{"distance":1}}})"), "bad-message",
                  "'sections.new.normal'");
    check_refused(json::parse(R"({"sections":{"new":{"normal":[0,0,0]}}})"), "out-of-range",
                  "'sections.new.normal' is [0, 0, 0]");
    check_refused(json::parse(R"({"sections":{"new":{"normal":[0,-0.0,0]}}})"), "out-of-range",
                  "must lead somewhere");
}

TEST_CASE("there are six planes of sections at most") {
    State state = start();
    for (const char* name : {"1", "2", "3", "4", "5", "6"})
        state = after(state, ("{\"sections\":{\"" + std::string(name) + "\":{\"normal\":[1,0,0]}}}").c_str());
    const auto seventh = patched(state, start(), json::parse(R"({"sections":{"7":{"normal":[1,0,0]}}})"));
    REQUIRE_FALSE(seventh);
    CHECK(seventh.error().code == "too-many");
    CHECK(seventh.error().message.find("6 entries") != std::string::npos);
    CHECK(patched(state, start(), json::parse(R"({"sections":{"1":null,"7":{"normal":[1,0,0]}}})")));
}

TEST_CASE("picks of a measure: types and ranges") {
    const auto refused = [](const char* pick, const char* code, const char* culprit) {
        check_refused(json::parse("{\"measures\":{\"new\":{\"picks\":[" + std::string(pick) + "]}}}"), code,
                      culprit);
    };
    refused("5", "bad-message", "'measures.new.picks[0]'");
    refused(R"({"node":1,"snap":"point"})", "bad-message", "'measures.new.picks[0].points'");
    refused(R"({"snap":"point","points":[[1,2,3]]})", "bad-message", "'measures.new.picks[0].node'");
    refused(R"({"node":1,"snap":"point","points":[1,2,3]})", "bad-message",
            "'measures.new.picks[0].points[0]'");
    refused(R"({"node":-1,"snap":"point","points":[[1,2,3]]})", "out-of-range",
            "'measures.new.picks[0].node'");
    refused(R"({"node":1,"snap":"corner","points":[[1,2,3]]})", "out-of-range",
            "'measures.new.picks[0].snap'");
    refused(R"({"node":1,"snap":"point","points":[]})", "out-of-range", "'measures.new.picks[0].points'");
    refused(R"({"node":1,"snap":"point","points":[[1,2,1.1e30]]})", "out-of-range",
            "'measures.new.picks[0].points[0]'");
    const std::string pick = R"({"node":1,"snap":"point","points":[[1,2,3]]})";
    refused((pick + "," + pick + "," + pick + "," + pick).c_str(), "out-of-range", "'measures.new.picks'");
}

TEST_CASE("the section box has a size in each direction") {
    check_refused(json::parse(R"({"sectionBox":{"min":[0,1,0]}})"), "out-of-range", "\'sectionBox.min\'");
    check_refused(json::parse(R"({"sectionBox":{"max":[-1,-2,-3]}})"), "out-of-range", "\'sectionBox.min\'");
    const State state = after(start(), R"({"sectionBox":{"min":[5,5,5],"max":[6,6,6],"on":true}})");
    CHECK(after(state, R"({"sectionBox":null})") == start());
}

TEST_CASE("a restored state has its sections, to the last bit") {
    const State state = after(
        start(), R"({"sections":{"a":{"normal":[0.3,-0.7,0.1],"distance":0.1}},"sectionBox":{"on":true}})");
    const auto read = restored(start(), *document_of(state));
    REQUIRE(read);
    CHECK(*read == state);
}

TEST_CASE("markers are added, changed and removed") {
    State state =
        after(start(), R"({"markers":{"a":{"point":[1,2,3]},"b":{"point":[4,5,6],"node":5,"text":"x"}}})");
    CHECK(state.markers->at("a") == Marker{{1, 2, 3}, {}, ""});
    CHECK(state.markers->at("b") == Marker{{4, 5, 6}, 5, "x"});
    state = after(state, R"({"markers":{"a":{"text":"y"},"b":{"node":null}}})");
    CHECK(state.markers->at("a") == Marker{{1, 2, 3}, {}, "y"});
    CHECK(state.markers->at("b") == Marker{{4, 5, 6}, {}, "x"});
    state = after(state, R"({"markers":{"a":null,"never":null}})");
    CHECK(state.markers->size() == 1);
    CHECK(after(state, R"({"markers":null})").markers->empty());
    check_refused(json::parse(R"({"markers":{"new":{}}})"), "bad-message", "'markers.new.point'");
    json view = {
        {"eye", {0, 0, 9}}, {"focus", {0, 0, 0}}, {"up", {0, 1, 0}}, {"center", {0, 0, 0}}, {"fov", 171}};
    check_refused(patch_at("/markers/here/view", view), "out-of-range", "'markers.here.view.fov'");
    view.erase("fov");
    check_refused(patch_at("/markers/here/view", view), "bad-message", "'markers.here.view.fov'");
    check_refused(json::parse(R"({"markers":{"new":{"text":"x"}}})"), "bad-message", "'markers.new.point'");
    // One that is gone is new again.
    CHECK_FALSE(patched(state, start(), json::parse(R"({"markers":{"a":{"text":"x"}}})")).has_value());
}

TEST_CASE("what is kept with a scene, and what hosts may patch, their descriptions say") {
    CHECK(names_of(Sections::kept) ==
          std::vector<std::string>{"cues", "markers", "measures", "nodes", "unit", "views"});
    CHECK(names_of(Sections::for_hosts) == std::vector<std::string>{"camera", "nodes", "selection"});
    const auto names_only = [](const char* patch, Sections sections) {
        return vrut::protocol::names_only(json::parse(patch), sections);
    };
    CHECK(names_only(R"({"camera":{},"nodes":null})", Sections::for_hosts));
    CHECK_FALSE(names_only(R"({"camera":{},"nodes":null})", Sections::kept));
    CHECK_FALSE(names_only(R"({"none":{}})", Sections::kept));
}

TEST_CASE("another scene is opened: settings go on, what belongs to the scene does not") {
    State before = start();
    before.quality.preference = 0.25;
    before.renderer = {DrawMode::stylized, true, false, 1, 2, 3};
    before.navigation.pan_speed = 2;
    before.control.holder = "c1";
    before.notices = {{"no-memory", "one"}};
    before.camera.fov = 5;
    before.unit.metres = 1;
    before.views.set("mine", {});
    State starting = start();
    starting.renderer.solid = 7;
    const State next = opened(starting, before);
    CHECK(next.quality == before.quality);
    CHECK(next.renderer == RendererState{DrawMode::stylized, true, false, 7, 0, 0});
    CHECK(next.navigation == before.navigation);
    CHECK(next.control == before.control);
    CHECK(next.notices == before.notices);
    CHECK(next.camera == starting.camera);
    CHECK(next.unit == starting.unit);
    CHECK(next.views == starting.views);
}

TEST_CASE("views are added, changed and removed; those of the start come back") {
    State state = after(start(), R"({"camera":{"eye":[7,8,9],"up":[0,0,1],"fov":55}})");
    state = after(state, R"({"views":{"here":{},"low":{"eye":[1,1,1]}}})");
    CHECK(state.views->at("here") == ViewState{{{7, 8, 9}, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 55}, {}});
    CHECK(state.views->at("low") == ViewState{{{1, 1, 1}, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 55}, {}});
    CHECK(after(state, R"({"views":{"b":{"eye":null,"fov":5}}})").views->at("b") ==
          ViewState{{{7, 8, 9}, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 5}, {}});
    CHECK(after(state, R"({"views":{"low":{"eye":null}}})").views->at("low") == state.views->at("here"));
    // It was saved: where the camera goes does not move it, nor does a patch of nothing.
    state = after(state, R"({"camera":{"eye":[0,0,1]},"views":{"here":{}}})");
    CHECK(state.views->at("here").eye == glm::dvec3(7, 8, 9));
    // With the camera in the same patch it is that one that is saved.
    state = after(state, R"({"camera":{"eye":[0,0,2]},"views":{"both":{}}})");
    CHECK(state.views->at("both").eye == glm::dvec3(0, 0, 2));
    state = after(state, R"({"views":{"home":{"fov":20},"low":null,"both":{"order":2}}})");
    CHECK(state.views->at("both").order == 2);
    CHECK(state.views->at("both").eye == glm::dvec3(0, 0, 2));
    CHECK_FALSE(after(state, R"({"views":{"both":{"order":null}}})").views->at("both").order.has_value());
    CHECK(state.views->at("home").fov == 20);
    CHECK_FALSE(state.views->contains("low"));
    CHECK(after(state, R"({"views":{"home":null}})").views->at("home") == start().views->at("home"));
    CHECK(after(state, R"({"views":null})").views == start().views);
}

TEST_CASE("names and numbers of entries are bounded") {
    const auto markers = [](int first, int count) {
        json patch = {{"markers", json::object()}};
        for (int i = first; i < first + count; ++i)
            patch["markers"]["m" + std::to_string(i)] = {{"point", {0, 0, 0}}};
        return patch;
    };
    CHECK(kMaxEntries == 256);
    const State full = after(start(), markers(0, 256).dump().c_str());
    CHECK(full.markers->size() == 256);
    check_refused(markers(0, 257), "too-many", "'markers'");
    const auto more = patched(full, start(), markers(256, 1));
    REQUIRE_FALSE(more.has_value());
    CHECK(more.error().code == std::string("too-many"));
    // In place of another one may come; a full table may be changed.
    json exchange = markers(256, 1);
    exchange["markers"]["m0"] = nullptr;
    CHECK(patched(full, start(), exchange).has_value());
    CHECK(patched(full, start(), markers(0, 256)).has_value());

    json views = {{"views", json::object()}};
    for (int i = 0; i < 255; ++i) views["views"]["v" + std::to_string(i)] = json::object();
    CHECK(after(start(), views.dump().c_str()).views->size() == 256);  // with home
    views["views"]["v255"] = json::object();
    check_refused(views, "too-many", "'views'");
    json measures = {{"measures", json::object()}};
    const json pick = json::parse(R"({"picks":[{"node":1,"snap":"point","points":[[1,2,3]]}]})");
    for (int i = 0; i < 257; ++i) measures["measures"]["m" + std::to_string(i)] = pick;
    check_refused(measures, "too-many", "'measures'");
    check_refused(json::parse(R"({"measures":{"new":{"kind":"angle"}}})"), "bad-message",
                  "'measures.new.picks'");

    const std::string longest(100, 'n'), longer(101, 'n'),
        accents = "žžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžžž";
    CHECK(accents.size() == 100);
    for (const char* section : {"markers", "views", "nodes"}) {
        const json value = section == std::string("markers") ? json{{"point", {0, 0, 0}}} : json::object();
        CHECK(patched(start(), start(), {{section, {{longest, value}}}}).has_value());
        CHECK(patched(start(), start(), {{section, {{accents, value}}}}).has_value());
        for (const std::string& name : {std::string(), longer, accents + "x"}) {
            check_refused({{section, {{name, value}}}}, "out-of-range", section);
            check_refused({{section, {{name, nullptr}}}}, "out-of-range", section);
        }
    }
    const json text = {{"markers", {{"a", {{"point", {0, 0, 0}}, {"text", std::string(1000, 'x')}}}}}};
    CHECK(patched(start(), start(), text).has_value());
    check_refused(patch_at("/markers/here/text", std::string(1001, 'x')), "out-of-range",
                  "'markers.here.text'");
}

TEST_CASE("what is wrong with a patch is named, and nothing is changed") {
    struct Case {
        const char *patch, *code, *culprit;
    };
    const Case cases[] = {
        {R"({"colour":1})", "unknown-member", "'colour'"},
        {R"({"camera":{"nose":1}})", "unknown-member", "'camera.nose'"},
        {R"({"camera":{"near":1}})", "read-only", "'camera.near'"},
        {R"({"camera":{"near":null}})", "read-only", "'camera.near'"},
        {R"({"scene":{"name":"x"}})", "read-only", "'scene'"},
        {R"({"control":null})", "read-only", "'control'"},
        {R"({"clients":{"c1":null}})", "read-only", "'clients'"},
        {R"({"camera":5})", "bad-message", "'camera'"},
        {R"({"camera":{"eye":5}})", "bad-message", "'camera.eye'"},
        {R"({"camera":{"eye":[1,2]}})", "out-of-range", "'camera.eye'"},
        {R"({"camera":{"eye":[1,2,"3"]}})", "bad-message", "'camera.eye'"},
        {R"({"camera":{"eye":[1,2,null]}})", "bad-message", "'camera.eye'"},
        {R"({"camera":{"fov":0.5}})", "out-of-range", "'camera.fov'"},
        {R"({"camera":{"fov":171}})", "out-of-range", "'camera.fov'"},
        {R"({"navigation":{"keepUpright":1}})", "bad-message", "'navigation.keepUpright'"},
        {R"({"navigation":{"zoomSpeed":0}})", "out-of-range", "'navigation.zoomSpeed'"},
        {R"({"lights":{"active":"99"}})", "unknown-node", "'99'"},
        {R"({"lights":{"items":{"99":{"color":[1,1,1,1]}}}})", "unknown-node", "'99'"},
        {R"({"lights":{"items":{"headlight":{"name":"x"}}}})", "read-only", "'lights.items.headlight.name'"},
        {R"({"lights":{"items":{"headlight":{"attenuation":[1,-1,0]}}}})", "out-of-range", "attenuation"},
        {R"({"backgrounds":{"color":[0,0,2,1]}})", "out-of-range", "'backgrounds.color'"},
        {R"({"backgrounds":{"active":11}})", "bad-message", "'backgrounds.active'"},
        {R"({"selection":{"node":1.5}})", "out-of-range", "'selection.node'"},
        {R"({"selection":{"name":"x"}})", "read-only", "'selection.name'"},
        // One wrong member spoils the whole patch.
        {R"({"camera":{"fov":50},"navigation":{"zoomSpeed":0}})", "out-of-range", "'navigation.zoomSpeed'"},
    };
    for (const Case& c : cases) {
        INFO(std::string(c.patch));
        const Error error = rejection(c.patch);
        CHECK(error.code == c.code);
        CHECK_MESSAGE(error.message.find(c.culprit) != std::string::npos, error.message);
    }
}

TEST_CASE("the patch between two documents leads from one to the other") {
    State state = start();
    const auto first = StateDocument::next({}, state);
    state.camera.eye = {1, 2, 3};
    state.control.holder = "c1";
    const auto second = StateDocument::next(*first, state);
    state.control.holder.reset();
    state.navigation.zoom_speed = 3;
    const auto third = StateDocument::next(*second, state);

    const auto document = [](const auto& d) { return json::parse(d->encode()); };
    CHECK(document(first)["revision"] == 1);
    CHECK(document(third)["revision"] == 3);
    const auto step = [&](const auto& from, const auto& to) {
        const json message = json::parse(to->encode_patch_from(*from, "c1"));
        CHECK(message["by"] == "c1");
        CHECK(message["revision"] == to->revision());
        CHECK(merged(document(from)["state"], message["patch"]) == document(to)["state"]);
        return message["patch"];
    };
    CHECK(step(first, second) == json::parse(R"({"camera":{"eye":[1,2,3]},"control":{"holder":"c1"}})"));
    CHECK(step(second, third) == json::parse(R"({"control":{"holder":null},"navigation":{"zoomSpeed":3}})"));
    // What a slow client missed is the difference, not the sum.
    CHECK(step(first, third) == json::parse(R"({"camera":{"eye":[1,2,3]},"navigation":{"zoomSpeed":3}})"));
    CHECK_FALSE(json::parse(third->encode_patch_from(*first, ""))["patch"].contains("by"));
}

TEST_CASE("a document knows when what a patch names changed last") {
    State state = start();
    const auto first = StateDocument::next({}, state);
    state.camera.eye = {1, 2, 3};
    const auto second = StateDocument::next(*first, state);
    state.control.holder = "c1";
    const auto third = StateDocument::next(*second, state);
    state.control.holder.reset();
    const auto fourth = StateDocument::next(*third, state);
    const auto last = [&](const char* patch) { return fourth->last_change(json::parse(patch)); };
    CHECK(last(R"({"camera":{"eye":[0,0,0]}})") == 2);
    CHECK(last(R"({"camera":{"fov":20}})") == 1);
    CHECK(last(R"({"camera":null})") == 2);
    CHECK(last(R"({"camera":{"fov":20},"control":{"holder":"x"}})") == 4);
    CHECK(last("{}") == 0);
}

namespace {

/// Random patches that a State takes: all kinds of change, and of members that are absent and come.
class RandomSteps {
public:
    explicit RandomSteps(unsigned seed) : random_(seed) {}

    State next(const State& state) {
        State result = state;
        for (std::size_t i = 0; i <= below(3); ++i) {
            const auto taken = patched(result, start(), patch());
            REQUIRE_MESSAGE(taken.has_value(), taken.error().message);
            result = *taken;
        }
        // What the server itself changes.
        switch (below(12)) {
            case 0:
                result.recording = RecordingState{"log" + std::to_string(below(3))};
                break;
            case 1:
                result.recording.reset();
                break;
            case 2:
                result.control = {"c" + std::to_string(below(3)), "Bea", below(2) == 0};
                break;
            case 3:
                result.control.holder.reset();
                break;
            case 4:
                result.selection = {5, "Door", {{"Car", "Door"}}, {{0, 5}}, {}};
                break;
            case 5:
                result.camera.name = "Driver";
                break;
            case 6:
                change_scene(result);
                break;
            case 7:
                result.measured.set("n" + std::to_string(below(4)), {1.5, {{1, 0, 0}}, {{1, 2, 3}}, {}});
                break;
            case 8:
                result.cue.reset();
                if (!result.cues->empty()) result.cue = ShownCueState{result.cues->begin()->first};
                break;
            case 9:
                result.walls = WallsState{};
                result.walls->behind_degrees = static_cast<double>(below(3));
                break;
            case 10:
                result.walls.reset();
                break;
            default:
                break;
        }
        // As the room keeps it.
        if (result.cue && !result.cues->contains(result.cue->name)) result.cue.reset();
        return result;
    }

private:
    std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

    json patch() {
        const Member& member = kMembers[below(kMembers.size())];
        std::string path = member.path;
        const std::string value = member.good[below(member.good.size())];
        if (below(4) == 0) {  // null at some level
            for (std::size_t up = below(3); up > 0 && path.rfind('/') != 0; --up) path.erase(path.rfind('/'));
            const bool of_new = path.starts_with("/markers/here/") || path.starts_with("/sections/cut/") ||
                                path.starts_with("/measures/gap/") ||
                                path.starts_with("/cues/door/sections/");
            return of_new ? json::object() : patch_at(path, nullptr);
        }
        const std::string name = "n" + std::to_string(below(4));
        if (path.starts_with("/markers/"))
            return {{"markers", {{name, {{"point", {1, 2, below(3)}}, {"text", name}}}}}};
        if (path.starts_with("/sections/"))
            return {{"sections", {{name, {{"normal", {1, 0, below(3)}}, {"distance", below(3)}}}}}};
        if (path.starts_with("/measures/")) {
            const json pick = {
                {"node", below(3)}, {"snap", "vertex"}, {"points", json::array({{1, 2, below(3)}})}};
            return {{"measures", {{name, {{"kind", "distance"}, {"picks", json::array({pick, pick})}}}}}};
        }
        if (path.starts_with("/cues/")) {
            if (path.find("/sections/") == std::string::npos) return patch_at(path, json::parse(value));
            const json section = {{"normal", {1, 0, below(3)}}, {"distance", below(3)}};
            return {{"cues", {{name, {{"sections", {{"cut", section}}}, {"text", name}}}}}};
        }
        if (path.starts_with("/views/") && below(2) == 0) return {{"views", {{name, json::object()}}}};
        if (path.starts_with("/nodes/")) path.replace(7, 1, std::to_string(below(3)));
        return patch_at(path, json::parse(value));
    }

    void change_scene(State& state) {
        auto names = std::make_shared<Names>();
        for (std::size_t i = 0; i < below(4); ++i)
            (*names)[std::to_string(below(5))] = {"name" + std::to_string(i)};
        (below(2) == 0 ? state.cameras : state.materials).value = names;
    }

    std::mt19937 random_;
};

}  // namespace

TEST_CASE("the patch from any document to any later one leads there") {
    for (int seed = 1; seed <= vrut::test::repetitions(20); ++seed) {
        RandomSteps steps(static_cast<unsigned>(seed));
        State state = start();
        std::vector<std::shared_ptr<const StateDocument>> documents = {StateDocument::next({}, state)};
        for (int i = 0; i < 40; ++i) {
            state = steps.next(state);
            documents.push_back(StateDocument::next(*documents.back(), state));
        }
        for (std::size_t to = 0; to < documents.size(); ++to)
            for (std::size_t from = 0; from <= to; ++from) {
                const json message = json::parse(documents[to]->encode_patch_from(*documents[from], ""));
                INFO(message.dump());
                const json result = merged(documents[from]->json(), message["patch"]);
                if (result != documents[to]->json()) FAIL("not what it should be: " << result.dump());
                if (from == to) CHECK(message["patch"].empty());
            }
    }
}

TEST_CASE("a document has no null, and its unchanged parts are those before") {
    RandomSteps steps(99);
    State state = start();
    for (int i = 0; i < 200; ++i) {
        state = steps.next(state);
        const auto document = StateDocument::next({}, state);
        const std::string text = document->encode();
        CHECK_MESSAGE(text.find("null") == std::string::npos, text);
        // Made step by step or at once, it is the same.
        CHECK(StateDocument::next(*document, state)->json() == document->json());
        CHECK(document->shows(state));
    }
}

TEST_CASE("a state comes back from its document") {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        RandomSteps steps(seed);
        State state = start();
        for (int i = 0; i < 60; ++i) {
            state = steps.next(state);
            // What is only told is not taken from the document; the server finds it anew.
            State starting = start();
            starting.scene = state.scene, starting.cameras = state.cameras,
            starting.materials = state.materials;
            starting.camera.name = state.camera.name;
            starting.selection.name = state.selection.name, starting.selection.path = state.selection.path;
            starting.selection.path_ids = state.selection.path_ids;
            starting.recording = state.recording;
            starting.measured = state.measured;
            starting.walls = state.walls;
            const json document = json::parse(StateDocument::next({}, state)->json().dump());
            const auto back = restored(starting, document);
            REQUIRE_MESSAGE(back.has_value(), back.error().message);
            CHECK(*back == state);
        }
    }
}

TEST_CASE("a document that is none is not restored") {
    for (const char* text :
         {"[]", "null", R"({"camera":5})", R"({"camera":{"eye":[1,2]}})", R"({"camera":{"fov":171}})",
          R"({"navigation":{"style":5}})", R"({"lights":{"active":"99"}})", R"({"lights":{"items":[]}})",
          R"({"markers":{"a":{"text":5}}})", R"({"views":[]})", R"({"control":{"holder":5}})",
          R"({"control":{"kept":5}})", R"({"control":{"name":5}})", R"({"nodes":{"5":{"matrix":[1]}}})"}) {
        INFO(std::string(text));
        const auto result = restored(start(), json::parse(text));
        REQUIRE_FALSE(result.has_value());
        CHECK_FALSE(result.error().message.empty());
    }
    // What is not there is as it starts.
    CHECK(restored(start(), json::object()).value() == start());
}

TEST_CASE("what came and went is stale, each by its own revision") {
    State state = start();
    auto document = StateDocument::next({}, state);
    const auto step = [&](const char* patch) {
        state = after(state, patch);
        document = StateDocument::next(*document, state);
    };
    const auto last = [&](const char* patch) { return document->last_change(json::parse(patch)); };
    step(R"({"markers":{"a":{"point":[1,2,3]}}})");  // 2
    step(R"({"markers":{"b":{"point":[1,2,3]}}})");  // 3
    step(R"({"markers":{"a":{"text":"x"}}})");       // 4
    step(R"({"camera":{"fov":20}})");                // 5
    CHECK(last(R"({"markers":{"a":{"point":[0,0,0]}}})") == 2);
    CHECK(last(R"({"markers":{"a":{"text":""}}})") == 4);
    CHECK(last(R"({"markers":{"a":null}})") == 4);
    CHECK(last(R"({"markers":{"b":null}})") == 3);
    CHECK(last(R"({"markers":null})") == 4);
    CHECK(last(R"({"markers":{"c":{"point":[0,0,0]}}})") == 0);
    step(R"({"markers":{"b":null}})");  // 6
    CHECK(last(R"({"markers":{"b":{"point":[0,0,0]}}})") == 6);
    CHECK(last(R"({"markers":{"b":null}})") == 6);
    CHECK(last(R"({"markers":{"a":null}})") == 4);
    CHECK(last(R"({"markers":null})") == 6);
    step(R"({"markers":{"b":{"point":[1,2,3]}}})");  // 7
    CHECK(last(R"({"markers":{"b":{"text":"y"}}})") == 7);
    // Members of entries come and go as well.
    step(R"({"nodes":{"5":{"active":false,"material":3}}})");  // 8
    step(R"({"nodes":{"5":{"material":null}}})");              // 9
    CHECK(last(R"({"nodes":{"5":{"active":true}}})") == 8);
    CHECK(last(R"({"nodes":{"5":{"material":4}}})") == 9);
    CHECK(last(R"({"nodes":{"6":{"material":4}}})") == 0);
    state.recording = RecordingState{"log"};
    document = StateDocument::next(*document, state);  // 10
    CHECK(last(R"({"recording":null})") == 10);
    state.recording.reset();
    document = StateDocument::next(*document, state);  // 11
    CHECK(last(R"({"recording":{"name":"x"}})") == 11);
}

TEST_CASE("names that come and go by the thousand are forgotten, on the safe side") {
    State state = start();
    state = after(state, R"({"markers":{"stays":{"point":[0,0,0]}}})");
    auto document = StateDocument::next({}, state);
    for (int i = 0; i < 2500; ++i) {
        const std::string name = "m" + std::to_string(i);
        State with = state;
        with.markers.set(name, {{1, 2, 3}, {}, ""});
        document = StateDocument::next(*StateDocument::next(*document, with), state);
    }
    CHECK(document->revision() == 5'001);
    const auto last = [&](const std::string& name) {
        return document->last_change({{"markers", {{name, {{"point", {0, 0, 0}}}}}}});
    };
    CHECK(last("stays") == 1);
    CHECK(last("m2499") == 5'001);
    // Never earlier than it was: m0 went with revision 3.
    for (const int i : {0, 1, 500, 999, 1000, 1001, 2000, 2498}) {
        INFO(i);
        CHECK(last("m" + std::to_string(i)) >= 2 * i + 3);
    }
    // The document itself holds nothing of them.
    CHECK(document->json()["markers"].size() == 1);
}

TEST_CASE("which members of the camera a patch names") {
    using Flags = std::array<bool, 6>;
    const auto named = [](const json& patch) {
        const NamedCameraMembers n = named_camera_members(patch);
        return Flags{n.node, n.eye, n.focus, n.up, n.center, n.fov};
    };
    const char* members[] = {"node", "eye", "focus", "up", "center", "fov"};
    for (std::size_t i = 0; i < 6; ++i) {
        Flags expected{};
        expected[i] = true;
        CHECK(named({{"camera", {{members[i], 1}}}}) == expected);
        CHECK(named({{"camera", {{members[i], nullptr}}}}) == expected);
    }
    CHECK(named({{"camera", nullptr}}) == Flags{true, true, true, true, true, true});
    for (const char* patch : {"{}", R"({"camera":{}})", R"({"camera":5})", "[]", R"({"views":{"eye":1}})"})
        CHECK(named(json::parse(patch)) == Flags{});
}

TEST_CASE("a camera file is the state's camera, or part of it") {
    const auto camera = parse_camera(R"({"eye":[1,2,3],"near":5,"viewMatrix":[1],"fov":20})");
    REQUIRE(camera.has_value());
    CHECK(camera->eye == glm::dvec3(1, 2, 3));
    CHECK_FALSE(camera->focus.has_value());
    CHECK_FALSE(camera->node.has_value());
    CHECK(camera->fov == 20);
    CHECK_FALSE(parse_camera(R"({"eye":1})").has_value());
    CHECK_FALSE(parse_camera(R"({"fov":0})").has_value());
    CHECK_FALSE(parse_camera("[]").has_value());
    CHECK_FALSE(parse_camera("").has_value());
}

TEST_CASE("a token file holds a token of some length") {
    const auto tokens = parse_tokens(R"({"control":"0123456789abcdef","view":"fedcba9876543210"})");
    REQUIRE(tokens.has_value());
    CHECK(tokens->control == "0123456789abcdef");
    CHECK(tokens->view == "fedcba9876543210");
    CHECK(parse_tokens(R"({"view":"fedcba9876543210"})").has_value());
    for (const char* text : {"", "{}", "[]", R"({"control":"short"})", R"({"control":5})"})
        CHECK_FALSE(parse_tokens(text).has_value());
}
