#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "state.hpp"

/// Examples of messages, which the JSON Schema's test in tests/web judges as well.
namespace examples {

/// `valid`: messages, none with a member that has its default. `members`: for each type an example with every
/// member, and what each may be. `invalid`: texts with the error's code and what its message names; where
/// `schema` is "accepts", a schema cannot tell.
inline const nlohmann::json& messages() {
    static const nlohmann::json all = [] {
        std::ifstream file(VRUT_TEST_DATA "/messages.json");
        return nlohmann::json::parse(file);
    }();
    return all;
}

/// The state on which the patches in there are tried.
inline vrut::protocol::State make_start() {
    vrut::protocol::State state;
    auto scene = std::make_shared<vrut::protocol::SceneState>();
    scene->name = "car";
    scene->notices = {{"scene", "one"}};
    state.scene.value = scene;
    state.lights.items.set("headlight", {"Headlight", "point", {1, 1, 1, 1}, {1, 0, 0}});
    state.lights.items.set("7", {"Sun", "directional", {1, 1, 0.5, 1}, {1, 0.25, 0}});
    state.backgrounds.items.set("11", {"Studio", {0.5, 0.5, 0.5, 1}, {}});
    state.views.set("home", {{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, {0, 0, 0}, 40}, {}});
    return state;
}
/// The same each time, with the same scene.
inline const vrut::protocol::State& start() {
    static const vrut::protocol::State state = make_start();
    return state;
}

}  // namespace examples
