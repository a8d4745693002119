// The parts of a room, each by itself.
#include <doctest/doctest.h>

#include <chrono>
#include <vector>

#include "io/vrut/text_reader.hpp"
#include "room/clients.hpp"
#include "room/hinges.hpp"
#include "room/measures.hpp"
#include "room/pointings.hpp"
#include "room/recordings.hpp"
#include "room/revisions.hpp"
#include "room/seen_frames.hpp"
#include "room/swings.hpp"
#include "room/walls_camera.hpp"

using namespace vrut;
using namespace vrut::server::room;
using namespace std::chrono_literals;
using protocol::Role;

namespace {

/// Rays upwards hit something one unit away.
std::optional<mesh::Hit> sky(const mesh::Ray& ray) {
    if (ray.direction.y <= 0) return std::nullopt;
    mesh::Hit hit;
    hit.point = ray.origin + ray.direction;
    return hit;
}

const mesh::Ray kUp{{0, 0, 0}, {0, 1, 0}}, kDown{{0, 0, 0}, {0, -1, 0}};

scene::Camera turned_by(double degrees) {
    const double angle = degrees * scene::kRadiansPerDegree;
    scene::Camera camera;
    camera.eye = {5 * std::sin(angle), 0, 5 * std::cos(angle)};
    return camera;
}

}  // namespace

TEST_CASE("what a client points at: at once, then after its time, and its end once") {
    Pointings pointings;
    pointings.point("c1", "Bea", kUp);
    pointings.send(SessionTime{0}, sky);
    auto told = pointings.take();
    REQUIRE(told.size() == 1);
    CHECK(told[0].client == "c1");
    CHECK(told[0].name == "Bea");
    CHECK(told[0].point == glm::dvec3(0, 1, 0));
    CHECK_FALSE(pointings.deadline());

    pointings.point("c1", "Bea", kDown);
    CHECK(pointings.deadline() == Pointings::kApart);
    pointings.send(Pointings::kApart - SessionTime{1}, sky);
    CHECK(pointings.take().empty());
    pointings.send(Pointings::kApart, sky);
    told = pointings.take();
    REQUIRE(told.size() == 1);
    CHECK_FALSE(told[0].point);
    pointings.point("c1", "Bea", kDown);
    pointings.send(2 * Pointings::kApart, sky);
    CHECK(pointings.take().empty());
}

TEST_CASE("who stops pointing is taken away where others know a point of it, all at once too") {
    Pointings pointings;
    for (const char* client : {"c1", "c2"}) pointings.point(client, {}, kUp);
    pointings.point("c3", {}, kDown);
    pointings.send(SessionTime{0}, sky);
    CHECK(pointings.take().size() == 2);
    pointings.stop("c3");
    CHECK(pointings.take().empty());
    pointings.stop_all();
    for (const protocol::Pointed& pointed : pointings.take()) CHECK_FALSE(pointed.point);
    pointings.stop_all();
    CHECK(pointings.take().empty());
}

TEST_CASE("the walls' camera has that of the room where it is not limited, and else follows in steps") {
    WallsCamera walls;
    const scene::Camera before = turned_by(0), after = turned_by(40);
    const protocol::ComfortState comfort;
    walls.use(false, true, before, 0ms);
    CHECK_FALSE(walls.due());
    CHECK_FALSE(walls.state(after, {}, 1));
    walls.use(true, false, before, 0ms);
    CHECK_FALSE(walls.due());
    walls.use(true, true, after, 100ms);
    REQUIRE(walls.due() == SessionTime(116ms));
    int steps = 0;
    double behind = 180;
    while (walls.due()) {
        REQUIRE(++steps < 1000);
        const SessionTime now = *walls.due();
        walls.step(after, comfort, 1);
        const auto state = walls.state(after, {}, 1);
        CHECK((state ? state->behind_degrees : 0) <= behind);
        behind = state ? state->behind_degrees : 0;
        walls.use(true, false, after, now);
    }
    CHECK(behind == 0);
    CHECK(steps > 40 / comfort.degrees_per_second / 0.016);
}

TEST_CASE("the walls' camera goes on from what a log tells of it, and refuses what is no camera") {
    const protocol::ComfortState comfort;
    const scene::Camera after = turned_by(40);
    WallsCamera walls, restored;
    walls.use(true, true, turned_by(0), 0ms);
    for (int i = 0; i < 10; ++i) walls.step(after, comfort, 1);
    auto logged = walls.logged(*walls.due() - SessionTime(7ms));
    REQUIRE(logged);
    CHECK(logged->due == 7);
    restored.use(true, false, after, 0ms);
    CHECK_FALSE(restored.restore(*logged, 1000ms));
    CHECK(restored.due() == SessionTime(1007ms));
    for (WallsCamera* each : {&walls, &restored}) each->step(after, comfort, 1);
    CHECK(walls.state(after, {}, 1) == restored.state(after, {}, 1));
    restored.jump();
    CHECK_FALSE(restored.state(after, {}, 1));
    logged->camera.eye = logged->camera.focus;
    CHECK(restored.restore(*logged, 0ms));
}

TEST_CASE("of clients with one name each has a number, but who comes back has its own") {
    Clients clients;
    clients.add("c1", {Role::view, {}, clients.free_name("iPad", "key"), "key"});
    CHECK(clients.free_name("iPad", "") == "iPad 2");
    CHECK(clients.free_name("iPad", "key") == "iPad");
    CHECK(clients.free_name("", "") == "");
    clients.add("c2", {Role::view, {}, "iPad 2"});
    CHECK(clients.free_name("iPad", "") == "iPad 3");
    // A name of the longest kind is cut between characters.
    std::string longest;
    while (longest.size() < protocol::kMaxClientName) longest += "é";
    clients.add("c3", {Role::view, {}, longest});
    const std::string numbered = clients.free_name(longest, "");
    CHECK(numbered.size() <= protocol::kMaxClientName);
    CHECK(numbered.ends_with("é 2"));
}

TEST_CASE("the state names who presents first, then the audience that has a name, and not too many") {
    Clients clients;
    clients.add("c1", {Role::view});
    clients.add("c2", {Role::view, {}, "Ann"});
    clients.add("c3", {Role::host});
    CHECK(clients.listed().size() == 2);
    CHECK_FALSE(clients.listed().contains("c1"));
    CHECK(clients.listed().at("c3") == protocol::ClientState{{}, Role::host});
    CHECK(clients.any_may(protocol::Right::drive_walls));
    CHECK_FALSE(clients.any_may(protocol::Right::hold_control));
    for (std::size_t i = 0; i < protocol::kMaxListedClients; ++i)
        clients.add("v" + std::to_string(i), {Role::view, {}, std::to_string(i)});
    clients.add("late", {Role::control});
    CHECK(clients.listed().size() == protocol::kMaxListedClients);
    CHECK(clients.listed().contains("late"));
    clients.erase("c3");
    CHECK_FALSE(clients.any_may(protocol::Right::drive_walls));
    CHECK(clients.shown_name("c2") == "Ann");
    CHECK_FALSE(clients.shown_name("c1"));
    CHECK_FALSE(clients.shown_name("none"));
}

TEST_CASE("a revision is what has changed, and knows who made it and those before") {
    Revisions revisions;
    protocol::State state;
    revisions.go_to(1, state, true);
    revisions.begin("c1");
    CHECK(revisions.of(state)->revision() == 1);
    state.unit.metres = 1;
    CHECK(revisions.of(state)->revision() == 2);
    state.unit.metres = 2;
    CHECK(revisions.of(state)->revision() == 3);
    CHECK(revisions.changed_by() == "c1");
    CHECK(revisions.changed_by_since() == 2);
    revisions.begin({});
    state.unit.metres = 3;
    CHECK(revisions.of(state)->revision() == 4);
    CHECK(revisions.changed_by().empty());
    CHECK(revisions.changed_by_since() == 4);
    revisions.go_to(9, state);
    CHECK(revisions.newest().revision() == 9);
}

TEST_CASE("the last frames are remembered by their numbers") {
    SeenFrames frames;
    CHECK(frames.newest() == nullptr);
    for (std::int64_t number = 1; number <= 70; ++number) frames.add({number, {}, {}});
    CHECK(frames.newest()->number == 70);
    CHECK(frames.find(6) == nullptr);
    CHECK(frames.find(7)->number == 7);
    CHECK(frames.all().size() == SeenFrames::kMost);
}

TEST_CASE("measures are made again where one of them or the scene has changed, and only then") {
    Measures measures;
    protocol::SharedMap<protocol::MeasureState> asked;
    const auto placed = std::make_shared<const scene::PlacedScene>(scene::place(scene::Scene()));
    CHECK(measures.changed(asked, placed));
    CHECK_FALSE(measures.changed(asked, placed));
    asked.set("far", {protocol::MeasureKind::distance, {{99, protocol::Snap::point, {{0, 0, 0}}}}});
    const auto results = measures.changed(asked, placed);
    REQUIRE(results);
    CHECK(results->at("far").problem);
    const auto problem = Measures::problem_of(asked, *placed->scene);
    REQUIRE(problem);
    CHECK(problem->message == "'measures.far': there is no node 99");
    CHECK(measures.changed(asked, std::make_shared<const scene::PlacedScene>(*placed)));
}

namespace {

/// One door, of 90 degrees.
scene::PlacedScene with_door() {
    const auto scene =
        io::read_vrut_text("vrut-text 1\nnode 7 \"Door\" assembly hinge 0 1 0 90 end\n", "door.vrut");
    REQUIRE_MESSAGE(scene.has_value(), scene.error());
    return scene::place(*scene);
}

}  // namespace

TEST_CASE("what swings goes from where it stands, slowly at both ends, and is on its way until it arrives") {
    const scene::PlacedScene placed = with_door();
    const scene::Scene& scene = *placed.scene;
    const scene::Index door = scene.find_node(7);
    const auto part_in = [&](const Swings::Nodes& nodes) {
        return hinge_part(scene.nodes()[static_cast<std::size_t>(door)], *nodes.at("7").matrix).value();
    };
    Swings swings;
    Swings::Nodes nodes;
    swings.begin(placed, door, 1, 1000, 0ms);
    CHECK(swings.states(scene).at("7").to == 1);
    swings.advance(scene, 100ms, nodes);
    CHECK(part_in(nodes) == doctest::Approx(0.028));
    swings.advance(scene, 500ms, nodes);
    CHECK(part_in(nodes) == doctest::Approx(0.5));
    // Turned round on its way, it needs the share of the time that its way is.
    swings.begin(placed, door, {}, 1000, 500ms);
    CHECK(swings.states(scene).at("7").to == 0);
    swings.advance(scene, 999ms, nodes);
    CHECK_FALSE(swings.empty());
    swings.advance(scene, 1000ms, nodes);
    CHECK(swings.empty());
    CHECK(nodes.at("7").matrix == glm::dmat4(1));
}

TEST_CASE("what swings ends where others move it, and at once where it is hurried") {
    const scene::PlacedScene placed = with_door();
    const scene::Scene& scene = *placed.scene;
    Swings swings;
    Swings::Nodes before, after;
    swings.begin(placed, scene.find_node(7), 1, 1000, 0ms);
    swings.end_changed(scene, before, after);
    CHECK_FALSE(swings.empty());
    after["7"].matrix = glm::dmat4(2);
    swings.end_changed(scene, before, after);
    CHECK(swings.empty());
    swings.begin(placed, scene.find_node(7), 1, 1000, 0ms);
    swings.hurry();
    swings.advance(scene, 0ms, before);
    CHECK(swings.empty());
}

TEST_CASE("a tap sets a door off when it can become no double one, unless it is forgotten") {
    const scene::PlacedScene placed = with_door();
    Swings swings;
    swings.tap(placed.scene->find_node(7), 300ms);
    CHECK(swings.tap_due() == SessionTime(300ms));
    swings.use_tap(placed, 299ms);
    CHECK(swings.empty());
    swings.use_tap(placed, 310ms);
    CHECK_FALSE(swings.is_tapped());
    CHECK(swings.states(*placed.scene).at("7").to == 1);
    swings.clear();
    swings.tap(placed.scene->find_node(7), 300ms);
    swings.forget_tap();
    swings.use_tap(placed, 400ms);
    CHECK(swings.empty());
}

TEST_CASE("one recording takes lines, and is known until all of it is written") {
    std::vector<std::string> done;
    RecordingSink sink;
    sink.begin = [&](std::int64_t number, const std::string& name, const auto&) {
        done.push_back("begin " + std::to_string(number) + " " + name);
    };
    sink.write = [&](std::int64_t number, const std::string& line) {
        done.push_back("write " + std::to_string(number) + " " + line);
    };
    sink.end = [&](std::int64_t number) { done.push_back("end " + std::to_string(number)); };
    Recordings recordings(sink);
    recordings.write(0ms, "c1", protocol::LogLine::Disconnected{});
    CHECK(done.empty());
    recordings.begin("tour", {}, 100ms, {"c1", {}});
    CHECK(recordings.active() == recordings.find(1));
    recordings.write(150ms, "c1", protocol::LogLine::Disconnected{});
    recordings.end({"c2", {}});
    CHECK(recordings.active() == nullptr);
    recordings.write(160ms, "c1", protocol::LogLine::Disconnected{});
    CHECK(done == std::vector<std::string>{"begin 1 tour",
                                           R"(write 1 {"at":50.0,"client":"c1","event":"disconnected"})",
                                           "end 1"});
    recordings.begin("next", {}, 200ms, {"c1", {}});
    CHECK(recordings.active() == recordings.find(2));
    CHECK(recordings.take(1)->stop->client == "c2");
    CHECK_FALSE(recordings.take(1));
    CHECK_FALSE(recordings.empty());
    CHECK_FALSE(Recordings(std::nullopt).has_sink());
}

TEST_CASE("the journal names a revision once, and with it what it does not know of notices and recording") {
    std::vector<std::string> lines;
    Journal journal([&](const protocol::LogLine& line) { lines.push_back(protocol::encode(line)); });
    protocol::State state;
    journal.write_revision(0ms, 1, state);
    journal.write_revision(0ms, 1, state);
    CHECK(lines == std::vector<std::string>{
                       R"({"at":0.0,"event":"revised","notices":[],"recording":"","revision":1})"});
    state.recording = protocol::RecordingState{"tour"};
    journal.write_revision(5ms, 2, state);
    CHECK(lines.back() == R"({"at":5.0,"event":"revised","recording":"tour","revision":2})");
    journal.write_revision(5ms, 3, state);
    CHECK(lines.back() == R"({"at":5.0,"event":"revised","revision":3})");
    Journal(nullptr).write(0ms, "c1", protocol::LogLine::Disconnected{});
}

TEST_CASE("what is answered later is so once") {
    AnswersLater later;
    const std::int64_t first = later.add({"c1", {}}), second = later.add({"c2", {}});
    CHECK(first != second);
    CHECK(later.take(second)->client == "c2");
    CHECK_FALSE(later.take(second));
    CHECK_FALSE(later.empty());
    CHECK(later.take(first)->client == "c1");
    CHECK(later.empty());
}
