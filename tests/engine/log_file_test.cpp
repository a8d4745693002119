#include "engine/log_file.hpp"

#include <doctest/doctest.h>

#include <set>

#include "full_disk.hpp"
#include "temporary_folder.hpp"

using namespace vrut::server::engine;

TEST_CASE("a file takes lines, one behind the other") {
    const TemporaryFolder folder;
    const auto log = open_log(folder.path(), "a_B-9");
    REQUIRE(log);
    CHECK(log->name == "a_B-9");
    CHECK(log->file->append("one\n"));
    CHECK(log->file->append("two\n"));
    CHECK(folder.read("a_B-9.jsonl") == "one\ntwo\n");
}

TEST_CASE("a name that is taken is refused, and its file left alone") {
    const TemporaryFolder folder;
    folder.write("mine.jsonl", "precious");
    const auto opened = open_log(folder.path(), "mine");
    REQUIRE_FALSE(opened);
    CHECK(opened.error() == "there is a recording 'mine' already");
    CHECK(folder.read("mine.jsonl") == "precious");
}

TEST_CASE("a link is a name that is taken, wherever it leads") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "logs");
    std::filesystem::create_symlink(folder.path() / "nowhere", folder.path() / "logs/dangling.jsonl");
    std::filesystem::create_symlink(folder.write("precious", "mine"), folder.path() / "logs/there.jsonl");
    for (const std::string name : {"dangling", "there"}) {
        const auto opened = open_log(folder.path() / "logs", name);
        REQUIRE_FALSE(opened);
        CHECK(opened.error() == "there is a recording '" + name + "' already");
    }
    CHECK_FALSE(std::filesystem::exists(folder.path() / "nowhere"));
    CHECK(folder.read("precious") == "mine");
}

TEST_CASE("without a name one is made, each time another") {
    const TemporaryFolder folder;
    std::set<std::string> names;
    for (int i = 0; i < 3; ++i) {
        const auto log = open_log(folder.path(), "");
        REQUIRE(log);
        CHECK(log->name.starts_with("session-20"));
        CHECK(std::filesystem::exists(folder.path() / (log->name + ".jsonl")));
        CHECK(names.insert(log->name).second);
    }
}

TEST_CASE("a folder that is gone, and a disk without room, are told, and leave nothing") {
    const TemporaryFolder folder;
    const auto opened = open_log(folder.path() / "logs", "log");
    REQUIRE_FALSE(opened);
    CHECK(opened.error() == "log.jsonl cannot be written: No such file or directory");
    const FullDisk full(1000);
    const auto cramped = open_log(folder.path(), "log");
    REQUIRE_FALSE(cramped);
    CHECK(cramped.error() == "log.jsonl cannot be written: File too large");
    CHECK(std::filesystem::is_empty(folder.path()));
}
