// A room that follows another by its journal, as a server does that stands by.
#include <doctest/doctest.h>

#include <random>

#include "event_log.hpp"
#include "room/replay.hpp"
#include "stage.hpp"

using namespace stage;

namespace {

/// A room that writes a journal, and one that follows it; the lines come as text.
class Pair {
public:
    Pair()
        : leader("", scene_with_a_door(), options_of_leader()), follower(scene_with_a_door(), following()) {}

    static RoomOptions following() {
        RoomOptions options;
        options.policy = kFollow;
        return options;
    }

    /// What a server does behind each batch of events.
    void publish() {
        leader.room.write_revision();
        for (const std::string& text : std::exchange(lines, {})) {
            const auto line = protocol::decode_log_line(text);
            REQUIRE_MESSAGE(line.has_value(), text << ": " << line.error().message);
            const auto wrong = play(follower, *line, [](const auto&...) { return other_scene(); });
            REQUIRE_MESSAGE(!wrong, text << ": " << wrong.value_or(""));
        }
    }
    void check_equal() {
        CHECK(follower.document()->json() == leader.room.document()->json());
        CHECK(follower.document()->revision() == leader.room.document()->revision());
        CHECK(follower.state().camera == leader.camera());
        CHECK(follower.holder() == leader.room.holder());
        CHECK(follower.view_size() == leader.room.view_size());
        // An end that changes nothing has no line: the follower comes to it by the next one.
        add(told(leader.room), by_leader);
        add(told(follower), by_follower);
        REQUIRE(by_follower.size() <= by_leader.size());
        for (std::size_t i = 0; i < by_follower.size(); ++i) CHECK(by_follower[i] == by_leader[i]);
    }
    /// Once both have come to the same time.
    void check_equal_at_the_end() {
        publish();
        follower.advance(leader.now);
        check_equal();
        CHECK(by_follower.size() == by_leader.size());
    }
    static void add(const json& answers, std::vector<json>& all) {
        all.insert(all.end(), answers.begin(), answers.end());
    }
    /// The answers but for rejections, of which the journal does not know, and for revisions between two
    /// lines.
    static json told(Room& room) {
        json all = json::array();
        for (const Answer& answer : room.take_answers()) {
            if (!answer.rejection.empty()) continue;
            all.push_back(json::parse(answer.text));
            all.back()["to"] = answer.client;
            all.back().erase("revision");
        }
        return all;
    }

    std::vector<std::string> lines;
    std::vector<json> by_leader, by_follower;  ///< answers
    Stage leader;
    Room follower;

private:
    RoomOptions options_of_leader() {
        RoomOptions options;
        options.journal = [this](const protocol::LogLine& line) { lines.push_back(encode(line)); };
        return options;
    }
};

std::string pointer(const char* what, double x, double y, int buttons) {
    return json{{"type", std::string("pointer") + what},
                {"pointerId", 1},
                {"pointerType", "touch"},
                {"x", x},
                {"y", y},
                {"button", buttons == 0 || *what == 'd' ? 0 : -1},
                {"buttons", buttons}}
        .dump();
}

/// Something that a client may do, right or wrong.
std::string anything(std::mt19937& dice, int id) {
    const auto number = [&](int most) { return static_cast<int>(dice() % static_cast<unsigned>(most)); };
    const std::string with_id = R"("id":)" + std::to_string(id);
    const std::string x = std::to_string(number(400)), y = std::to_string(number(300));
    const std::string cue = std::to_string(number(3));
    switch (number(14)) {
        case 0:
            return pointer("down", number(1280), number(720), 1);
        case 1:
        case 2:
            return pointer("move", number(1280), number(720), 1);
        case 3:
            return pointer("up", number(1280), number(720), 0);
        case 4:
            return R"({"type":"navigate",)" + with_id + R"(,"rotate":[)" + x + "," + y + "]}";
        case 5:
            return R"({"type":"swing",)" + with_id + R"(,"node":1})";
        case 6:
            return R"({"type":"patch",)" + with_id + R"(,"patch":{"markers":{"m)" + x + R"(":{"point":[)" +
                   x + R"(,1,2]}}}})";
        case 7:
            return R"({"type":"patch",)" + with_id + R"(,"ifRevision":1,"patch":{"selection":{"node":2}}})";
        case 8:
            return R"({"type":"control",)" + with_id + R"(,"action":")" + (number(2) ? "take" : "release") +
                   R"("})";
        case 9:
            return R"({"type":"resize",)" + with_id + R"(,"width":)" + std::to_string(300 + number(99)) +
                   R"(,"height":300,"pixelRatio":1})";
        case 10:
            return R"({"type":"fly",)" + with_id + R"(,"keyframes":[{"at":0,"camera":{}},{"at":)" +
                   std::to_string(100 + number(900)) + R"(,"camera":{"eye":[)" + x + R"(,2,9]}}]})";
        case 11:
            return R"({"type":"patch",)" + with_id + R"(,"patch":{"cues":{"cue )" + cue + R"(":)" +
                   (number(4) ? R"({"ms":)" + std::to_string(number(900)) + R"(,"camera":null,"nodes":null}})"
                              : "null}") +
                   "}}";
        case 12:
            return R"({"type":"cue",)" + with_id +
                   (number(2) ? R"(,"name":"cue )" + cue + R"("})" : R"(,"step":1})");
        default:
            return R"({"type":"pick",)" + with_id + R"(,"x":)" + x + R"(,"y":)" + y + R"(,"then":"select"})";
    }
}

}  // namespace

TEST_CASE("a room that follows another has its state, its revision and its camera, to the last bit") {
    for (unsigned seed = 1; seed <= 30; ++seed) {
        CAPTURE(seed);
        std::mt19937 dice(seed);
        Pair pair;
        std::vector<std::string> here;
        for (int step = 1; step <= 120; ++step) {
            pair.leader.at(pair.leader.now + std::chrono::microseconds(dice() % 200'000));
            if (here.empty() || (dice() % 20 == 0 && here.size() < 4)) {
                here.push_back("c" + std::to_string(step));
                const std::string key = dice() % 2 ? "key " + std::to_string(dice() % 3) : "";
                const auto role = dice() % 4 ? protocol::Role::control : protocol::Role::host;
                pair.leader.room.join(here.back(), role, pair.leader.now, {}, key);
            } else if (dice() % 25 == 0) {
                const auto leaving = here.begin() + static_cast<std::ptrdiff_t>(dice() % here.size());
                pair.leader.room.leave(*leaving, pair.leader.now);
                here.erase(leaving);
            } else if (dice() % 5 == 0) {
                pair.leader.room.remember(step);
            } else if (dice() % 60 == 0) {
                pair.leader.room.show(other_scene(), pair.leader.now);
            } else {
                pair.leader.say(here[dice() % here.size()], anything(dice, step));
            }
            // As a server does, but not each time.
            if (dice() % 3 == 0) {
                pair.publish();
                pair.check_equal();
            }
        }
        pair.check_equal_at_the_end();
    }
}

TEST_CASE("a room goes on from a checkpoint, and takes over who holds control and who has to come back") {
    Pair pair;
    pair.leader.room.join("a", protocol::Role::control, 0ms, "Ann", "key of a");
    pair.leader.room.join("b", protocol::Role::control, 0ms, "Bob", "key of b");
    pair.leader.say("a", R"({"type":"patch","id":1,"patch":{"markers":{"here":{"point":[1,2,3]}}}})");
    pair.leader.at(2s);
    pair.leader.room.write_revision();
    const auto checkpoint = pair.leader.room.checkpoint();
    REQUIRE(checkpoint);
    pair.lines.clear();
    Pair::told(pair.leader.room);

    const auto header = protocol::decode_log_header(encode(checkpoint->header));
    REQUIRE(header);
    Room& follower = pair.follower;
    REQUIRE(follower.restore(*header));
    follower.follow(checkpoint->revised, 2s);
    pair.check_equal();

    pair.leader.say("a", R"({"type":"navigate","id":2,"rotate":[10,20]})");
    pair.leader.room.leave("a", 3s);  // it may come back
    pair.leader.now = 3s;
    pair.publish();
    pair.check_equal();
    CHECK(follower.holder() == "a");

    follower.go_on({});
    SUBCASE("who comes back in time has control again") {
        follower.join("a2", protocol::Role::control, 5s, "Ann", "key of a");
        CHECK(follower.holder() == "a2");
    }
    SUBCASE("who does not loses it") {
        follower.advance(3s + Steering::kAbsence);
        CHECK(follower.holder() == "b");
    }
    SUBCASE("what is said is judged again") {
        const auto patch =
            protocol::decode(R"({"type":"patch","id":9,"ifRevision":1,"patch":{"markers":{"here":null}}})");
        CHECK_FALSE(follower.handle_message("b", *patch, 4s));
    }
}

TEST_CASE("there is no checkpoint while something goes on that it would not hold") {
    Pair pair;
    pair.leader.room.join("a", protocol::Role::control, 0ms);
    REQUIRE(pair.leader.room.checkpoint());
    pair.leader.say("a", R"({"type":"swing","id":1,"node":1})");
    CHECK_FALSE(pair.leader.room.checkpoint());
    pair.leader.at(2s);
    CHECK(pair.leader.room.checkpoint());
    pair.leader.room.join("h", protocol::Role::host, 2s);
    CHECK(pair.leader.room.checkpoint());
    pair.leader.say("a", R"({"type":"navigate","id":2,"rotate":[300,0]})");
    CHECK_FALSE(pair.leader.room.checkpoint());  // the walls follow
    pair.leader.at(9s);
    CHECK(pair.leader.room.checkpoint());
    pair.leader.say("a", pointer("down", 1, 1, 1));
    CHECK_FALSE(pair.leader.room.checkpoint());
}
