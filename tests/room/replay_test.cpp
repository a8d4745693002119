// What begins in the middle of something, ends in it, or is no log at all.
#include "room/replay.hpp"

#include <spdlog/spdlog.h>

#include <array>
#include <bit>
#include <random>

#include "event_log_file.hpp"
#include "folder_of_logs.hpp"
#include "stage.hpp"
#include "state_document.hpp"
#include "temporary_folder.hpp"

using namespace stage;

namespace {

tl::expected<server::scenes::LoadedScene, std::string> find_scene(const std::string& name,
                                                                  const std::string& sha256,
                                                                  std::optional<protocol::UpAxis> = {}) {
    server::scenes::LoadedScene found = name == "other.vrut"  ? other_scene()
                                        : name == "door.vrut" ? scene_with_a_door()
                                                              : first_scene();
    if (found.sha256 != sha256) return tl::unexpected(name + " is another one now");
    return found;
}

std::string pointer(const std::string& what, double x, double y, int id = 1, const char* device = "touch") {
    return json{{"type", "pointer" + what},
                {"pointerId", id},
                {"pointerType", device},
                {"x", x},
                {"y", y},
                {"button", what == "move" ? -1 : 0},
                {"buttons", what == "up" ? 0 : 1}}
        .dump();
}

/// A stage whose session is recorded from some point on.
class Recorded {
public:
    explicit Recorded(const std::string& clients, server::scenes::LoadedScene shown = first_scene())
        : logs(folder.path()), stage(clients, std::move(shown), logs.options()) {
        stage.after_message = [this](Stage& told) { logs.tell_results(told); };
        spdlog::set_level(spdlog::level::warn);
    }
    void start(const std::string& client = "a") {
        REQUIRE(stage.rejection(client, R"({"type":"record","action":"start","name":"log"})") == "");
    }
    server::room::EventLog log() const {
        auto log = log_in(folder.path() / "log.jsonl");
        REQUIRE_MESSAGE(log, log.error());
        return *std::move(log);
    }
    /// The replay ends in the state that the session has now, to the last bit.
    void check() {
        const auto replayed = replay(log(), find_scene);
        REQUIRE_MESSAGE(replayed, replayed.error());
        CHECK(state_of(*replayed) == state_of(stage.room));
        CHECK(bits(replayed->state().camera.eye) == bits(stage.camera().eye));
        CHECK(replayed->view_size() == stage.room.view_size());
        CHECK(replayed->flies() == stage.room.flies());
    }

    TemporaryFolder folder;
    FolderOfLogs logs;
    Stage stage;

private:
    /// The document but for the recording; numbers as they are.
    static json state_of(const Room& room) {
        json state = protocol::StateDocument::next({}, room.state())->json();
        state.erase("recording");
        return state;
    }
    static std::array<std::uint64_t, 3> bits(const glm::dvec3& point) {
        return std::bit_cast<std::array<std::uint64_t, 3>>(point);
    }
};

/// Two clients who do anything at any time; the recording begins somewhere in it.
class RandomSession {
public:
    explicit RandomSession(unsigned seed)
        : dice_(seed), recorded("ab", any_scene()), begins_(number(0, 30)) {}

    void play() {
        for (int step = 0; step < 80; ++step) {
            recorded.stage.at(recorded.stage.now +
                              server::room::SessionTime(number(0, 9) > 0 ? number(0, 40'000) : 1'200'000));
            if (step == begins_) {
                recorded.stage.say("a", R"({"type":"control","action":"take"})");
                recorded.start();
            }
            happen();
        }
        recorded.stage.join('v');  // a line of the last time
    }

private:
    int number(int from, int to) {
        return from + static_cast<int>(dice_() % static_cast<unsigned>(to - from + 1));
    }
    server::scenes::LoadedScene any_scene() {
        const int which = number(0, 2);
        return which == 0 ? first_scene() : which == 1 ? other_scene() : scene_with_a_door();
    }
    std::string one_of(std::initializer_list<const char*> texts) {
        return texts.begin()[dice_() % texts.size()];
    }

    void happen() {
        Stage& stage = recorded.stage;
        const int what = number(0, 19);
        if (what < 4) {
            stage.room.remember(++frame_);
        } else if (what == 4) {
            stage.room.leave(second_, stage.now);
            if (number(0, 3) == 0) stage.at(stage.now + 11s);
            second_ = "b" + std::to_string(++came_);
            stage.room.join(second_, protocol::Role::control, stage.now, "Bea",
                            number(0, 1) == 0 ? "" : "secret");
        } else if (what == 5 && number(0, 3) == 0) {
            stage.room.show(any_scene(), stage.now);
        } else {
            stage.say(one_of({"a", "a", second_.c_str()}), number(0, 1) == 0 ? input() : request());
        }
    }

    std::string input() {
        const int x = number(0, 1280), y = number(0, 720), id = number(1, 3);
        const std::string device = one_of({"touch", "touch", "mouse"});
        switch (number(0, 9)) {
            case 0:
            case 1:
                return pointer("down", x, y, id, device.c_str());
            case 2:
                return pointer("up", x, y, id, device.c_str());
            case 3:
                return json{{"type", "wheel"}, {"x", x},         {"y", y},
                            {"deltaX", 0},     {"deltaMode", 0}, {"deltaY", y - 360}}
                    .dump();
            case 4:
                return one_of({R"({"type":"keydown","key":"1","code":"Digit1"})",
                               R"({"type":"keyup","key":"1","code":"Digit1"})",
                               R"({"type":"keydown","key":"ArrowUp","code":"ArrowUp"})",
                               R"({"type":"keydown","key":"f","code":"KeyF"})",
                               R"({"type":"keydown","key":"Home","code":"Home"})"});
            case 5:
                return chord(x, y, id);
            case 6:
                return tap(x % 12, y % 12);
            default:
                return pointer("move", x, y, id, device.c_str());
        }
    }

    /// Another button of a mouse goes down or up, or all are let go unseen.
    std::string chord(int x, int y, int id) {
        json move = json::parse(pointer("move", x, y, id, "mouse"));
        move["button"] = number(-1, 2);
        move["buttons"] = number(0, 7);
        move["altKey"] = number(0, 1) == 0;
        if (number(0, 9) == 0) move["type"] = "pointercancel";
        return move.dump();
    }
    /// So near to each other that two may make a double one.
    std::string tap(int x, int y) {
        json event = json::parse(pointer(one_of({"down", "up"}), x + 630, y + 350, 7));
        event["frame"] = std::max(1, frame_ - number(0, 2));
        if (number(0, 1) == 0) event["timeStamp"] = recorded.stage.now.count() / 1000 - number(0, 30);
        return event.dump();
    }

    std::string request() {
        const int x = number(0, 1280), y = number(0, 720);
        const json pick{{"type", "pick"},
                        {"x", x},
                        {"y", y},
                        {"then", one_of({"center", "lookAt", "select"})},
                        {"frame", std::max(1, frame_ - number(0, 5))}};
        const json resize{{"type", "resize"}, {"width", x + 1}, {"height", y + 1}, {"pixelRatio", 1}};
        switch (number(0, 5)) {
            case 0:
                return pick.dump();
            case 1:
                return resize.dump();
            case 2:
                return one_of({R"({"type":"fly","keyframes":[{"at":700,"camera":{"eye":[3,2,4]}}]})",
                               R"({"type":"fly","keyframes":[{"at":50,"camera":{"fov":50}},
                                   {"at":900,"camera":{"eye":[2,5,1]}}]})"});
            case 3:
                if (number(0, 4) == 0)
                    return json{
                        {"type", "control"}, {"action", one_of({"give", "decline"})}, {"client", second_}}
                        .dump();
                return one_of({R"({"type":"control","action":"take"})",
                               R"({"type":"control","action":"release"})",
                               R"({"type":"control","action":"ask"})",
                               R"({"type":"navigate","rotate":[7,3],"pan":[0.1,0],"zoom":1.1})"});
            default:
                return one_of({R"({"type":"patch","patch":{"navigation":{"style":"cinema4d"}}})",
                               R"({"type":"patch","patch":{"navigation":{"keepUpright":false}}})",
                               R"({"type":"patch","patch":{"navigation":null,"views":{"v":{"order":3}}}})",
                               R"({"type":"patch","patch":{"camera":{"eye":[1,2,9]}}})",
                               R"({"type":"patch","patch":{"camera":null}})",
                               R"({"type":"patch","patch":{"nodes":null}})", kMoveHinge,
                               R"({"type":"swing","node":1})",
                               R"({"type":"swing","node":2,"open":1,"ms":90})",
                               R"({"type":"patch","patch":{"navigation":{"tapSwings":true}}})"});
        }
    }

    std::mt19937 dice_;

public:
    Recorded recorded;

private:
    int begins_ = 0, frame_ = 0, came_ = 0;
    std::string second_ = "b";
};

/// The sentence with which a log of these lines behind a good header fails.
std::string failure(const std::string& lines) {
    Recorded recorded("a");
    recorded.start();
    const std::string header = recorded.folder.read("log.jsonl");
    const auto log = log_in(recorded.folder.write("wrong.jsonl", header + lines));
    if (!log) return log.error();
    const auto replayed = server::room::replay(*log, find_scene);
    return replayed ? "" : replayed.error();
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("begun in a view of the holder's size") {
    Recorded recorded("ab");
    recorded.stage.say("a", R"({"type":"resize","width":300,"height":500,"pixelRatio":2})");
    recorded.stage.say("b", R"({"type":"resize","width":640,"height":200,"pixelRatio":0.5})");
    recorded.start();
    recorded.stage.say("a", pointer("down", 100, 100));
    recorded.stage.say("a", pointer("move", 130, 140));
    recorded.check();
    recorded.stage.say("b", R"({"type":"control","action":"take"})");  // brings his size
    recorded.stage.say("b", R"({"type":"fit"})");
    recorded.check();
}

TEST_CASE("control that passes on by itself passes on in the log, too") {
    Recorded recorded("");
    recorded.stage.room.join("a", protocol::Role::control, 0s, "Anna", "secret");
    recorded.stage.join('b');
    recorded.stage.say("b", R"({"type":"resize","width":640,"height":200,"pixelRatio":0.5})");
    recorded.start();
    recorded.stage.at(1s);
    recorded.stage.room.leave("a", recorded.stage.now);
    CHECK(recorded.stage.state()["control"]["absent"] == true);
    recorded.check();
    SUBCASE("to the next client") {
        recorded.stage.at(1s + 10s);
        CHECK(recorded.stage.holder() == "b");
        recorded.check();
        recorded.stage.room.leave("b", recorded.stage.now);
        CHECK(recorded.stage.holder() == "");
        recorded.check();
        recorded.stage.join('c');
        recorded.check();
    }
    SUBCASE("to the one that comes back") {
        recorded.stage.room.join("c", protocol::Role::control, 2s, "Anna", "secret");
        CHECK(recorded.stage.holder() == "c");
        recorded.check();
    }
}

TEST_CASE(
    "in logs without lines of control, who steers takes it, and a press is measured in the view it began "
    "in") {
    Recorded recorded("ab");
    recorded.start();
    const std::string lines = recorded.folder.read("log.jsonl");
    std::string text = lines.substr(0, lines.find('\n') + 1);
    const auto add = [&](const char* client, const std::string& message) {
        text += R"({"at":1,"client":")" + std::string(client) + R"(","message":)" + message + "}\n";
    };
    add("a", R"({"type":"resize","width":400,"height":200,"pixelRatio":1})");
    add("b", R"({"type":"resize","width":100,"height":100,"pixelRatio":2})");
    add("b", pointer("down", 50, 50));
    add("b", pointer("move", 90, 50));
    const auto replayed = [&] {
        const auto log = log_in(recorded.folder.write("old.jsonl", text));
        REQUIRE_MESSAGE(log, log.error());
        auto room = replay(*log, find_scene);
        REQUIRE_MESSAGE(room, room.error());
        return *std::move(room);
    };
    const Room dragged = replayed();
    CHECK(dragged.holder() == "b");
    CHECK(dragged.view_size() == protocol::Resize{400, 200, 1});
    add("b", pointer("up", 90, 50));
    const Room released = replayed();
    CHECK(released.view_size() == protocol::Resize{100, 100, 2});
    CHECK(released.state().camera.eye == dragged.state().camera.eye);
    text += R"({"at":2,"client":"b","event":"disconnected"})"
            "\n";
    add("a", R"({"type":"navigate","zoom":2})");
    CHECK(replayed().holder() == "a");
}

TEST_CASE("begun before anybody moved the camera: home goes on to fit the view") {
    Recorded recorded("a", other_scene());
    recorded.start();
    const glm::dvec3 eye = recorded.stage.camera().eye;
    recorded.stage.say("a", R"({"type":"resize","width":100,"height":300,"pixelRatio":1})");
    CHECK(recorded.stage.camera().eye != eye);
    recorded.check();
}

TEST_CASE("begun in a scene that was opened in another view: null gives back its home") {
    Recorded recorded("a");
    recorded.stage.say("a", R"({"type":"resize","width":100,"height":300,"pixelRatio":1})");
    recorded.stage.say("a", R"({"type":"patch","patch":{}})");
    recorded.stage.room.show(other_scene(), 1s);
    const glm::dvec3 eye = recorded.stage.camera().eye;
    recorded.start();
    recorded.stage.say("a", R"({"type":"patch","patch":{"camera":{"fov":60},"views":{"home":{"fov":60}}}})");
    recorded.stage.say("a", R"({"type":"patch","patch":{"camera":null,"views":{"home":null}}})");
    CHECK(recorded.stage.camera().eye == eye);
    recorded.check();
}

TEST_CASE("begun at a camera node that is moved later, with a door open and a selection") {
    Recorded recorded("a");
    recorded.stage.say("a", R"({"type":"patch","patch":{"nodes":{"2":{"active":false},"3":{"activeChild":1}},
        "selection":{"node":5},"markers":{"m":{"point":[1,2,3],"node":2}},"views":{"v":{}}}})");
    recorded.start();
    recorded.check();
    recorded.stage.say("a", kMoveHinge);
    CHECK(recorded.stage.camera().eye == glm::dvec3(3, 0, 8));
    recorded.check();
    recorded.stage.say("a", R"({"type":"patch","patch":{"nodes":null}})");
    recorded.check();
}

TEST_CASE("a pick that names a frame of before the recording sees what that showed") {
    Recorded recorded("a");
    recorded.stage.room.remember(4);
    recorded.stage.say("a", R"({"type":"navigate","rotate":[180,0]})");
    recorded.stage.room.remember(5);
    recorded.start();
    recorded.stage.say("a", R"({"type":"pick","x":640,"y":360,"frame":4,"then":"select"})");
    CHECK(recorded.stage.room.state().selection.node == 2);
    recorded.check();
}

TEST_CASE("begun in a flight, which goes on where it was") {
    Recorded recorded("a");
    recorded.stage.at(10s);
    recorded.stage.say("a", R"({"type":"fly","keyframes":[{"at":333,"camera":{"eye":[2,3,4]}},
        {"at":1000,"camera":{"eye":[-3,1,2],"fov":70}}]})");
    recorded.stage.at(10'123'457us);
    recorded.start();
    CHECK(recorded.stage.room.flies());
    recorded.stage.at(10'654'321us);
    recorded.stage.join('v');
    recorded.check();  // unfinished: where it was at the last line
    SUBCASE("and ends") {
        recorded.stage.at(11s);
        recorded.stage.join('b');
        CHECK_FALSE(recorded.stage.room.flies());
        CHECK(recorded.stage.camera().eye == glm::dvec3(-3, 1, 2));
        recorded.check();
    }
    SUBCASE("and is stopped") {
        recorded.stage.at(10'777'777us);
        recorded.stage.say("a", R"({"type":"navigate","zoom":1.25})");
        recorded.check();
    }
}

TEST_CASE("begun in a drag, with a key held that makes it one") {
    Recorded recorded("a");
    recorded.stage.say("a", R"({"type":"patch","patch":{"navigation":{"style":"cinema4d"}}})");
    recorded.stage.say("a", R"({"type":"keydown","key":"1","code":"Digit1"})");
    recorded.stage.say("a", pointer("down", 300, 300, 1, "mouse"));
    recorded.stage.say("a", pointer("move", 340, 310, 1, "mouse"));
    recorded.start();
    recorded.stage.say("a", pointer("move", 400, 330, 1, "mouse"));
    recorded.check();
    recorded.stage.say("a", R"({"type":"keyup","key":"1","code":"Digit1"})");
    recorded.stage.say("a", pointer("move", 410, 380, 1, "mouse"));
    recorded.check();
}

TEST_CASE("begun in a pinch") {
    Recorded recorded("a");
    recorded.stage.say("a", pointer("down", 300, 300, 1));
    recorded.stage.say("a", pointer("down", 400, 300, 2));
    recorded.stage.say("a", pointer("move", 450, 310, 2));
    recorded.start();
    recorded.stage.say("a", pointer("move", 470, 250, 2));
    recorded.stage.say("a", pointer("move", 310, 280, 1));
    recorded.check();
    recorded.stage.say("a", pointer("up", 470, 250, 2));
    recorded.stage.say("a", pointer("move", 330, 280, 1));
    recorded.check();
}

TEST_CASE("whatever happens, before and in a recording, the replay ends in the same state") {
    for (unsigned seed = 0; seed < 150; ++seed) {
        INFO("seed " << seed);
        RandomSession session(seed);
        session.play();
        session.recorded.check();
    }
}

TEST_CASE("a light of a file that is brighter than clients may make it is no hindrance") {
    const server::scenes::LoadedScene shown = scene_of(R"(vrut-text 1
geometry 1 vertices 3 -1 -1 0 1 -1 0 0 1 0 triangles 1 0 1 2 end
node 1 "Part" geometry geometry 1 end
node 2 "Key" light type point color 1.08 1.06 1.02 1 end
)",
                                                       "stage.vrut");
    Recorded recorded("a", shown);
    recorded.start();
    recorded.stage.say("a", R"({"type":"navigate","rotate":[5,0]})");
    const auto replayed = server::room::replay(
        recorded.log(),
        [&](const auto&...) -> tl::expected<server::scenes::LoadedScene, std::string> { return shown; });
    REQUIRE_MESSAGE(replayed, replayed.error());
    CHECK(replayed->state().camera.eye == recorded.stage.camera().eye);
}

// --- what is no good log

TEST_CASE("a log that is cut anywhere is played up to its last whole line, and says so") {
    Recorded recorded("a");
    recorded.start();
    std::vector<glm::dvec3> eyes{recorded.stage.camera().eye};
    std::vector<std::size_t> ends{recorded.folder.read("log.jsonl").size()};  // of the header and each line
    for (int i = 0; i < 3; ++i) {
        recorded.stage.say("a", R"({"type":"navigate","rotate":[5,0]})");
        eyes.push_back(recorded.stage.camera().eye);
        ends.push_back(recorded.folder.read("log.jsonl").size());
    }
    const std::string text = recorded.folder.read("log.jsonl");
    REQUIRE(text.size() == ends.back());
    for (std::size_t size = ends[0] - 1; size <= text.size(); ++size) {
        CAPTURE(size);
        const auto log = log_in(recorded.folder.write("cut.jsonl", text.substr(0, size)));
        REQUIRE_MESSAGE(log, log.error());
        // A line is whole though its end is missing.
        const auto next =
            std::find_if(ends.begin(), ends.end(), [&](std::size_t end) { return end > size + 1; });
        const auto whole = static_cast<std::size_t>(next - ends.begin()) - 1;
        CHECK(log->lines.size() == whole);
        CHECK(server::room::replay(*log, find_scene)->state().camera.eye == eyes[whole]);
        const bool at_end = std::find(ends.begin(), ends.end(), size) != ends.end();
        CHECK(log->cut.empty() == at_end);
        const auto line =
            1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size), '\n');
        if (!at_end) CHECK(holds(log->cut, "cut.jsonl:" + std::to_string(line) + ": "));
    }
    CHECK(holds(failure("{\"at\":1,\"cli\n{\"at\":2,\"event\":\"drawn\",\"frame\":1}\n"), "wrong.jsonl:2: "));
}

TEST_CASE("what is no log is told with file and line") {
    const TemporaryFolder folder;
    const auto error = [&](const std::string& text) {
        const auto log = log_in(folder.write("x.jsonl", text));
        REQUIRE_FALSE(log);
        return log.error();
    };
    CHECK(holds(error(""), "x.jsonl: the file is empty"));
    CHECK(holds(error("\n"), "x.jsonl:1: "));
    CHECK(holds(error("{\"log\":\"vrut-prev"), "x.jsonl:1: "));
    CHECK(holds(error("{\"log\":\"another\",\"version\":1}\n"), "'log'"));
    CHECK(holds(log_in(folder.path() / "none.jsonl").error(), "none.jsonl: it cannot be opened"));
}

TEST_CASE("what was kept of a scene that is opened, and of the one before, is in the log") {
    LoadedScene shown = first_scene(), other = other_scene();
    shown.changes = R"({"nodes":{"2":{"active":false}},"views":{"v":{"fov":30}}})";
    other.changes = R"({"views":{"home":{"fov":30}},"markers":{"m":{"point":[1,2,3]}}})";
    Recorded recorded("a", shown);
    recorded.start();
    recorded.stage.say("a", R"({"type":"patch","patch":{"markers":{"n":{"point":[1,1,1]}}}})");
    recorded.stage.room.show(other, 1s);
    recorded.stage.say("a", R"({"type":"navigate","rotate":[5,0]})");
    recorded.stage.say("a", R"({"type":"keydown","key":"Home","code":"Home"})");
    recorded.check();
    recorded.stage.say("a", R"({"type":"patch","patch":{"views":null,"markers":null}})");
    recorded.check();
}

TEST_CASE("a scene that is another one now is told") {
    Recorded recorded("a");
    recorded.start();
    recorded.stage.room.show(other_scene(), 1s);
    server::room::EventLog log = recorded.log();
    REQUIRE(log.lines.size() == 1);
    std::get<protocol::LogLine::Opened>(log.lines[0].what).sha256 = "ab12";
    CHECK(replay(log, find_scene).error() == "line 2: other.vrut is another one now");
    log.header.scene_sha256 = "ab12";
    CHECK(replay(log, find_scene).error() == "stage.vrut is another one now");
}

TEST_CASE("a message that cannot be played is told with its line and why") {
    const std::string good = R"({"at":1,"client":"a","message":{"type":"navigate","zoom":2}})"
                             "\n";
    CHECK(failure(good) == "");
    CHECK(failure(good + R"({"at":2,"client":"nobody","message":{"type":"navigate","zoom":2}})" + "\n") ==
          "line 3: a message that was accepted is rejected now: client 'nobody' is not there");
    CHECK(failure(good + R"({"at":2,"client":"a","message":{"type":"fit","node":99}})" + "\n") ==
          "line 3: a message that was accepted is rejected now: there is no node 99");
    CHECK(holds(failure(R"({"at":1,"client":"v","event":"connected","role":"view"})"
                        "\n"
                        R"({"at":1,"client":"v","message":{"type":"fit"}})"
                        "\n"),
                "line 3: "));
}

TEST_CASE("a header that does not fit its scene is told") {
    Recorded recorded("a");
    recorded.start();
    server::room::EventLog log = recorded.log();
    json state = *log.header.state;
    state["nodes"]["99"] = {{"active", false}};
    log.header.state = std::make_shared<const json>(state);
    CHECK(replay(log, find_scene).error() == "line 1: 'nodes': there is no node 99");
}

TEST_CASE("whoever watches a replay is told of each frame where it was drawn") {
    Recorded recorded("a");
    recorded.start();
    recorded.stage.say("a", R"({"type":"fly","keyframes":[{"at":100,"camera":{"eye":[1,0,4]}}]})");
    recorded.stage.at(100ms);
    recorded.stage.room.remember(7);
    recorded.stage.say("a", R"({"type":"navigate","zoom":2})");
    recorded.stage.room.remember(8);
    std::vector<std::pair<std::int64_t, double>> seen;
    server::room::ReplayWatcher watcher;
    watcher.on_drawn = [&](std::int64_t frame, const Room& room) {
        seen.emplace_back(frame, room.visible().camera.eye.z);
    };
    REQUIRE(server::room::replay(recorded.log(), find_scene, watcher));
    CHECK(seen == std::vector<std::pair<std::int64_t, double>>{{7, 4.0}, {8, 2.0}});
}
