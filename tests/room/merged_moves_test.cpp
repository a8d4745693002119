// Messages that come while the server is busy, of which the mailbox merges moves: a burst leads to the same
// camera as the same messages one by one.
#include <random>

#include "engine/mailbox.hpp"
#include "event_log_file.hpp"
#include "folder_of_logs.hpp"
#include "stage.hpp"
#include "temporary_folder.hpp"

using namespace stage;
using server::engine::Mailbox;
using server::engine::MessageReceived;

namespace {

/// A message about a pointer at `place`, in CSS pixels; `touched` is left out where it is null.
json pointer(const char* what, int id, const char* device, glm::dvec2 place, int button, int buttons,
             const json& touched = nullptr) {
    json message{{"type", std::string("pointer") + what},
                 {"pointerId", id},
                 {"pointerType", device},
                 {"x", place.x},
                 {"y", place.y},
                 {"button", button},
                 {"buttons", buttons}};
    if (!touched.is_null()) message["touched"] = touched;
    return message;
}

json finger(const char* what, int id, glm::dvec2 place, const json& touched = nullptr) {
    const bool moves = std::string(what) == "move", is_down = std::string(what) != "up";
    return pointer(what, id, "touch", place, moves ? -1 : 0, is_down ? 1 : 0, touched);
}

/// The stage's `a` has said `batches`, of which each was in the mailbox at once.
class Session {
public:
    Session(const json& start, const std::vector<std::vector<json>>& batches)
        : logs_(folder_.path()), stage_("a", first_scene(), logs_.options()) {
        stage_.after_message = [this](Stage& stage) { logs_.tell_results(stage); };
        say(R"({"type":"record","action":"start","name":"log"})"_json);
        say(R"({"type":"resize","width":640,"height":400,"pixelRatio":1})"_json);
        say({{"type", "patch"}, {"patch", start}});
        Mailbox mailbox;
        for (const std::vector<json>& batch : batches) {
            for (json message : batch) {
                message["id"] = ++id_;
                mailbox.push(received(message));
            }
            for (const auto& event : mailbox.wait(server::base::Clock::now())) {
                const auto& message = *std::get<MessageReceived>(event).message;
                CHECK(stage_.room.handle_message("a", message, stage_.now));
            }
        }
    }
    const protocol::CameraState& camera() const { return stage_.camera(); }
    /// What its log leads to.
    protocol::CameraState replayed_camera() const {
        const auto log = log_in(folder_.path() / "log.jsonl");
        REQUIRE_MESSAGE(log, log.error());
        const auto find_scene = [](const auto&...) { return first_scene(); };
        const auto room = replay(*log, find_scene);
        REQUIRE_MESSAGE(room, room.error());
        return room->state().camera;
    }

private:
    void say(const json& message) { REQUIRE(stage_.say("a", message.dump())); }
    static MessageReceived received(const json& message) {
        MessageReceived said;
        said.client = "a";
        said.message = protocol::decode(message.dump());
        REQUIRE_MESSAGE(said.message, said.message.error().message);
        return said;
    }

    TemporaryFolder folder_;
    FolderOfLogs logs_;
    Stage stage_;
    int id_ = 0;
};

const json kStartState = {
    {"camera",
     {{"eye", {0, 0, 30}}, {"focus", {0, 0, 0}}, {"up", {0, 1, 0}}, {"center", {0, 0, 0}}, {"fov", 45}}},
    {"navigation", {{"turnAbout", "touched"}}}};
const json kTouched = {2.25, 0.75, -13.5};

void check_burst(const std::vector<json>& messages) {
    std::vector<std::vector<json>> one_by_one;
    for (const json& message : messages) one_by_one.push_back({message});
    const Session walk(kStartState, one_by_one), burst(kStartState, {messages});
    CHECK(burst.camera() == walk.camera());
    CHECK(walk.replayed_camera() == walk.camera());
    CHECK(burst.replayed_camera() == walk.camera());
}

}  // namespace

TEST_CASE("a pan in one burst is about the point that its first move says") {
    check_burst({pointer("down", 1, "mouse", {345, 191.7}, 2, 2),
                 pointer("move", 1, "mouse", {365, 191.7}, -1, 2, kTouched),
                 pointer("move", 1, "mouse", {385, 195.2}, -1, 2),
                 pointer("move", 1, "mouse", {405, 200.7}, -1, 2),
                 pointer("up", 1, "mouse", {405, 200.7}, 2, 0)});
}

TEST_CASE("a turn in one burst is about the point that its first move says") {
    check_burst({finger("down", 1, {345, 191.7}), finger("move", 1, {365, 191.7}, kTouched),
                 finger("move", 1, {385, 195.2}), finger("move", 1, {405, 200.7}),
                 finger("up", 1, {405, 200.7})});
}

TEST_CASE("a pinch in one burst is about the point that the first move of either finger says") {
    for (const int first : {1, 2}) {
        const int second = 3 - first;
        check_burst({finger("down", 1, {300, 190}), finger("down", 2, {360, 210}),
                     finger("move", first, {300, 180}, kTouched), finger("move", second, {370, 215}),
                     finger("move", first, {290, 175}), finger("move", second, {380, 220}),
                     finger("move", first, {280, 165}), finger("move", second, {390, 230}),
                     finger("up", 2, {390, 230}), finger("up", 1, {280, 165})});
    }
}

TEST_CASE("what a later move says has been touched counts in a burst no more than one by one") {
    for (const std::size_t later : {2U, 3U}) {
        std::vector<json> messages{
            pointer("down", 1, "mouse", {345, 191.7}, 2, 2), pointer("move", 1, "mouse", {365, 191.7}, -1, 2),
            pointer("move", 1, "mouse", {385, 195.2}, -1, 2),
            pointer("move", 1, "mouse", {405, 200.7}, -1, 2), pointer("up", 1, "mouse", {405, 200.7}, 2, 0)};
        messages[later]["touched"] = kTouched;
        check_burst(messages);
    }
}

TEST_CASE("wheel steps in one burst go each to the point that it says") {
    json step{{"type", "wheel"}, {"x", 345}, {"y", 191.7}, {"deltaX", 0}, {"deltaY", -100}, {"deltaMode", 0}};
    std::vector<json> steps(3, step);
    steps[0]["touched"] = kTouched;
    steps[2]["touched"] = {1, 2, 3};
    check_burst(steps);
}

TEST_CASE("fingers that move at random lead to one camera, however their messages come together") {
    std::mt19937 random(1);
    const auto below = [&](unsigned end) { return static_cast<int>(random() % end); };
    const auto place = [&] { return glm::dvec2(100 + below(400), 50 + below(300)); };
    for (int trial = 0; trial < 100; ++trial) {
        CAPTURE(trial);
        std::vector<json> messages{finger("down", 1, place()), finger("down", 2, place())};
        for (int move = 0; move < 12; ++move) {
            const json touched = json::array({below(9) - 4, below(9) - 4, below(9) - 4});
            messages.push_back(finger("move", 1 + below(2), place(), below(3) ? json() : touched));
        }
        messages.push_back(finger("up", 1, place()));
        for (int move = 0; move < 4; ++move) messages.push_back(finger("move", 2, place()));

        std::vector<std::vector<json>> one_by_one, batches{{}};
        for (const json& message : messages) {
            one_by_one.push_back({message});
            if (below(4) == 0) batches.emplace_back();
            batches.back().push_back(message);
        }
        const Session walk(kStartState, one_by_one), bursts(kStartState, batches);
        CHECK(bursts.camera() == walk.camera());
        CHECK(bursts.replayed_camera() == walk.camera());
    }
}
