// What hosts get of the camera.
#include <random>

#include "event_log.hpp"
#include "room/replay.hpp"
#include "stage.hpp"
#include "state_document.hpp"

using namespace stage;

namespace {

/// 60 degrees or so, at once.
const std::string kFlick = R"({"type":"navigate","rotate":[300,0]})";
const std::string kOff = R"({"type":"patch","patch":{"comfort":{"on":false}}})";

/// The scene's units are metres: the camera stands 8 m away.
LoadedScene in_metres() {
    LoadedScene scene = first_scene();
    scene.changes = R"({"unit":{"metres":1}})";
    return scene;
}

/// The document of hosts.
json for_hosts(Room& room) {
    const auto document = room.document()->for_hosts();
    return document ? document->json() : room.document()->json();
}

/// Lines that a server would write, and the room after them.
class RecordedWalls {
public:
    RecordedWalls() : stage("", in_metres(), options()) {}

    /// A room to which the same lines came, with no calls of advance() between.
    Room replayed() {
        RoomOptions replaying;
        replaying.policy = kReplay;
        Room room(in_metres(), replaying);
        for (const protocol::LogLine& line : lines)
            CHECK_FALSE(play(room, line, [](const auto&...) { return other_scene(); }));
        room.advance(stage.now);
        return room;
    }

    std::vector<protocol::LogLine> lines;
    Stage stage;

private:
    RoomOptions options() {
        RoomOptions options;
        options.journal = [this](const protocol::LogLine& line) { lines.push_back(line); };
        return options;
    }
};

}  // namespace

TEST_CASE("a flick moves the room's camera at once, and that of hosts gently until they are equal") {
    Stage stage("ah", in_metres());
    const json start = stage.state();
    stage.say("a", kFlick);
    const json camera = stage.state()["camera"];
    REQUIRE(camera["eye"] != start["camera"]["eye"]);
    json walls = stage.state()["walls"];
    CHECK(walls["eye"] == start["camera"]["eye"]);
    CHECK(walls["behindDegrees"] > 30);
    CHECK(walls["behindMetres"] > 3);
    double before = walls["behindDegrees"];
    int revisions = 0;
    for (int ms = 1; ms < 6000 && stage.state().contains("walls"); ++ms) {
        const std::int64_t revision = stage.revision();
        stage.at(std::chrono::milliseconds(ms));
        if (stage.revision() == revision) continue;
        ++revisions;
        CHECK(stage.room.changed_by().empty());
        CHECK(stage.state()["camera"] == camera);
        if (!stage.state().contains("walls")) break;
        walls = stage.state()["walls"];
        const double behind = walls["behindDegrees"];
        CHECK(behind <= before);
        CHECK(before - behind <= 45 * 0.016 + 1e-9);
        before = behind;
        const json document = for_hosts(stage.room);
        for (const char* member : {"eye", "focus", "up", "center", "fov", "near", "far"})
            CHECK(document["camera"][member] == walls[member]);
        CHECK(document["camera"].size() == 7);
    }
    CHECK_FALSE(stage.state().contains("walls"));
    CHECK(for_hosts(stage.room)["camera"] == camera);
    CHECK(revisions > 100);
    stage.at(6s);
    CHECK_FALSE(stage.room.deadline());
}

TEST_CASE("what only the walls do is not to be drawn") {
    Stage stage("ah", in_metres());
    stage.say("a", kFlick);
    const plan::View visible = stage.room.visible();
    CHECK_FALSE(stage.room.moves());
    CHECK(stage.room.deadline() == std::optional<SessionTime>(16ms));
    stage.at(500ms);
    CHECK(stage.state().contains("walls"));
    CHECK(stage.room.visible() == visible);
}

TEST_CASE("a recording that begins while hosts are behind replays to the same walls") {
    RecordingSink::Header header;
    RoomOptions recorded, replaying;
    recorded.recordings = {[&](auto, const auto&, RecordingSink::Header first) { header = std::move(first); },
                           [](auto, const auto&) {}, [](auto) {}};
    replaying.policy = kReplay;
    Stage stage("ah", in_metres(), recorded);
    stage.say("a", kFlick);
    constexpr SessionTime kBegin = 205ms;
    stage.at(kBegin);
    REQUIRE(stage.say("a", R"({"type":"record","id":1,"action":"start","name":"flick"})"));
    const auto read = protocol::decode_log_header(header("flick", "now"));
    REQUIRE_MESSAGE(read, read.error().message);
    Stage replay("", in_metres(), replaying);
    REQUIRE(replay.room.restore(*read));
    int steps = 0;
    for (SessionTime at{0}; at < 6s; at += 7ms) {
        stage.at(kBegin + at);
        replay.at(at);
        const json walls = stage.state().value("walls", json());
        REQUIRE(replay.state().value("walls", json()) == walls);
        steps += walls.is_null() ? 0 : 1;
    }
    CHECK(steps > 100);
    CHECK_FALSE(stage.state().contains("walls"));
}

TEST_CASE("walls of a recording that are no camera are refused") {
    auto header = Stage("ah", in_metres()).room.checkpoint()->header;
    header.walls = protocol::LogHeader::Walls{};
    header.walls->camera.eye = header.walls->camera.focus;
    RoomOptions replaying;
    replaying.policy = kReplay;
    Stage replay("", in_metres(), replaying);
    const auto restored = replay.room.restore(header);
    REQUIRE_FALSE(restored);
    CHECK(restored.error().message.find("'walls'") != std::string::npos);
}

TEST_CASE("nothing follows where no host is here, or comfort is off") {
    Stage stage("av", in_metres());
    stage.say("a", kFlick);
    CHECK_FALSE(stage.state().contains("walls"));
    CHECK_FALSE(stage.room.deadline());
    stage.join('h');
    CHECK_FALSE(stage.state().contains("walls"));
    stage.say("a", kFlick);
    CHECK(stage.state().contains("walls"));
    SUBCASE("the last host leaves") { stage.room.leave("h", stage.now); }
    SUBCASE("it is switched off") { stage.say("a", kOff); }
    SUBCASE("another scene is shown") { stage.room.show(other_scene(), stage.now); }
    CHECK_FALSE(stage.state().contains("walls"));
    CHECK_FALSE(stage.room.deadline());
    CHECK(stage.room.document()->for_hosts() == nullptr);
}

TEST_CASE("comfort stays when another scene is shown") {
    Stage stage("ah", in_metres());
    stage.say("a", R"({"type":"patch","patch":{"comfort":{"degreesPerSecond":20}}})");
    stage.room.show(other_scene(), stage.now);
    CHECK(stage.state()["comfort"]["degreesPerSecond"] == 20);
}

TEST_CASE("lengths count in metres, whatever the scene's unit") {
    Stage stage("ah", first_scene());  // in millimetres: 8 mm away
    stage.say("a", R"({"type":"patch","patch":{"camera":{"eye":[0,0,3000],"focus":[0,0,0]}}})");
    CHECK(stage.state()["walls"]["behindMetres"] == doctest::Approx(2.992));
    stage.at(1s);
    const json slow = stage.state()["walls"];
    CHECK(slow["eye"][2] < 2000);
    stage.at(4s);
    CHECK_FALSE(stage.state().contains("walls"));
}

TEST_CASE("what a host patches is where the walls are already, for all hosts") {
    Stage stage("ah", in_metres());
    stage.say("a", kFlick);
    stage.at(1100ms);
    REQUIRE(stage.state().contains("walls"));
    CHECK(stage.rejection("h", R"({"type":"patch","id":1,"patch":{"selection":{"node":2}}})") == "");
    CHECK(stage.state().contains("walls"));
    CHECK(stage.rejection("h", R"({"type":"patch","id":2,"patch":{"camera":{"eye":[0,5,9]}}})") == "");
    CHECK_FALSE(stage.state().contains("walls"));
    CHECK(stage.camera().eye == glm::dvec3(0, 5, 9));
}

TEST_CASE("hosts' updates lead from what they have to what they get") {
    Stage stage("ah", in_metres());
    const auto mine = [&] {
        const auto document = stage.room.document();
        const auto hosts = document->for_hosts();
        return hosts ? hosts : document;
    };
    auto known = mine();
    json held = known->json();
    for (int step = 0; step < 300; ++step) {
        if (step % 50 == 0) stage.say("a", kFlick);
        if (step == 120) stage.say("h", R"({"type":"patch","patch":{"camera":{"eye":[0,5,9]}}})");
        stage.at(stage.now + 33ms);
        const auto next = mine();
        held.merge_patch(json::parse(next->encode_patch_from(*known, ""))["patch"]);
        known = next;
        REQUIRE(held == next->json());
        CHECK(next->revision() == stage.revision());
        // As a server finds it that only gets the document.
        const auto received =
            protocol::StateDocument::received(stage.room.document()->encode(), nullptr).value()->for_hosts();
        CHECK((received ? received->json() : stage.state()) == held);
    }
}

TEST_CASE("how hosts follow is the same however often the room is advanced, and in a replay") {
    RecordedWalls recorded;
    Stage& stage = recorded.stage;
    stage.now = 3ms;
    stage.join('a');
    stage.join('h');
    std::mt19937 dice(7);
    std::vector<json> seen;
    const char* const messages[] = {
        R"({"type":"navigate","rotate":[300,-40]})", R"({"type":"navigate","zoom":2.5})",
        R"({"type":"fly","keyframes":[{"at":700,"camera":{"eye":[3,2,6]}}]})",
        R"({"type":"patch","patch":{"camera":{"node":6}}})",
        R"({"type":"patch","patch":{"nodes":{"1":{"matrix":[1,0,0,3, 0,1,0,0, 0,0,1,0, 0,0,0,1]}}}})"};
    for (int step = 0; step < 400; ++step) {
        stage.at(stage.now + std::chrono::microseconds(dice() % 40'000));
        stage.room.document();
        if (step % 25 == 0) stage.say("a", messages[dice() % std::size(messages)]);
        if (step % 50 != 49) continue;
        Room replayed = recorded.replayed();
        CHECK(replayed.document()->json()["walls"] == stage.state()["walls"]);
        CHECK(replayed.document()->json()["camera"] == stage.state()["camera"]);
        seen.push_back(stage.state().value("walls", json()));
    }
    CHECK(std::ranges::count(seen, json()) < 8);  // it was under way
}

TEST_CASE("hosts follow a door on which the camera stands, however often the room is advanced") {
    const auto walls_after = [](SessionTime step) {
        Stage stage("ah", scene_with_a_door());
        stage.say("a", R"({"type":"patch","patch":{"unit":{"metres":1},"navigation":{"tapSwings":true}}})");
        stage.say("a", R"({"type":"patch","patch":{"camera":{"node":5}}})");
        for (; stage.now < 10s; stage.now += step) stage.at(stage.now);
        stage.say("a", R"({"type":"swing","node":1})");
        for (const SessionTime end = 10s + 640ms; stage.now < end; stage.now += step) stage.at(stage.now);
        stage.at(10s + 640ms);
        return stage.state()["walls"];
    };
    const json walls = walls_after(10ms);
    CHECK(walls["behindMetres"] > 0);
    CHECK(walls_after(80ms) == walls);
}

TEST_CASE("a wrong limit is named, and nothing changes") {
    Stage stage("ah", in_metres());
    const json before = stage.state();
    struct Case {
        const char *comfort, *code, *culprit;
    };
    for (const Case& c :
         {Case{R"({"degreesPerSecond":0})", "out-of-range", "'comfort.degreesPerSecond'"},
          Case{R"({"metresPerSecond":-2})", "out-of-range", "'comfort.metresPerSecond'"},
          Case{R"({"metresPerSecondSquared":"4"})", "bad-message", "'comfort.metresPerSecondSquared'"},
          Case{R"({"speed":4})", "unknown-member", "'comfort.speed'"}}) {
        stage.say("a", R"({"type":"patch","id":1,"patch":{"comfort":)" + std::string(c.comfort) + "}}");
        const json error = stage.told().back();
        CHECK(error["code"] == c.code);
        CHECK_MESSAGE(error["message"].get<std::string>().find(c.culprit) != std::string::npos, error.dump());
    }
    CHECK(stage.rejection("h", R"({"type":"patch","id":9,"patch":{"comfort":{"on":false}}})") ==
          "not-allowed");
    CHECK(stage.rejection("a", R"({"type":"patch","id":9,"patch":{"walls":null}})") == "read-only");
    CHECK(stage.state() == before);
}
