// Files that answer late, never or with an error: who waits for them waits in vain, and nobody else.
#include <doctest/doctest.h>

#include "engine/recording_writer.hpp"
#include "engine/scene_lookup.hpp"
#include "slow_disk.hpp"

using namespace slow_disk;

namespace {

class FileOnDisk final : public LogFile {
public:
    explicit FileOnDisk(std::shared_ptr<Disk> disk) : disk_(std::move(disk)) {}
    ~FileOnDisk() override {
        if (disk_->blocks_closing) disk_->pass();
        const std::lock_guard lock(disk_->mutex);
        disk_->closed = true;
        disk_->changed.notify_all();
    }
    tl::expected<void, std::string> append(std::string_view text) override {
        disk_->pass();
        const std::lock_guard lock(disk_->mutex);
        if (!disk_->error.empty()) return tl::unexpected(disk_->error);
        disk_->text += text;
        return {};
    }
    void remove() override {
        const std::lock_guard lock(disk_->mutex);
        disk_->removed = true;
    }

private:
    std::shared_ptr<Disk> disk_;
};

/// One recording, 1, with the first line "first".
struct Written {
    explicit Written(RecordingWriter::Limits limits = {}, bool slow_opening = false)
        : writer(
              [disk = disk, slow_opening](const std::string& name) -> tl::expected<OpenedLog, std::string> {
                  if (slow_opening) disk->pass();
                  if (name == "taken") return tl::unexpected(std::string("there is one already"));
                  return OpenedLog{name, std::make_unique<FileOnDisk>(disk)};
              },
              results.post(),
              [this](auto, const auto& name) { opened = name ? *name : "not: " + name.error(); },
              [this](auto, const auto& why) { ended = why.value_or("all is written"); }, limits) {}
    ~Written() { disk->block(false); }
    void begin(const std::string& name = "log") {
        writer.begin(
            1, name, [](const auto&, const auto&) { return "first"; }, now);
    }
    void begin_and_open() {
        begin();
        results.use_next();
        REQUIRE(opened == "log");
    }
    void write(const std::string& line) { writer.write(1, line, now); }
    void end() {
        writer.end(1, now);
        results.use_next();
    }

    Clock::time_point now{1h};
    std::shared_ptr<Disk> disk = std::make_shared<Disk>();
    Results results;
    std::string opened, ended;
    RecordingWriter writer;
};

}  // namespace

TEST_CASE("lines are written in their order, those too that came before the file was open") {
    Written log({}, true);
    log.disk->block(true);
    log.begin();
    log.write("one");
    log.disk->block(false);
    log.results.use_next();
    CHECK(log.opened == "log");
    log.write("two");
    log.end();
    CHECK(log.ended == "all is written");
    CHECK(log.disk->written() == "first\none\ntwo\n");
    CHECK(log.disk->closed);
    CHECK_FALSE(log.writer.due());
}

TEST_CASE("a file that cannot be opened is told, and what came for it forgotten") {
    Written log;
    log.begin("taken");
    log.write("one");
    log.results.use_next();
    CHECK(log.opened == "not: there is one already");
    log.write("two");
    log.writer.end(1, log.now);
    CHECK(log.ended == "");
}

TEST_CASE("a first line that cannot be written is told as a file that cannot be opened") {
    Written log;
    log.disk->error = "No space left on device";
    log.begin();
    log.results.use_next();
    CHECK(log.opened == "not: log.jsonl cannot be written: No space left on device");
    CHECK(log.disk->removed);
}

TEST_CASE("a full disk ends the recording") {
    Written log;
    log.begin_and_open();
    {
        const std::lock_guard lock(log.disk->mutex);
        log.disk->error = "No space left on device";
    }
    log.write("one");
    log.results.use_next();
    CHECK(log.ended == "No space left on device");
    log.write("two");
    CHECK(log.disk->written() == "first\n");
}

TEST_CASE("a log that has grown to the largest size ends with the line that made it so") {
    Written log({.file_bytes = 14});
    log.disk->block(true);
    log.begin();
    for (const char* line : {"abc", "def", "ghi"}) log.write(line);
    log.disk->block(false);
    log.results.use_next();
    log.results.use_next();
    CHECK(log.ended == "it has grown too large");
    CHECK(log.disk->written() == "first\nabc\ndef\n");
}

TEST_CASE("a disk that takes its time is waited for, while its oldest line is young enough") {
    Written log;
    log.begin_and_open();
    for (int i = 0; i < 20; ++i) {
        log.disk->block(true);
        log.write("line");
        log.disk->await_call();
        log.now += 900ms;
        log.write("line");  // nobody waits to say it
        log.writer.check(log.now);
        log.disk->block(false);
        log.disk->await_no_call();
    }
    log.end();
    CHECK(log.ended == "all is written");
    CHECK(log.disk->written().size() == 6 + 40 * 5);
}

TEST_CASE("a recording in which nothing happens for long goes on") {
    Written log;
    log.begin_and_open();
    for (const char* line : {"one", "two"}) {
        await([&] { return !log.writer.due(); });
        log.now += 1h;
        log.writer.check(log.now);
        log.write(line);
    }
    log.end();
    CHECK(log.ended == "all is written");
    CHECK(log.disk->written() == "first\none\ntwo\n");
}

TEST_CASE("a disk that never answers ends the recording when its oldest line is too old") {
    Written log;
    log.begin_and_open();
    log.disk->block(true);
    log.write("one");
    log.disk->await_call();
    CHECK(log.writer.due() == log.now + 5s);
    log.now += 4999ms;
    log.write("two");
    log.writer.check(log.now);
    CHECK(log.ended == "");
    CHECK(log.writer.due() == Clock::time_point(1h + 5s));
    log.writer.check(Clock::time_point(1h + 5s));
    log.results.use_next();
    CHECK(log.ended == "its disk is too slow");
    CHECK_FALSE(log.writer.due());
    log.disk->block(false);
    log.disk->await_closed();  // what it had in hand is written, and no more
    CHECK(log.disk->written() == "first\none\n");
}

TEST_CASE("and when more waits for it than may") {
    Written log({.waiting_bytes = 10});
    log.begin_and_open();
    log.disk->block(true);
    log.write("12345");
    log.disk->await_call();
    log.write("12345");
    log.write("6");
    log.results.use_next();
    CHECK(log.ended == "its disk is too slow");
}

TEST_CASE("a file that never opens, or never closes, is given up, too") {
    SUBCASE("opening") {
        Written log({}, true);
        log.disk->block(true);
        log.begin();
        log.writer.check(log.now + 5s);
        log.results.use_next();
        CHECK(log.opened == "not: the recording cannot be begun: its disk is too slow");
        log.disk->block(false);
        log.disk->await_closed();
        CHECK(log.disk->removed);
        CHECK(log.disk->written() == "");
    }
    SUBCASE("the last line") {
        Written log;
        log.begin_and_open();
        log.disk->block(true);
        log.write("one");
        log.writer.end(1, log.now);
        log.writer.check(log.now + 5s);
        log.results.use_next();
        CHECK(log.ended == "its disk is too slow");
    }
    SUBCASE("closing") {
        Written log;
        log.begin_and_open();
        log.disk->blocks_closing = true;
        log.disk->block(true);
        log.writer.end(1, log.now);
        log.disk->await_call();
        log.writer.check(log.now + 5s);
        log.results.use_next();
        CHECK(log.ended == "its disk is too slow");
    }
}

TEST_CASE("threads that are left behind do not pile up, and those that come back count no more") {
    Written log({.threads = 2}, true);
    log.disk->block(true);
    for (const bool starts : {true, true, false, false}) {
        log.opened.clear();
        log.begin();
        if (starts) log.writer.check(log.now + 5s);
        log.results.use_next();
        CHECK(log.opened == (starts ? "not: the recording cannot be begun: its disk is too slow"
                                    : "not: the disk has not taken earlier recordings yet"));
    }
    log.disk->block(false);
    await([&] {
        log.begin();
        log.results.use_next();
        return log.opened == "log";
    });
}

TEST_CASE("what waits at the end is written; who never comes back is left behind") {
    for (const bool hangs : {false, true}) {
        auto log = std::make_unique<Written>();
        const std::shared_ptr<Disk> used = std::exchange(log->disk, std::make_shared<Disk>());
        log->begin_and_open();
        if (hangs) used->block(true);
        log->write("one");
        if (hangs) used->await_call();
        log.reset();
        CHECK(used->written() == (hangs ? "first\n" : "first\none\n"));
        used->block(false);
    }
}

// --- the folder of scenes

namespace {

struct Asked {
    explicit Asked()
        : lookup(
              {[disk = disk] {
                   disk->pass();
                   return std::vector<std::string>{"car.vrut"};
               },
               [disk = disk](const std::string& name) -> tl::expected<std::filesystem::path, std::string> {
                   disk->pass();
                   if (name == "none") return tl::unexpected(std::string("there is no such scene"));
                   return "/scenes/" + name;
               }},
              results.post(),
              [this](auto request, const auto& names) {
                  listed = {request, names.size()};
              },
              [this](auto request, const auto& answer) {
                  found = request;
                  path = answer.path ? answer.path->string() : answer.path.error().message;
                  code = answer.path ? "" : answer.path.error().code;
              }) {}
    ~Asked() { disk->block(false); }

    Clock::time_point now{1h};
    std::shared_ptr<Disk> disk = std::make_shared<Disk>();
    Results results;
    std::pair<std::int64_t, std::size_t> listed;
    std::int64_t found = 0;
    std::string path;
    std::string code;
    SceneLookup lookup;
};

}  // namespace

TEST_CASE("scenes are looked up once a second, and those who ask meanwhile are told the same") {
    Asked asked;
    asked.lookup.list(1, asked.now);
    asked.results.use_next();  // the folder answers
    asked.results.use_next();
    CHECK(asked.listed == std::pair<std::int64_t, std::size_t>{1, 1});
    asked.disk->block(true);  // not asked now
    asked.lookup.list(2, asked.now + 999ms);
    asked.results.use_next();
    CHECK(asked.listed == std::pair<std::int64_t, std::size_t>{2, 1});
    asked.lookup.list(3, asked.now + 1s);
    asked.disk->await_call();
    CHECK(asked.lookup.due() == asked.now + 1100ms);
    asked.lookup.check(asked.now + 1099ms);
    CHECK(asked.listed.first == 2);
    asked.lookup.check(asked.now + 1100ms);  // the list before
    asked.results.use_next();
    CHECK(asked.listed == std::pair<std::int64_t, std::size_t>{3, 1});
    CHECK_FALSE(asked.lookup.due());
    asked.lookup.list(4, asked.now + 1h);  // it is still being made
    asked.results.use_next();
    CHECK(asked.listed.first == 4);
}

TEST_CASE("a folder that never answers tells an empty list, and finds nothing") {
    Asked asked;
    asked.disk->block(true);
    asked.lookup.list(1, asked.now);
    asked.lookup.check(asked.now + 100ms);
    asked.results.use_next();
    CHECK(asked.listed == std::pair<std::int64_t, std::size_t>{1, 0});
    asked.lookup.find(2, {"car.vrut"}, asked.now);
    asked.lookup.find(3, {"bus.vrut"}, asked.now + 1s);
    CHECK(asked.lookup.due() == asked.now + 5s);
    for (const int request : {2, 3}) {
        asked.lookup.check(asked.now + 3s + request * 1s);
        asked.results.use_next();
        CHECK(asked.found == request);
        CHECK(asked.path == "the folder of scenes does not answer");
        CHECK(asked.code == "busy");
    }
    asked.lookup.find(4, {"van.vrut"}, asked.now + 10s);  // behind the first, which still hangs
    asked.disk->block(false);
    while (asked.found != 4) asked.results.use_next();
    CHECK(asked.path == "/scenes/van.vrut");
}

TEST_CASE("scenes are found one after the other, each for its request") {
    Asked asked;
    asked.lookup.find(1, {"car.vrut"}, asked.now);
    asked.lookup.find(2, {"none"}, asked.now);
    asked.results.use_next();
    CHECK(asked.found == 1);
    CHECK(asked.path == "/scenes/car.vrut");
    asked.results.use_next();
    CHECK(asked.found == 2);
    CHECK(asked.path == "there is no such scene");
    CHECK(asked.code == "refused-scene");
    asked.disk->block(true);
    for (int request = 3; request < 3 + 64; ++request) asked.lookup.find(request, {"car.vrut"}, asked.now);
    asked.lookup.find(99, {"car.vrut"}, asked.now);
    asked.results.use_next();
    CHECK(asked.found == 99);
    CHECK(asked.code == "busy");
}
