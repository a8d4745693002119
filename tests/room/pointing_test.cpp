#include "stage.hpp"

using namespace stage;

namespace {

/// Beside the door's middle, (1, 0, 0), where the camera of the stage looks.
const std::string kAtDoor = R"({"type":"point","x":641,"y":360})";
const std::string kAtNothing = R"({"type":"point","x":5,"y":5})";
const std::string kNowhere = R"({"type":"point"})";

std::string at(double x, const std::string& more = {}) {
    return R"({"type":"point","x":)" + std::to_string(x) + R"(,"y":360)" + more + "}";
}

/// What clients were told since the last call.
std::vector<json> pointed(Stage& stage) {
    std::vector<json> all;
    for (const protocol::Pointed& each : stage.room.take_pointed())
        all.push_back(json::parse(protocol::encode(each)));
    return all;
}

/// The newest point of the only client that points; none where nothing was told, or none was.
std::optional<double> x_of(Stage& stage) {
    const auto all = pointed(stage);
    if (all.size() != 1 || !all[0].contains("point")) return std::nullopt;
    return all[0]["point"][0].get<double>();
}

}  // namespace

TEST_CASE("what a client points at is told with its point, its normal and who points") {
    Stage stage("bv");
    CHECK(stage.rejection("v", kAtDoor) == "");
    const auto all = pointed(stage);
    REQUIRE(all.size() == 1);
    CHECK(all[0]["type"] == "pointed");
    CHECK(all[0]["client"] == "v");
    CHECK_FALSE(all[0].contains("name"));
    CHECK(all[0]["point"][0].get<double>() == doctest::Approx(1.008).epsilon(0.001));
    CHECK(all[0]["point"][1].get<double>() == doctest::Approx(0).epsilon(0.001));
    CHECK(all[0]["normal"] == json({0, 0, 1}));
    stage.say("b", kAtDoor);
    CHECK(pointed(stage).at(0)["name"] == "Bea");
    CHECK(pointed(stage).empty());
}

TEST_CASE("pointing is no part of the state, of what is to be seen, of control or of the log") {
    std::vector<std::string> lines;
    RoomOptions options;
    options.journal = [&](const protocol::LogLine& line) { lines.push_back(protocol::encode(line)); };
    Stage stage("abv", first_scene(), std::move(options));
    stage.say("a", R"({"type":"fly","id":1,"keyframes":[{"at":9000,"camera":{"fov":30}}]})");
    stage.at(20ms);
    const std::int64_t revision = stage.revision();
    const plan::View visible = stage.room.visible();
    lines.clear();
    for (const char* client : {"a", "b", "v"}) CHECK(stage.say(client, kAtDoor));
    CHECK(pointed(stage).size() == 3);
    CHECK(stage.revision() == revision);
    CHECK(stage.room.visible() == visible);
    CHECK(stage.holder() == "a");
    CHECK(stage.room.flies());
    CHECK(lines.empty());
    stage.at(60ms);
    CHECK(stage.room.changed_by().empty());  // what flies is nobody's doing
}

TEST_CASE("at most 30 points a second of a client go on, and the last one in the end") {
    Stage stage("vw");
    stage.say("v", at(643));
    const double first = x_of(stage).value();
    CHECK_FALSE(stage.room.deadline());
    int told = 0;
    for (int ms = 1; ms <= 1000; ++ms) {
        stage.now = std::chrono::milliseconds(ms);
        stage.say("v", at(643 + 0.01 * ms));
        told += static_cast<int>(pointed(stage).size());
    }
    CHECK(told >= 28);
    CHECK(told <= 30);
    // What came last waits for its turn, and what came before it is dropped.
    stage.at(1100ms);
    pointed(stage);
    stage.say("v", at(650));
    pointed(stage);
    stage.now = 1101ms;
    stage.say("v", at(651));
    stage.say("v", at(660));
    CHECK(pointed(stage).empty());
    CHECK(stage.room.deadline() == SessionTime(1100ms) + Pointings::kApart);
    stage.at(1133ms);
    CHECK(pointed(stage).empty());
    stage.at(*stage.room.deadline());
    const double last = x_of(stage).value();
    CHECK(last - first == doctest::Approx((660 - 643) * 8 * std::tan(20 * M_PI / 180) / 360).epsilon(0.001));
    CHECK_FALSE(stage.room.deadline());
    // Each client has a turn of its own.
    stage.say("w", at(650));
    CHECK(pointed(stage).size() == 1);
}

TEST_CASE("a dot is taken away once: by its client, where nothing is, and by who leaves") {
    Stage stage("avw");
    const auto is_taken_away = [&](const char* client) {
        const auto all = pointed(stage);
        return all.size() == 1 && all[0]["client"] == client && !all[0].contains("point") &&
               !all[0].contains("normal");
    };
    stage.say("v", kNowhere);
    stage.say("w", kAtNothing);
    CHECK(pointed(stage).empty());
    SUBCASE("by its client") {
        stage.at(40ms);
        stage.say("v", kAtDoor);
        CHECK(x_of(stage));
        stage.at(80ms);
        stage.say("v", kNowhere);
        CHECK(is_taken_away("v"));
        stage.at(120ms);
        stage.say("v", kNowhere);
        CHECK(pointed(stage).empty());
    }
    SUBCASE("by its client, at once: that waits for its turn, too") {
        stage.at(40ms);
        stage.say("v", kAtDoor);
        CHECK(x_of(stage));
        stage.say("v", kNowhere);
        CHECK(pointed(stage).empty());
        stage.at(*stage.room.deadline());
        CHECK(is_taken_away("v"));
    }
    SUBCASE("where nothing is") {
        stage.at(40ms);
        stage.say("v", kAtDoor);
        CHECK(x_of(stage));
        stage.at(80ms);
        stage.say("v", kAtNothing);
        CHECK(is_taken_away("v"));
    }
    SUBCASE("by who leaves, though a point waited") {
        stage.at(40ms);
        stage.say("v", kAtDoor);
        CHECK(x_of(stage));
        stage.say("v", at(650));
        stage.room.leave("v", stage.now);
        CHECK(is_taken_away("v"));
        CHECK_FALSE(stage.room.deadline());
    }
    SUBCASE("who leaves without one says nothing") {
        stage.room.leave("w", stage.now);
        CHECK(pointed(stage).empty());
    }
}

TEST_CASE("a pointer in a frame that is forgotten is an error, and all keep what they had") {
    Stage stage("avw");
    stage.room.remember(1);
    stage.say("v", at(643.7, R"(,"frame":1)"));
    stage.say("w", kAtDoor);
    CHECK(pointed(stage).size() == 2);
    stage.told();
    stage.at(50ms);
    CHECK_FALSE(stage.say("v", at(650, R"(,"frame":7)")));
    CHECK_FALSE(stage.say("v", at(650, R"(,"frame":7,"id":5)")));
    const auto errors = stage.told();
    REQUIRE(errors.size() == 2);
    for (const json& error : errors) {
        CHECK(error["to"] == "v");
        CHECK(error["code"] == "unknown-frame");
        CHECK(error["message"] ==
              "frame 7 is not among the last 64 of the view; snapshots are not remembered");
    }
    CHECK(errors[1]["id"] == 5);
    CHECK(pointed(stage).empty());
    CHECK_FALSE(stage.room.deadline());
    // The frame's camera counts, not the present one.
    stage.say("a", R"({"type":"navigate","pan":[3,3]})");
    stage.say("w", kAtDoor);
    CHECK_FALSE(pointed(stage).at(0).contains("point"));
    stage.say("v", at(643.7, R"(,"frame":1)"));
    CHECK(x_of(stage));
}

TEST_CASE("who presents forbids watchers and hosts to point, which takes their dots away") {
    Stage stage("abvh");
    for (const char* client : {"b", "v", "h"}) stage.say(client, kAtDoor);
    CHECK(pointed(stage).size() == 3);
    CHECK(stage.state()["pointing"] == json({{"watchers", true}}));
    const std::string forbid = R"({"type":"patch","id":1,"patch":{"pointing":{"watchers":false}}})";
    CHECK(stage.rejection("b", forbid) == "not-in-control");
    CHECK(stage.rejection("v", forbid) == "not-allowed");
    CHECK(stage.rejection("h", forbid) == "not-allowed");
    CHECK(stage.rejection("a", forbid) == "");
    std::vector<std::string> gone;
    for (const json& each : pointed(stage)) {
        CHECK_FALSE(each.contains("point"));
        gone.push_back(each["client"]);
    }
    CHECK(gone == std::vector<std::string>{"h", "v"});

    stage.at(50ms);
    stage.told();
    for (const char* client : {"v", "h"}) {
        // Told once, but for those with an id.
        CHECK_FALSE(stage.say(client, kAtDoor));
        CHECK_FALSE(stage.say(client, kAtDoor));
        CHECK_FALSE(stage.say(client, at(643.7, R"(,"id":3)")));
        const auto errors = stage.told();
        REQUIRE(errors.size() == 2);
        CHECK(errors[0]["code"] == "not-allowed");
        CHECK(errors[0]["message"] ==
              "who presents does not let watchers point: 'pointing.watchers' is false");
        CHECK(errors[1]["id"] == 3);
    }
    CHECK(stage.rejection("v", kNowhere) == "");
    CHECK(pointed(stage).empty());
    for (const char* client : {"a", "b"}) CHECK(stage.say(client, kAtDoor));
    CHECK(pointed(stage).size() == 2);

    const std::string allow = R"({"type":"patch","patch":{"pointing":null}})";
    stage.say("a", allow);
    CHECK(stage.say("v", kAtDoor));
    CHECK(pointed(stage).size() == 1);
    // Each time that it is forbidden is told.
    for (int i = 0; i < 2; ++i) {
        stage.say("a", allow);
        stage.say("a", forbid);
        stage.told();
        CHECK_FALSE(stage.say("v", kAtDoor));
        CHECK(stage.told().size() == 1);
    }
}

TEST_CASE("another scene takes all dots away, and who may point stays") {
    Stage stage("av");
    stage.say("a", kAtDoor);
    stage.say("v", kAtDoor);
    stage.say("v", at(650));
    CHECK(pointed(stage).size() == 2);
    stage.say("a", R"({"type":"patch","patch":{"pointing":{"watchers":false}}})");
    stage.say("a", kAtDoor);
    pointed(stage);
    stage.room.show(other_scene(), stage.now);
    const auto all = pointed(stage);
    REQUIRE(all.size() == 1);
    CHECK(all[0]["client"] == "a");
    CHECK_FALSE(all[0].contains("point"));
    CHECK_FALSE(stage.room.deadline());
    CHECK_FALSE(stage.room.state().pointing.watchers);
}
