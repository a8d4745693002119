// Logs as they are written: how they begin, and how they end.
#include <sched.h>
#include <spdlog/spdlog.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include "event_log_file.hpp"
#include "folder_of_logs.hpp"
#include "full_disk.hpp"
#include "room/replay.hpp"
#include "stage.hpp"
#include "temporary_folder.hpp"

using namespace stage;

namespace {

const std::string kStart = R"({"type":"record","id":1,"action":"start","name":"take-1"})";
const std::string kStop = R"({"type":"record","id":2,"action":"stop"})";
const std::string kTurn = R"({"type":"navigate","id":3,"rotate":[5,0]})";

/// A stage that records into a folder.
struct RecordedStage : FolderOfLogs, Stage {
    RecordedStage(const std::string& clients, const std::filesystem::path& folder)
        : FolderOfLogs(folder), Stage(clients, stage::first_scene(), options()) {
        after_message = [this](Stage& to) { tell_results(to); };
    }
};

struct Quiet {
    Quiet() { spdlog::set_level(spdlog::level::off); }
    ~Quiet() { spdlog::set_level(spdlog::level::info); }
};

}  // namespace

TEST_CASE("a full disk ends the recording, and nothing else") {
    const Quiet quiet;
    const TemporaryFolder folder;
    RecordedStage stage("a", folder.path());
    REQUIRE(stage.rejection("a", kStart) == "");
    CHECK(stage.state()["recording"]["name"] == "take-1");
    const auto size = std::filesystem::file_size(folder.path() / "take-1.jsonl");
    bool accepted = false;
    {
        const FullDisk full(size + 10);
        accepted = stage.say("a", kTurn);
    }
    CHECK(accepted);
    CHECK(stage.told().at(0)["type"] == "ok");
    CHECK_FALSE(stage.state().contains("recording"));
    CHECK(stage.state()["notices"] ==
          json::array({{{"code", "recording-ended"},
                        {"message", "The recording 'take-1' has ended: File too large"}}}));
    CHECK(std::filesystem::file_size(folder.path() / "take-1.jsonl") <= size + 10);
    const auto log = log_in(folder.path() / "take-1.jsonl");
    REQUIRE_MESSAGE(log, log.error());
    CHECK(log->lines.empty());
    CHECK(log->cut.find("take-1.jsonl:2: ") != std::string::npos);
    CHECK(stage.rejection("a", kStop) == "failed");
    CHECK(stage.rejection("a", kTurn) == "");
    CHECK(stage.rejection("a", R"({"type":"record","action":"start","name":"take-2"})") == "");
    CHECK(stage.state()["recording"]["name"] == "take-2");
}

/// In a folder on a disk of 256 KiB, which nothing else sees.
int fill_a_small_disk(const std::filesystem::path& folder) {
    if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return 77;
    if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        mount("none", folder.c_str(), "tmpfs", 0, "size=256k") != 0)
        return 77;
    RecordedStage stage("ab", folder);
    if (stage.rejection("a", kStart) != "") return 1;
    int received = 0;
    while (stage.state().contains("recording") && received < 100'000) {
        ++received;
        if (!stage.say("a", kTurn)) return 2;  // nobody is refused for it
    }
    if (stage.state()["notices"] !=
        json::array({{{"code", "recording-ended"},
                      {"message", "The recording 'take-1' has ended: No space left on device"}}}))
        return 3;
    const auto log = log_in(folder / "take-1.jsonl");
    if (!log) return 4;
    // All but what did not fit.
    if (log->lines.size() + 1 != static_cast<std::size_t>(received)) return 5;
    return stage.say("a", kTurn) ? 0 : 6;
}

TEST_CASE("a disk that is full in truth") {
    const Quiet quiet;
    const TemporaryFolder folder;
    const pid_t child = fork();
    if (child == 0) _exit(fill_a_small_disk(folder.path()));
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    REQUIRE(WIFEXITED(status));
    if (WEXITSTATUS(status) == 77)
        MESSAGE("no disk can be made here");
    else
        CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("record is refused for what is wrong with it") {
    const Quiet quiet;
    const TemporaryFolder folder;
    folder.write("take-1.jsonl", "");
    Stage without("a");
    CHECK(without.rejection("a", kStart) == "not-allowed");
    RecordedStage stage("a", folder.path());
    CHECK(stage.rejection("a", kStart) == "failed");
    CHECK(stage.rejection("a", kStop) == "failed");
    const std::string another = R"({"type":"record","id":4,"action":"start","name":"take-2"})";
    CHECK(stage.say("a", another));
    const json told = stage.told().back();
    CHECK(told["name"] == "take-2");
    CHECK(stage.rejection("a", R"({"type":"record","action":"start","name":"take-3"})") == "busy");
    CHECK_FALSE(std::filesystem::exists(folder.path() / "take-3.jsonl"));
    CHECK(stage.say("a", kStop));
    CHECK(stage.told().back()["name"] == "take-2");
    CHECK_FALSE(stage.state().contains("recording"));
}

TEST_CASE("a log has what was accepted, who came and went, and nothing that was refused") {
    const Quiet quiet;
    const TemporaryFolder folder;
    RecordedStage stage("ab", folder.path());
    stage.at(2s);
    stage.say("a", kStart);
    stage.at(2001500us);
    stage.say("a", kTurn);
    stage.say("b", kTurn);                                    // not in control
    stage.say("a", R"({"type":"fit","node":99})");            // unknown
    stage.say("b", R"({"type":"pick","id":8,"x":1,"y":1})");  // steers nothing, but counts
    stage.at(2500ms);
    stage.join('v');
    stage.room.leave("b", stage.now);
    stage.room.remember(17);
    stage.room.show(other_scene(), stage.now);
    stage.say("a", kStop);
    stage.say("a", kTurn);

    std::istringstream text(folder.read("take-1.jsonl"));
    std::vector<json> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(json::parse(line));
    REQUIRE(lines.size() == 8);
    CHECK(lines[0]["scene"] == "stage.vrut");
    CHECK(lines[0]["sceneSha256"] == "sha of stage.vrut");
    CHECK(lines[0]["clients"].size() == 2);
    CHECK(lines[0]["state"]["control"]["holder"] == "a");
    CHECK(lines[1] ==
          json::parse(R"({"at":1.5,"client":"a","message":{"type":"navigate","id":3,"rotate":[5,0]}})"));
    CHECK(lines[2]["message"]["type"] == "pick");
    CHECK(lines[3] == json::parse(R"({"at":500,"client":"v","event":"connected","role":"view"})"));
    CHECK(lines[4] == json::parse(R"({"at":500,"client":"b","event":"disconnected"})"));
    CHECK(lines[5] == json::parse(R"({"at":500,"event":"drawn","frame":17})"));
    CHECK(
        lines[6] ==
        json::parse(R"({"at":500,"event":"opened","scene":"other.vrut","sceneSha256":"sha of other.vrut"})"));
    CHECK(lines[7]["message"] == json::parse(R"({"type":"record","id":2,"action":"stop"})"));
}

TEST_CASE("a recording whose first line cannot be written is refused, and is not in the state") {
    const Quiet quiet;
    const TemporaryFolder folder;
    RecordedStage stage("a", folder.path());
    {
        const FullDisk full(10);
        CHECK(stage.rejection("a", kStart) == "failed");
    }
    CHECK_FALSE(stage.state().contains("recording"));
    CHECK(stage.rejection("a", R"({"type":"record","id":5,"action":"start","name":"take-2"})") == "");
    CHECK(stage.state()["recording"]["name"] == "take-2");
}

namespace {

/// A sink that answers when its test says so.
struct LateSink {
    std::int64_t begun = 0, ended = 0;
    RecordingSink::Header header;
    std::vector<json> lines;

    RoomOptions options() {
        RoomOptions options;
        options.recordings = {
            [this](std::int64_t recording, const std::string&, RecordingSink::Header first) {
                begun = recording;
                header = std::move(first);
            },
            [this](std::int64_t, const std::string& line) { lines.push_back(json::parse(line)); },
            [this](std::int64_t recording) { ended = recording; }};
        return options;
    }
};

}  // namespace

TEST_CASE("a recording is in the state and answered when its file is open, and has what came before that") {
    LateSink sink;
    Stage stage("ab", first_scene(), sink.options());
    CHECK(stage.say("a", kStart));
    CHECK(stage.say("a", kTurn));
    CHECK(sink.lines.size() == 1);
    CHECK(stage.told().back()["id"] == 3);
    CHECK_FALSE(stage.state().contains("recording"));
    CHECK(stage.rejection("a", R"({"type":"record","id":5,"action":"start"})") == "busy");
    stage.room.recording_opened(sink.begun, "take-1", stage.now);
    CHECK(stage.told().at(0) ==
          json{{"type", "ok"}, {"id", 1}, {"name", "take-1"}, {"revision", stage.revision()}, {"to", "a"}});
    CHECK(stage.state()["recording"]["name"] == "take-1");
    CHECK(sink.lines.size() == 1);
    const json header = json::parse(sink.header("take-1", "now"));
    CHECK(header["state"]["recording"]["name"] == "take-1");
    CHECK(header["state"]["camera"]["eye"] == json{1, 0, 8});  // as it was when that came
}

TEST_CASE("a file that cannot be opened refuses the message") {
    LateSink sink;
    Stage stage("a", first_scene(), sink.options());
    stage.say("a", kStart);
    stage.room.recording_opened(sink.begun, tl::unexpected(std::string("no")), stage.now);
    const json told = stage.told().at(0);
    CHECK(told["code"] == "failed");
    CHECK(told["message"] == "no");
    CHECK(stage.rejection("a", kStop) == "failed");
}

TEST_CASE("the end is answered when all is written; meanwhile another may begin") {
    LateSink sink;
    Stage stage("a", first_scene(), sink.options());
    stage.say("a", kStart);
    const std::int64_t first = sink.begun;
    stage.say("a", kStop);  // before its file is open
    CHECK(sink.ended == first);
    CHECK(stage.told().empty());
    stage.room.recording_opened(first, "take-1", stage.now);
    CHECK(stage.told().at(0)["id"] == 1);
    CHECK_FALSE(stage.state().contains("recording"));
    stage.say("a", R"({"type":"record","id":7,"action":"start"})");
    CHECK(sink.begun != first);
    stage.room.recording_ended(first, std::nullopt, stage.now);
    const json told = stage.told().at(0);
    CHECK(told["id"] == 2);
    CHECK(told["name"] == "take-1");
    stage.room.recording_opened(sink.begun, "take-2", stage.now);
    CHECK(stage.state()["recording"]["name"] == "take-2");
    stage.room.recording_ended(sink.begun, "its disk is too slow", stage.now);
    CHECK_FALSE(stage.state().contains("recording"));
    CHECK(stage.state()["notices"] ==
          json::array({{{"code", "recording-ended"},
                        {"message", "The recording 'take-2' has ended: its disk is too slow"}}}));
}

TEST_CASE("an end that cannot be written is refused, with a notice") {
    LateSink sink;
    Stage stage("a", first_scene(), sink.options());
    stage.say("a", kStart);
    stage.room.recording_opened(sink.begun, "take-1", stage.now);
    stage.say("a", kStop);
    stage.told();
    stage.room.recording_ended(sink.begun, "its disk is too slow", stage.now);
    CHECK(stage.told().at(0)["code"] == "failed");
    CHECK(stage.state()["notices"].size() == 1);
}

TEST_CASE("who left before the file was open is not answered, and the recording goes on") {
    LateSink sink;
    Stage stage("ab", first_scene(), sink.options());
    stage.say("a", kStart);
    stage.room.leave("a", stage.now);
    stage.room.recording_opened(sink.begun, "take-1", stage.now);
    CHECK(stage.told().empty());
    CHECK(stage.state()["recording"]["name"] == "take-1");
    CHECK(stage.holder() == "b");
}

TEST_CASE("open is answered when its file was looked for, and steers and is recorded then") {
    LateSink sink;
    std::int64_t request = 0;
    RoomOptions options = sink.options();
    options.load = [&](std::int64_t number, const protocol::Open&) { request = number; };
    Stage stage("ab", first_scene(), std::move(options));
    const std::string open = R"({"type":"open","id":9,"scene":"x.vrut"})";
    stage.say("a", kStart);
    stage.at(1s);
    CHECK_FALSE(stage.say("a", open));
    CHECK(stage.told().empty());
    stage.room.load_answered(request, protocol::Error{{}, "refused-scene", "no"}, stage.now);
    CHECK(stage.told().at(0)["code"] == "refused-scene");
    CHECK(sink.lines.empty());
    stage.say("a", R"({"type":"open","id":10,"scene":"y.vrut"})");
    stage.room.load_answered(request, std::nullopt, stage.now);
    CHECK(stage.told().at(0)["id"] == 10);
    CHECK(sink.lines.at(0)["message"]["scene"] == "y.vrut");
    stage.room.load_answered(request, std::nullopt, stage.now);  // answered once
    CHECK(stage.told().empty());
}
