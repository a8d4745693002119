// What a report reads of a state's document.
#include "reported_state.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "state_document.hpp"

using namespace vrut::protocol;
using nlohmann::json;

namespace {

std::shared_ptr<const StateDocument> document_of_text(const char* patch) {
    State state;
    SceneState scene;
    scene.file = "cars/car.vrut";
    state.scene.value = std::make_shared<const SceneState>(scene);
    state.lights.items.set("headlight", {});
    state.views.set("home", {});
    const auto patched_state = patched(state, state, json::parse(patch));
    REQUIRE_MESSAGE(patched_state.has_value(), patched_state.error().message);
    State now = *patched_state;
    now.measured.set("Gap", {2.5, {}, {}, {}});
    return StateDocument::next({}, now);
}

}  // namespace

TEST_CASE("a report reads notes, views, cues and measures of a document, sent or own") {
    const auto own = document_of_text(R"({
        "markers":{"n":{"point":[1,2,3],"author":"Bea","time":7,"done":true}},
        "views":{"side":{"order":1},"a":{}},
        "cues":{"Last":{},"First":{"order":2,"text":"Hello"}},
        "measures":{"Gap":{"kind":"length","picks":[{"node":3,"snap":"edge","points":[[1,2,3],[0,0,0],[4,5,6]]}]}},
        "unit":{"metres":1}})");
    const auto sent = StateDocument::received(own->encode(), nullptr);
    REQUIRE(sent.has_value());
    for (const StateDocument* document : {own.get(), sent->get()}) {
        const auto state = reported_state(*document);
        REQUIRE(state.has_value());
        CHECK(state->scene == "cars/car.vrut");
        CHECK(state->notes.at("n") == Marker{{1, 2, 3}, {}, "", "Bea", 7, {}, true});
        REQUIRE(state->views.size() == 3);
        CHECK(state->views[0].name == "side");
        CHECK(state->views[1].name == "a");
        CHECK(state->views[1].camera->fov == 40);
        REQUIRE(state->cues.size() == 2);
        CHECK(state->cues[0].text == "Hello");
        CHECK(state->cues[1].name == "Last");
        REQUIRE(state->measures.size() == 1);
        CHECK(state->measures[0].kind == MeasureKind::length);
        CHECK(state->measures[0].measured.value == 2.5);
        CHECK(state->unit.metres == 1);
    }
}

TEST_CASE("a report without a document has nothing, and one that cannot be read says why") {
    CHECK(reported_state(StateDocument()).value().notes.empty());
    const auto bad = StateDocument::received(
        R"({"type":"state","revision":1,"state":{"markers":{"n":{"point":[1,2]}}}})", nullptr);
    REQUIRE(bad.has_value());
    CHECK_FALSE(reported_state(**bad).has_value());
}
