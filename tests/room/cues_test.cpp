// Cues: what a presentation shows.
#include "stage.hpp"

using namespace stage;

namespace {

/// The door stands open in "Open", and its leaf is hidden in "Bare"; both are seen from other places.
constexpr const char* kCues = R"({"type":"patch","id":1,"patch":{"cues":{
    "Closed":{"order":1,"ms":1000},
    "Open":{"order":2,"ms":1000,"camera":{"eye":[4,0,8]},
            "nodes":{"1":{"matrix":[0,0,1,0, 0,1,0,0, -1,0,0,0, 0,0,0,1]}},"selection":{"node":2}},
    "Bare":{"order":3,"ms":0,"camera":{"eye":[-4,0,8],"fov":20},"nodes":{"2":{"active":false}},
            "backgrounds":{"color":[1,0,0,1]},"sections":{"cut":{"normal":[0,0,2],"distance":0.25}}}}}})";

std::string show(const std::string& name) { return json{{"type", "cue"}, {"id", 5}, {"name", name}}.dump(); }
std::string step(int steps) { return json{{"type", "cue"}, {"id", 6}, {"step", steps}}.dump(); }

/// Where the door's outer edge is; closed it is (1, 0, 0), open (0, 0, -1).
glm::dvec3 edge_of_door(const Stage& stage) {
    return glm::dvec3(stage.room.scene().world[1] * glm::dvec4(1, 0, 0, 1));
}
std::string shown_cue(Stage& stage) { return stage.state().value("cue", json{{"name", ""}})["name"]; }

struct WithCues : Stage {
    WithCues() : Stage("ab", scene_with_a_door()) { REQUIRE(rejection("a", kCues) == ""); }
};

}  // namespace

TEST_CASE("cues: a new one is what is shown, but for what it gives") {
    WithCues stage;
    const json closed = stage.state()["cues"]["Closed"];
    CHECK(closed["camera"]["eye"] == json{0.5, 0, 8});
    CHECK(closed["nodes"].empty());
    CHECK(closed["selection"].empty());
    stage.say("a", R"({"type":"patch","patch":{"nodes":{"3":{"active":false}},"selection":{"node":3}}})");
    stage.say("a",
              R"({"type":"patch","patch":{"camera":{"fov":33},"cues":{"New":{},"Given":{"nodes":{}}}}})");
    const json cues = stage.state()["cues"];
    CHECK(cues["New"]["nodes"] == json{{"3", {{"active", false}}}});
    CHECK(cues["New"]["selection"] == json{{"node", 3}});
    CHECK(cues["New"]["camera"]["fov"] == 33);
    CHECK(cues["Given"]["nodes"].empty());
    CHECK(cues["Given"]["selection"] == json{{"node", 3}});
}

TEST_CASE("cues: null takes what is shown, and in a table it removes") {
    WithCues stage;
    stage.say("a", R"({"type":"patch","patch":{"camera":{"fov":33}}})");
    stage.say("a", R"({"type":"patch","patch":{"cues":{"Open":{"camera":null,"selection":{"node":null}},
        "Bare":{"nodes":{"2":null}}}}})");
    const json cues = stage.state()["cues"];
    CHECK(cues["Open"]["camera"]["fov"] == 33);
    CHECK(cues["Open"]["selection"].empty());
    CHECK(cues["Open"]["nodes"].size() == 1);
    CHECK(cues["Bare"]["nodes"].empty());
}

TEST_CASE("cues: null removes an entry of a cue's table, whatever is shown") {
    WithCues stage;
    stage.say("a", show("Bare"));
    stage.say("a", R"({"type":"patch","patch":{"selection":{"node":3}}})");
    stage.say("a", R"({"type":"patch","patch":{"cues":{"Open":{"selection":{"node":null}},
        "Bare":{"nodes":{"2":null},"sections":{"cut":null}}}}})");
    const json cues = stage.state()["cues"];
    CHECK(cues["Open"]["selection"].empty());
    CHECK(cues["Bare"]["nodes"].empty());
    CHECK(cues["Bare"]["sections"].empty());
}

TEST_CASE("cues: the camera flies there, the door swings, and all else changes at once") {
    WithCues stage;
    CHECK(stage.rejection("a", show("Open")) == "");
    CHECK(shown_cue(stage) == "Open");
    CHECK(stage.state()["selection"]["name"] == "Leaf");
    CHECK(stage.state()["swings"] == json{{"1", {{"to", 1}}}});
    stage.at(500ms);
    CHECK(near_to(edge_of_door(stage), {std::sqrt(0.5), 0, -std::sqrt(0.5)}));
    CHECK(stage.camera().eye.x > 1);
    CHECK(stage.camera().eye.x < 4);
    stage.at(1000ms);
    CHECK(near_to(edge_of_door(stage), {0, 0, -1}));
    CHECK(stage.camera().eye == glm::dvec3(4, 0, 8));
    const json flown = stage.told().at(0);
    CHECK(flown["type"] == "flown");
    CHECK(flown["id"] == 5);
    CHECK(flown["completed"] == true);

    CHECK(stage.rejection("a", show("Bare")) == "");  // at once
    CHECK(stage.camera().eye == glm::dvec3(-4, 0, 8));
    CHECK(stage.camera().fov == 20);
    CHECK(edge_of_door(stage) == glm::dvec3(1, 0, 0));
    CHECK_FALSE(stage.room.moves());
    const json state = stage.state();
    CHECK(state["nodes"] == json{{"2", {{"active", false}}}});
    CHECK(state["sections"]["cut"]["normal"] == json{0, 0, 1});
    CHECK(state["backgrounds"]["color"] == json{1, 0, 0, 1});
    CHECK_FALSE(state["selection"].contains("node"));
}

TEST_CASE("cues: one may be seen from another place than its own, which stays") {
    WithCues stage;
    const json before = stage.state()["cues"];
    CHECK(stage.rejection("a", R"({"type":"cue","id":7,"name":"Bare","camera":{"eye":[0,3,9]}})") == "");
    CHECK(stage.camera().eye == glm::dvec3(0, 3, 9));
    CHECK(stage.camera().fov == 20);
    CHECK(stage.state()["cues"] == before);
    CHECK(stage.rejection("a", R"({"type":"cue","id":8,"name":"Open","camera":{"eye":[0.5,0,0]}})") ==
          "out-of-range");
    CHECK(shown_cue(stage) == "Bare");
    CHECK_FALSE(stage.room.moves());
}

TEST_CASE("cues: a picture from another place and the cue from there have one camera") {
    WithCues stage;
    stage.say("a", R"({"type":"patch","patch":{"cues":{"Bare":{"camera":{"eye":[-4,3,8],"up":[0,1,0]}}}}})");
    const json camera{{"eye", {0, 3, 9}}};
    stage.say(
        "b",
        json{
            {"type", "snapshot"}, {"id", 9}, {"width", 4}, {"height", 3}, {"cue", "Bare"}, {"camera", camera}}
            .dump());
    const std::vector<PictureOrder> orders = stage.room.take_orders();
    REQUIRE(orders.size() == 1);
    REQUIRE(stage.rejection(
                "a", json{{"type", "cue"}, {"id", 7}, {"name", "Bare"}, {"camera", camera}}.dump()) == "");
    CHECK(stage.camera().eye == orders[0].view.camera.eye);
    CHECK(near_to(stage.camera().up, orders[0].view.camera.up));
}

TEST_CASE("cues: the next and the one before, by their order") {
    WithCues stage;
    CHECK(stage.rejection("a", step(-1)) == "unknown-cue");
    for (const char* name : {"Closed", "Open", "Bare"}) {
        CHECK(stage.rejection("a", step(1)) == "");
        CHECK(shown_cue(stage) == name);
    }
    CHECK(stage.rejection("a", step(1)) == "unknown-cue");
    CHECK(shown_cue(stage) == "Bare");
    CHECK(stage.rejection("a", step(-2)) == "");
    CHECK(shown_cue(stage) == "Closed");
}

TEST_CASE("cues: one that is shown during another's flight begins where things stand") {
    WithCues stage;
    stage.say("a", show("Open"));
    stage.at(500ms);
    const glm::dvec3 eye = stage.camera().eye, edge = edge_of_door(stage);
    stage.told();
    stage.say("a", show("Closed"));
    CHECK(stage.told().at(0)["completed"] == false);
    CHECK(stage.camera().eye == eye);
    CHECK(near_to(edge_of_door(stage), edge));
    stage.at(1000ms);
    CHECK(edge_of_door(stage).z < -0.1);
    stage.at(1500ms);
    CHECK(stage.camera().eye == glm::dvec3(0.5, 0, 8));
    CHECK(edge_of_door(stage) == glm::dvec3(1, 0, 0));
    CHECK(stage.state()["nodes"].empty());
}

TEST_CASE("cues: one that takes no time ends what swings") {
    WithCues stage;
    stage.say("a", show("Closed"));
    stage.say("a", R"({"type":"swing","node":1,"open":1})");
    REQUIRE(stage.state()["swings"].size() == 1);
    stage.say("a", show("Bare"));
    CHECK(stage.state()["swings"].empty());
    stage.at(3000ms);
    CHECK(stage.state()["swings"].empty());
}

TEST_CASE("cues: who steers stops the flight, and the door goes on") {
    WithCues stage;
    stage.say("a", show("Open"));
    stage.at(500ms);
    stage.say("a", R"({"type":"navigate","pan":[0,0.1]})");
    const glm::dvec3 eye = stage.camera().eye;
    stage.at(1000ms);
    CHECK(stage.camera().eye == eye);
    CHECK(near_to(edge_of_door(stage), {0, 0, -1}));
}

TEST_CASE("cues: the shown one stays it under a new name, and else gives way to the one before") {
    WithCues stage;
    stage.say("a", show("Open"));
    json renamed = stage.state()["cues"]["Open"];
    stage.say("a",
              json{{"type", "patch"}, {"patch", {{"cues", {{"Open", nullptr}, {"Wide", renamed}}}}}}.dump());
    CHECK(shown_cue(stage) == "Wide");
    stage.say("a", R"({"type":"patch","patch":{"cues":{"Wide":null}}})");
    CHECK(shown_cue(stage) == "Closed");
    CHECK(stage.rejection("a", step(1)) == "");
    CHECK(shown_cue(stage) == "Bare");
    stage.say("a", R"({"type":"patch","patch":{"cues":null}})");
    CHECK(shown_cue(stage) == "");
    CHECK(stage.rejection("a", step(1)) == "unknown-cue");
}

TEST_CASE("cues: what does not go with the scene is refused, and nothing changes") {
    WithCues stage;
    const json before = stage.state();
    const auto patch = [](const std::string& cue) {
        return R"({"type":"patch","id":7,"patch":{"cues":{"New":)" + cue + "}}}";
    };
    CHECK(stage.rejection("a", patch(R"({"selection":{"node":99}})")) == "unknown-node");
    CHECK(stage.rejection("a", patch(R"({"nodes":{"99":{}}})")) == "unknown-node");
    CHECK(stage.rejection("a", patch(R"({"nodes":{"3":{"activeChild":0}}})")) == "out-of-range");
    CHECK(stage.rejection("a", patch(R"({"lights":{"active":"99"}})")) == "unknown-node");
    CHECK(stage.rejection("a", patch(R"({"backgrounds":{"active":"99"}})")) == "unknown-node");
    CHECK(stage.rejection("a", patch(R"({"camera":{"eye":[1,1,1],"focus":[1,1,1]}})")) == "out-of-range");
    CHECK(stage.rejection("a", patch(R"({"sections":{"cut":{"normal":[0,0,0]}}})")) == "out-of-range");
    CHECK(stage.rejection("a", patch(R"({"sectionBox":{"min":[5,5,5],"max":[1,1,1]}})")) == "out-of-range");
    CHECK(stage.rejection("a", patch("5")) == "bad-message");
    CHECK(stage.rejection("a", show("None")) == "unknown-cue");
    CHECK(stage.rejection("a", R"({"type":"cue","id":8})") == "bad-message");
    CHECK(stage.rejection("a", R"({"type":"cue","id":8,"name":"Open","step":1})") == "bad-message");
    CHECK(stage.rejection("b", show("Open")) == "not-in-control");
    CHECK(stage.state() == before);
}

TEST_CASE("cues: at most 100, and 10,000 entries of nodes in all of them") {
    Stage stage("a", scene_with_a_door());
    json cues = json::object();
    for (int i = 0; i < 100; ++i) cues["c" + std::to_string(i)] = json::object();
    const auto patch = [](const json& added) {
        return json{{"type", "patch"}, {"id", 1}, {"patch", {{"cues", added}}}}.dump();
    };
    CHECK(stage.rejection("a", patch(cues)) == "");
    CHECK(stage.rejection("a", patch({{"one more", json::object()}})) == "too-many");
    CHECK(stage.state()["cues"].size() == 100);
}

TEST_CASE("cues: another scene has its own") {
    WithCues stage;
    stage.say("a", show("Open"));
    stage.room.show(other_scene(), stage.now);
    CHECK(stage.state()["cues"].empty());
    CHECK(shown_cue(stage) == "");
}

TEST_CASE("cues: they are kept with the scene") {
    WithCues stage;
    const std::string changes = stage.room.changes();
    LoadedScene again = scene_with_a_door();
    again.changes = changes;
    Stage later("a", std::move(again));
    CHECK(later.state()["cues"] == stage.state()["cues"]);
    CHECK(later.room.changes() == changes);
}

TEST_CASE("cues: a picture of one shows it to nobody else") {
    WithCues stage;
    const json before = stage.state();
    CHECK(stage.rejection("b", R"({"type":"snapshot","id":9,"width":32,"height":18,"cue":"Bare"})") == "");
    const std::vector<PictureOrder> orders = stage.room.take_orders();
    REQUIRE(orders.size() == 1);
    CHECK(orders[0].view.camera.eye == glm::dvec3(-4, 0, 8));
    CHECK(orders[0].view.background.color == glm::dvec3(1, 0, 0));
    CHECK(orders[0].view.clip_planes.size() == 1);
    const scene::PlacedScene& placed = *orders[0].view.scene;
    CHECK_FALSE(placed.nodes[static_cast<std::size_t>(placed.scene->find_node(2))].active);
    CHECK(stage.state() == before);
    for (const char* id : {R"("id":10,)", ""})
        CHECK(stage.rejection("b", R"({"type":"snapshot",)" + std::string(id) +
                                       R"("width":32,"height":18,"cue":"None"})") == "unknown-cue");
}

TEST_CASE("cues: pictures of the same nodes that wait have one scene, and without an id there is none") {
    WithCues stage;
    const auto snapshot = [](const char* id, const char* cue) {
        return R"({"type":"snapshot",)" + std::string(id) + R"("width":4,"height":3,"cue":")" + cue + "\"}";
    };
    for (const char* cue : {"Bare", "Open", "Bare"})
        REQUIRE(stage.rejection("b", snapshot(R"("id":9,)", cue)) == "");
    REQUIRE(stage.rejection("b", snapshot("", "Bare")) == "");
    const std::vector<PictureOrder> orders = stage.room.take_orders();
    REQUIRE(orders.size() == 3);
    CHECK(orders[0].view.scene == orders[2].view.scene);
    CHECK(orders[0].view.scene != orders[1].view.scene);
    stage.say("a", R"({"type":"patch","patch":{"cues":{"Bare":{"nodes":{"2":null}}}}})");
    REQUIRE(stage.rejection("b", snapshot(R"("id":9,)", "Bare")) == "");
    CHECK(stage.room.take_orders().at(0).view.scene.get() == &stage.room.scene());
}

TEST_CASE("cues: all that is wrong with a list, a sentence each") {
    WithCues stage;
    stage.told();
    const json cues{{"Good", {{"order", 1}}},
                    {"Bad", {{"selection", {{"node", 99}}}, {"lights", {{"active", "8"}}}}},
                    {"Nodes", {{"nodes", {{"77", {{"active", false}}}, {"3", {{"material", 5}}}}}}},
                    {"None", 5},
                    {"Odd", {{"ms", -1}}}};
    json list{{"format", "vrut-preview-cues"}, {"version", 1}, {"scene", "other.vrut"}, {"cues", cues}};
    const auto check = [&](const std::vector<std::string>& expected) {
        stage.say("b", json{{"type", "check"}, {"id", 11}, {"cues", list}}.dump());
        std::vector<std::string> sentences;
        const std::vector<json> answers = stage.told();
        CAPTURE(json(answers).dump());
        for (const json& problem : answers.at(0)["problems"])
            sentences.push_back(problem.value("cue", "") + ": " + problem["message"].get<std::string>());
        for (const std::string& sentence : sentences)
            CHECK_MESSAGE(std::ranges::count(expected, sentence) == 1, sentence);
        CHECK(sentences.size() == expected.size());
        return answers.at(0)["fitting"];
    };
    CHECK(check({": the list was made for 'other.vrut', and this is 'door.vrut'",
                 "Bad: 'cues.Bad.lights.active': there is no light '8'",
                 "Bad: 'cues.Bad.selection.node': there is no node 99",
                 "Nodes: 'cues.Nodes.nodes.3.material': there is no material 5",
                 "Nodes: 'cues.Nodes.nodes': there is no node 77", "None: 'cues.None' must be an object",
                 "Odd: 'cues.Odd.ms' must be a number from 0.0 to 60000.0"}) == json{"Good"});
    list["scene"] = "cars/door.vrut";  // of a server whose folder it is in
    list["cues"] = {{"Good", json::object()}};
    CHECK(check({}) == json{"Good"});
    list["version"] = 2;
    CHECK(
        check({": the list is of version 2, and this program reads version 1: use a newer program"}).empty());
    list = {{"format", "vrut-preview-cues"}, {"version", 1}, {"cues", {{"Good", json::object()}}}};
    CHECK(check({}) == json{"Good"});
    CHECK_FALSE(stage.state()["cues"].contains("Good"));
}

TEST_CASE("cues: a recording whose cues do not go with the scene is refused") {
    WithCues stage;
    const auto checkpoint = stage.room.checkpoint();
    REQUIRE(checkpoint);
    RoomOptions options;
    options.policy = kReplay;
    Stage replay("", other_scene(), options);
    const auto restored = replay.room.restore(checkpoint->header);
    REQUIRE_FALSE(restored);
    CHECK(restored.error().message == "'cues.Bare.nodes': there is no node 2");
}

TEST_CASE("cues: a recording that begins in a presentation replays to the same") {
    WithCues stage;
    stage.say("a", show("Closed"));
    stage.at(2000ms);
    const auto checkpoint = stage.room.checkpoint();
    REQUIRE(checkpoint);
    RoomOptions options;
    options.policy = kReplay;
    Stage replay("", scene_with_a_door(), options);
    REQUIRE(replay.room.restore(checkpoint->header));
    for (Stage* each : std::initializer_list<Stage*>{&stage, &replay}) {
        each->now = 2000ms;
        each->say("a", step(1));
        for (SessionTime at = 2100ms; at <= 3200ms; at += 100ms) each->at(at);
    }
    CHECK(shown_cue(replay) == "Open");
    CHECK(replay.camera() == stage.camera());
    CHECK(replay.state()["nodes"] == stage.state()["nodes"]);
}
