#include "state.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tokens.hpp"

using namespace vrut::protocol;
using nlohmann::json;

namespace {

State start() {
    State state;
    state.scene.name = "car";
    state.scene.notices = {"one"};
    state.lights.items["headlight"] = {"Headlight", "point", {1, 1, 1, 1}, {1, 0, 0}};
    state.backgrounds.items["11"] = {"Studio", {0.5, 0.5, 0.5, 1}};
    return state;
}

State after(const State& state, const char* patch) {
    auto result = patched(state, start(), json::parse(patch));
    REQUIRE_MESSAGE(result.has_value(), result.error().message);
    return *result;
}

Error refusal(const char* patch) {
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
        R"({"lights":{"items":{"headlight":{"color":[1,0.5,0,1]}}}})",
        R"({"lights":{"items":{"headlight":{"attenuation":[1,0.5,0]}}}})",
        R"({"backgrounds":{"active":"11"}})",
        R"({"backgrounds":{"color":[0,0,0,1]}})",
        R"({"backgrounds":{"items":{"11":{"color":[0,0,0,1]}}}})",
        R"({"selection":{"node":5}})",
    };
    for (const char* patch : patches) {
        INFO(patch);
        const State changed = after(start(), patch);
        CHECK(changed != start());
        // The innermost value becomes null; then its section; then each section alone.
        json reset = json::parse(patch);
        json* innermost = &reset;
        while (innermost->is_object()) innermost = &innermost->begin().value();
        *innermost = nullptr;
        CHECK(after(changed, reset.dump().c_str()) == start());
        reset.begin().value() = nullptr;
        CHECK(after(changed, reset.dump().c_str()) == start());
    }
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
        INFO(c.patch);
        const Error error = refusal(c.patch);
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

TEST_CASE("a camera file is the state's camera, or part of it") {
    const CameraState base = start().camera;
    const auto camera = parse_camera(R"({"eye":[1,2,3],"near":5,"viewMatrix":[1],"fov":20})", base);
    REQUIRE(camera.has_value());
    CHECK(camera->eye == glm::dvec3(1, 2, 3));
    CHECK(camera->focus == base.focus);
    CHECK(camera->near == base.near);
    CHECK(camera->fov == 20);
    CHECK_FALSE(parse_camera(R"({"eye":1})", base).has_value());
    CHECK_FALSE(parse_camera("[]", base).has_value());
    CHECK_FALSE(parse_camera("", base).has_value());
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
