#include "cue_list.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "repository_files.hpp"

using namespace vrut::protocol;
using nlohmann::json;

namespace {

State starting() {
    State state;
    state.lights.items.set("headlight", {});
    return state;
}

}  // namespace

TEST_CASE("cues follow each other by their order, then by name") {
    SharedMap<CueState> cues;
    const auto add = [&](const char* name, std::optional<double> order) {
        CueState cue;
        cue.order = order;
        cues.set(name, cue);
    };
    add("a", {});
    add("b", 3);
    add("c", -1);
    add("d", 3);
    add("B", {});
    CHECK(names_in_order(cues) == std::vector<std::string>{"c", "b", "d", "B", "a"});
    CHECK(names_in_order({}).empty());
}

TEST_CASE("the example of a list in the pages is one") {
    const std::string page = text_of(kProtocol + "CUES.md");
    const std::size_t text = page.find('\n', page.find("```json cues")) + 1;
    const auto list = parse_cue_list(page.substr(text, page.find("```", text) - text), starting());
    REQUIRE_MESSAGE(list.has_value(), list.error().message);
    CHECK(list->scene == "stage.vrut");
    REQUIRE(list->cues.size() == 2);
    REQUIRE(list->cues.at("Arrival").has_value());
    CHECK(list->cues.at("Arrival")->ms == 2000);
    REQUIRE(list->cues.at("Door").has_value());
    CHECK(list->cues.at("Door")->nodes->at("5").active == false);
}

TEST_CASE("what is no list is refused with what is wrong") {
    const auto problem = [](const char* text) {
        const auto list = parse_cue_list(text, starting());
        REQUIRE_FALSE(list.has_value());
        return list.error().message;
    };
    CHECK(problem("[]") == "'the list' must be an object");
    CHECK(problem("{") != "");
    CHECK(problem(R"({"version": 1, "cues": {}})") == "member 'format' is missing");
    CHECK(problem(R"({"format": "vrut-preview-cues", "version": 3})") ==
          "the list is of version 3, and this program reads version 1: use a newer program");
    CHECK(problem(R"({"format": "vrut-preview-cues", "version": 0, "cues": {}})") ==
          "'version' must be an integer from 1 to 1");
    json many{{"format", "vrut-preview-cues"}, {"version", 1}, {"cues", json::object()}};
    for (int i = 0; i <= 100; ++i) many["cues"][std::to_string(i)] = json::object();
    CHECK(problem(many.dump().c_str()) == "'cues' holds 100 entries at most");
}
