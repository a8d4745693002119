// Logs as they are written: how they begin, and how they end.
#include "room/recorder.hpp"

#include <sched.h>
#include <spdlog/spdlog.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include "full_disk.hpp"
#include "room/replay.hpp"
#include "stage.hpp"
#include "temporary_folder.hpp"

using namespace stage;

namespace {

const std::string kStart = R"({"type":"record","id":1,"action":"start","name":"take-1"})";
const std::string kStop = R"({"type":"record","id":2,"action":"stop"})";
const std::string kTurn = R"({"type":"navigate","id":3,"rotate":[5,0]})";

server::room::PresentationOptions recording_to(const std::filesystem::path& folder) {
    server::room::PresentationOptions options;
    options.record_folder = folder;
    return options;
}

struct Quiet {
    Quiet() { spdlog::set_level(spdlog::level::off); }
    ~Quiet() { spdlog::set_level(spdlog::level::info); }
};

}  // namespace

TEST_CASE("lines are in the file as soon as they are written") {
    const Quiet quiet;
    const TemporaryFolder folder;
    server::room::Recorder recorder(folder.path());
    CHECK(recorder.has_folder());
    CHECK_FALSE(recorder.active());
    CHECK(recorder.open("a_B-9") == "a_B-9");
    CHECK(recorder.active());
    recorder.write("one");
    recorder.write("two");
    CHECK(folder.read("a_B-9.jsonl") == "one\ntwo\n");
    recorder.close();
    CHECK_FALSE(recorder.active());
    CHECK(recorder.open("next") == "next");
    recorder.write("three");
    CHECK(folder.read("next.jsonl") == "three\n");
    CHECK(folder.read("a_B-9.jsonl") == "one\ntwo\n");
}

TEST_CASE("a name that is taken is refused, and its file left alone") {
    const Quiet quiet;
    const TemporaryFolder folder;
    folder.write("mine.jsonl", "precious");
    server::room::Recorder recorder(folder.path());
    const auto opened = recorder.open("mine");
    REQUIRE_FALSE(opened);
    CHECK(opened.error().find("'mine'") != std::string::npos);
    CHECK_FALSE(recorder.active());
    CHECK(folder.read("mine.jsonl") == "precious");
}

TEST_CASE("without a name one is made, each time another") {
    const Quiet quiet;
    const TemporaryFolder folder;
    server::room::Recorder recorder(folder.path());
    std::vector<std::string> names;
    for (int i = 0; i < 3; ++i) {
        const auto name = recorder.open("");
        REQUIRE(name);
        CHECK(name->starts_with("session-20"));
        CHECK(std::filesystem::exists(folder.path() / (*name + ".jsonl")));
        CHECK(std::find(names.begin(), names.end(), *name) == names.end());
        names.push_back(*name);
        recorder.close();
    }
}

TEST_CASE("a folder that is gone is told, and the next recording is not hurt by it") {
    const Quiet quiet;
    const TemporaryFolder folder;
    const std::filesystem::path below = folder.path() / "logs";
    server::room::Recorder recorder(below);
    const auto opened = recorder.open("log");
    REQUIRE_FALSE(opened);
    CHECK(opened.error().find("log.jsonl") != std::string::npos);
    CHECK_FALSE(recorder.active());
    std::filesystem::create_directory(below);
    REQUIRE(recorder.open("log"));
    recorder.write("line");
    CHECK(recorder.active());
}

TEST_CASE("a log that has grown to the largest size ends with the line that made it so") {
    const Quiet quiet;
    const TemporaryFolder folder;
    server::room::Recorder recorder(folder.path(), 8);
    REQUIRE(recorder.open("small"));
    recorder.write("abc");
    CHECK(recorder.active());
    recorder.write("def");  // now 8 bytes
    CHECK_FALSE(recorder.active());
    CHECK(folder.read("small.jsonl") == "abc\ndef\n");
    CHECK(recorder.end() == "The recording 'small' has ended: it has grown too large");
    REQUIRE(recorder.open("another"));  // counts anew
    recorder.write("abc");
    CHECK(recorder.active());
}

TEST_CASE("a full disk ends the recording, and nothing else") {
    const Quiet quiet;
    const TemporaryFolder folder;
    Stage stage("a", scene(), recording_to(folder.path()));
    REQUIRE(stage.refusal("a", kStart) == "");
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
    CHECK(stage.state()["notices"] == json{"The recording 'take-1' has ended: File too large"});
    CHECK(std::filesystem::file_size(folder.path() / "take-1.jsonl") <= size + 10);
    const auto log = server::room::read_event_log(folder.path() / "take-1.jsonl");
    REQUIRE_MESSAGE(log, log.error());
    CHECK(log->lines.empty());
    CHECK(log->cut.find("take-1.jsonl:2: ") != std::string::npos);
    CHECK(stage.refusal("a", kStop) == "failed");
    CHECK(stage.refusal("a", kTurn) == "");
    CHECK(stage.refusal("a", R"({"type":"record","action":"start","name":"take-2"})") == "");
    CHECK(stage.state()["recording"]["name"] == "take-2");
}

/// In a folder on a disk of 256 KiB, which nothing else sees.
int fill_a_small_disk(const std::filesystem::path& folder) {
    if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return 77;
    if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        mount("none", folder.c_str(), "tmpfs", 0, "size=256k") != 0)
        return 77;
    Stage stage("ab", scene(), recording_to(folder));
    if (stage.refusal("a", kStart) != "") return 1;
    int said = 0;
    while (stage.state().contains("recording") && said < 100'000) {
        ++said;
        if (!stage.say("a", kTurn)) return 2;  // nobody is refused for it
    }
    if (stage.state()["notices"] != json{"The recording 'take-1' has ended: No space left on device"})
        return 3;
    const auto log = server::room::read_event_log(folder / "take-1.jsonl");
    if (!log) return 4;
    // All but what did not fit.
    if (log->lines.size() + 1 != static_cast<std::size_t>(said)) return 5;
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

TEST_CASE("a recording whose disk takes too long ends, with the line that it took") {
    const Quiet quiet;
    const TemporaryFolder folder;
    server::room::Recorder recorder(folder.path(), server::room::Recorder::kLargest,
                                    0ms);  // any time is too long
    REQUIRE(recorder.open("slow"));
    recorder.write("abc");
    CHECK_FALSE(recorder.active());
    CHECK(recorder.end() == "The recording 'slow' has ended: its disk is too slow");
    CHECK(folder.read("slow.jsonl") == "abc\n");
}

TEST_CASE("record is refused for what is wrong with it, and then nobody steers") {
    const Quiet quiet;
    const TemporaryFolder folder;
    folder.write("take-1.jsonl", "");
    Stage without("a");
    CHECK(without.refusal("a", kStart) == "not-allowed");
    Stage stage("a", scene(), recording_to(folder.path()));
    CHECK(stage.refusal("a", kStart) == "failed");
    CHECK(stage.refusal("a", kStop) == "failed");
    CHECK(stage.holder() == "");
    const std::string another = R"({"type":"record","id":4,"action":"start","name":"take-2"})";
    CHECK(stage.say("a", another));
    const json told = stage.told().back();
    CHECK(told["name"] == "take-2");
    CHECK(stage.refusal("a", R"({"type":"record","action":"start","name":"take-3"})") == "busy");
    CHECK_FALSE(std::filesystem::exists(folder.path() / "take-3.jsonl"));
    CHECK(stage.say("a", kStop));
    CHECK(stage.told().back()["name"] == "take-2");
    CHECK_FALSE(stage.state().contains("recording"));
}

TEST_CASE("a log has what was accepted, who came and went, and nothing that was refused") {
    const Quiet quiet;
    const TemporaryFolder folder;
    Stage stage("ab", scene(), recording_to(folder.path()));
    stage.at(2s);
    stage.say("a", kStart);
    stage.at(2001500us);
    stage.say("a", kTurn);
    stage.say("b", kTurn);                                    // not in control
    stage.say("a", R"({"type":"fit","node":99})");            // unknown
    stage.say("b", R"({"type":"pick","id":8,"x":1,"y":1})");  // steers nothing, but counts
    stage.at(2500ms);
    stage.join('v');
    stage.presentation.leave("b", stage.now);
    stage.presentation.remember(17);
    stage.presentation.show(other_scene(), stage.now);
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
    Stage stage("a", scene(), recording_to(folder.path()));
    {
        const FullDisk full(10);
        CHECK(stage.refusal("a", kStart) == "failed");
    }
    CHECK_FALSE(stage.state().contains("recording"));
    CHECK(stage.refusal("a", R"({"type":"record","id":5,"action":"start","name":"take-2"})") == "");
    CHECK(stage.state()["recording"]["name"] == "take-2");
}
