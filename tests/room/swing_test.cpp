// What turns about a hinge, by a message or a tap.
#include "stage.hpp"

using namespace stage;

namespace {

constexpr const char* kSwing = R"({"type":"swing","id":1,"node":1})";

/// Where the door's outer edge is; closed it is (1, 0, 0), open (0, 0, -1).
glm::dvec3 edge(const Stage& stage) {
    return glm::dvec3(stage.room.scene().world[1] * glm::dvec4(1, 0, 0, 1));
}
bool is_open(const Stage& stage) { return near_to(edge(stage), {0, 0, -1}); }
bool is_closed(const Stage& stage) { return edge(stage) == glm::dvec3(1, 0, 0); }

std::string touch(const char* what, double x, double y) {
    return json{{"type", std::string("pointer") + what},
                {"pointerId", 1},
                {"pointerType", "touch"},
                {"x", x},
                {"y", y},
                {"button", 0},
                {"buttons", std::string(what) == "up" ? 0 : 1}}
        .dump();
}
void tap(Stage& stage, double x = 640, double y = 360) {
    stage.say("a", touch("down", x, y));
    stage.say("a", touch("up", x, y));
}
constexpr const char* kTapSwings = R"({"type":"patch","patch":{"navigation":{"tapSwings":true}}})";

}  // namespace

TEST_CASE("a message opens what hinges, in its time, and the next one closes it") {
    Stage stage("a", scene_with_a_door());
    stage.say("a", kSwing);
    CHECK(stage.told().at(0)["type"] == "ok");
    CHECK(stage.room.moves());
    CHECK(stage.state()["swings"] == json{{"1", {{"to", 1}}}});
    stage.at(350ms);
    CHECK(near_to(edge(stage), {std::sqrt(0.5), 0, -std::sqrt(0.5)}));
    stage.at(700ms);
    CHECK(is_open(stage));
    CHECK_FALSE(stage.room.moves());
    CHECK(stage.state()["swings"].empty());
    CHECK(stage.state()["nodes"]["1"].contains("matrix"));
    stage.say("a", kSwing);
    stage.at(1400ms);
    CHECK(is_closed(stage));
    CHECK(stage.state()["nodes"].empty());
}

TEST_CASE("a part of it will do, and how far and how fast may be said") {
    Stage stage("a", scene_with_a_door());
    CHECK(stage.rejection("a", R"({"type":"swing","id":1,"node":2,"open":0.5,"ms":0})") == "");
    CHECK(near_to(edge(stage), {std::sqrt(0.5), 0, -std::sqrt(0.5)}));
    CHECK_FALSE(stage.room.moves());
    CHECK(stage.rejection("a", R"({"type":"swing","id":2,"node":1,"open":1,"ms":1000})") == "");
    stage.at(499ms);
    CHECK(stage.room.moves());
    stage.at(500ms);  // half the way
    CHECK(is_open(stage));
}

TEST_CASE("it turns about its axis, by the right-hand rule, in its own space") {
    Stage stage("a", scene_of(R"(vrut-text 1
node 0 "Room" root end
node 1 "Moved" assembly parent 0 hinge 0 1 0 90  matrix 1 0 0 0.8  0 1 0 0.6  0 0 1 0.7  0 0 0 1 end
node 2 "Half" assembly parent 0 hinge 1 0 0 90  matrix 1 0 0 0.8  0 1 0 0.6  0 0 1 0.7  0 0 0 1 end
node 3 "Mirrored" assembly parent 0 hinge 0 0 1 -270  matrix -2 0 0 -0.8  0 0 3 0.6  0 1 0 0.7  0 0 0 1 end
)",
                              "hinges.vrut"));
    const auto matrix_of = [&](int node, double open) {
        stage.say("a", json{{"type", "swing"}, {"node", node}, {"open", open}, {"ms", 0}}.dump());
        return stage.state()["nodes"][std::to_string(node)]["matrix"].get<std::vector<double>>();
    };
    const auto check = [](const std::vector<double>& matrix, const std::vector<double>& expected) {
        REQUIRE(matrix.size() == 16);
        for (std::size_t i = 0; i < 16; ++i) CHECK(matrix[i] == doctest::Approx(expected[i]).epsilon(1e-12));
    };
    const double half = std::sqrt(0.5);
    check(matrix_of(1, 1), {0, 0, 1, 0.8, 0, 1, 0, 0.6, -1, 0, 0, 0.7, 0, 0, 0, 1});
    check(matrix_of(2, 0.5), {1, 0, 0, 0.8, 0, half, -half, 0.6, 0, half, half, 0.7, 0, 0, 0, 1});
    check(matrix_of(3, 1), {0, 2, 0, -0.8, 0, 0, 3, 0.6, 1, 0, 0, 0.7, 0, 0, 0, 1});
    // From where a patch has left it, also beyond half a turn.
    stage.say("a", R"({"type":"swing","node":3,"open":0.5,"ms":1000})");
    stage.at(250ms);
    const auto on_its_way = stage.state()["nodes"]["3"]["matrix"].get<std::vector<double>>();
    check(on_its_way, matrix_of(3, 0.75));
}

TEST_CASE("on its way it turns back from where it is") {
    Stage stage("a", scene_with_a_door());
    stage.say("a", kSwing);
    stage.at(350ms);
    const glm::dvec3 half = edge(stage);
    stage.say("a", kSwing);
    CHECK(near_to(edge(stage), half));
    CHECK(stage.state()["swings"]["1"]["to"] == 0);
    stage.at(700ms);
    CHECK(is_closed(stage));
}

TEST_CASE("what does not turn is refused in a sentence") {
    Stage stage("ab", scene_with_a_door());
    CHECK(stage.rejection("a", R"({"type":"swing","id":1,"node":77})") == "unknown-node");
    CHECK(stage.rejection("a", R"({"type":"swing","id":1,"node":3})") == "failed");
    CHECK(stage.rejection("b", kSwing) == "not-in-control");
    CHECK_FALSE(stage.room.moves());
}

TEST_CASE("a matrix that a patch gives ends the way there; any other patch does not") {
    Stage stage("a", scene_with_a_door());
    stage.say("a", kSwing);
    stage.at(100ms);
    stage.say("a", R"({"type":"patch","patch":{"renderer":{"wireframe":true}}})");
    CHECK(stage.room.moves());
    stage.say("a", R"({"type":"patch","patch":{"nodes":null}})");
    CHECK_FALSE(stage.room.moves());
    CHECK(stage.state()["swings"].empty());
    stage.at(1s);
    CHECK(is_closed(stage));
}

TEST_CASE("it does not stop a flight, and a camera on the door moves with it") {
    Stage stage("a", scene_with_a_door());
    stage.say("a", R"({"type":"fly","id":9,"keyframes":[{"at":1000,"camera":{"eye":[1,0,4]}}]})");
    stage.say("a", kSwing);
    stage.at(500ms);
    CHECK(stage.room.flies());
    stage.at(1s);
    stage.say("a", R"({"type":"patch","patch":{"camera":{"node":5}}})");
    const glm::dvec3 before = stage.camera().eye;
    stage.say("a", R"({"type":"swing","id":1,"node":1,"open":0,"ms":0})");
    CHECK_FALSE(near_to(stage.camera().eye, before));
    CHECK(near_to(stage.camera().eye, {0.5, 0, 3}));
}

TEST_CASE("the selection tells the innermost hinge above it") {
    Stage stage("a", scene_with_a_door());
    stage.say("a", R"({"type":"patch","patch":{"selection":{"node":2}}})");
    CHECK(stage.state()["selection"]["hinge"] == 1);
    stage.say("a", R"({"type":"patch","patch":{"selection":{"node":3}}})");
    CHECK_FALSE(stage.state()["selection"].contains("hinge"));
}

TEST_CASE("a tap opens a door where that is wanted, once it cannot become a double one") {
    Stage stage("a", scene_with_a_door());
    tap(stage);
    stage.at(2s);
    CHECK(is_closed(stage));  // not wanted
    stage.say("a", kTapSwings);
    tap(stage);
    CHECK(stage.room.deadline() == 2400ms);
    stage.at(2399ms);
    CHECK_FALSE(stage.room.moves());
    stage.at(2400ms);
    CHECK(stage.room.moves());
    CHECK(stage.room.deadline() == std::nullopt);
    stage.at(3100ms);
    CHECK(is_open(stage));
}

TEST_CASE("double taps, drags and taps beside it open nothing") {
    Stage stage("a", scene_with_a_door());
    stage.say("a", kTapSwings);
    tap(stage);
    stage.at(100ms);
    tap(stage);  // selects
    stage.at(1s);
    stage.say("a", touch("down", 640, 360));
    stage.say("a", touch("move", 700, 360));
    stage.say("a", touch("up", 700, 360));
    stage.at(2s);
    tap(stage, 5, 5);
    stage.at(3s);
    tap(stage);  // and then another finger goes on
    stage.at(3100ms);
    stage.say("a", touch("down", 300, 300));
    stage.at(5s);
    CHECK(is_closed(stage));
    CHECK_FALSE(stage.room.moves());
}

TEST_CASE("a measure of a door moves with it, and a replay measures the same") {
    const auto measured = [](const Stage& stage) {
        const auto& now = stage.room.state().measured->at("Width");
        REQUIRE(now.components);
        return *now.components;
    };
    const std::string patch =
        R"({"type":"patch","patch":{"measures":{"Width":{"picks":[{"node":1,"snap":"point","points":[[0,0,0]]},
            {"node":1,"snap":"point","points":[[1,0,0]]}]}}}})";
    Stage stage("a", scene_with_a_door());
    stage.say("a", patch.c_str());
    CHECK(measured(stage) == glm::dvec3(1, 0, 0));
    stage.say("a", kSwing);
    stage.at(350ms);
    CHECK(near_to(measured(stage), {std::sqrt(0.5), 0, -std::sqrt(0.5)}));
    stage.at(700ms);
    CHECK(near_to(measured(stage), {0, 0, -1}));
    Stage again("a", scene_with_a_door());
    again.say("a", patch.c_str());
    again.say("a", kSwing);
    again.at(700ms);
    CHECK(again.state()["measured"] == stage.state()["measured"]);
}

TEST_CASE("another scene forgets it") {
    Stage stage("a", scene_with_a_door());
    stage.say("a", kTapSwings);
    stage.say("a", kSwing);
    tap(stage);
    stage.room.show(other_scene(), stage.now);
    CHECK_FALSE(stage.room.moves());
    CHECK(stage.state()["swings"].empty());
    stage.at(1s);
    CHECK_FALSE(stage.room.moves());
}
