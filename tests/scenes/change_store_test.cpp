#include "scenes/change_store.hpp"

#include <doctest/doctest.h>
#include <spdlog/spdlog.h>

#include <fstream>

#include "environment_variable.hpp"
#include "temporary_folder.hpp"

using namespace vrut;
using namespace vrut::server::scenes;
namespace fs = std::filesystem;

namespace {

struct StateFolder {
    TemporaryFolder folder;
    EnvironmentVariable state{"XDG_STATE_HOME", folder.path().c_str()};
    StateFolder() { spdlog::set_level(spdlog::level::off); }
    ~StateFolder() { spdlog::set_level(spdlog::level::info); }
    StateFolder(const StateFolder&) = delete;
    StateFolder& operator=(const StateFolder&) = delete;
};

void age(const fs::path& path, int days) {
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(24 * days));
}

const std::string kPatch = R"({"views":{"front":{"eye":[0,0,5]}}})";

}  // namespace

TEST_CASE("changes are kept for a scene, beside the levels, and go with an empty patch") {
    const StateFolder state;
    CHECK(stored_changes("ab") == "");
    store_changes("ab", kPatch);
    CHECK(changes_file("ab").parent_path() == state.folder.path() / "vrut-preview/scenes");
    CHECK(stored_changes("ab") == kPatch);
    CHECK(stored_changes("ac") == "");
    store_changes("ab", R"({"markers":{}})");
    CHECK(stored_changes("ab") == R"({"markers":{}})");
    store_changes("ab", "{}");
    CHECK(fs::is_empty(changes_file("ab").parent_path()));
    store_changes("ab", "{}");  // twice is no error
    CHECK(stored_changes("ab") == "");
}

TEST_CASE("changes are kept for 30 days after the last opening") {
    const StateFolder state;
    store_changes("ab", kPatch);
    store_changes("old", kPatch);
    age(changes_file("ab"), 29);
    age(changes_file("old"), 31);
    CHECK(stored_changes("ab") == kPatch);
    CHECK_FALSE(fs::exists(changes_file("old")));
    CHECK(fs::last_write_time(changes_file("ab")) > fs::file_time_type::clock::now() - std::chrono::hours(1));
    age(changes_file("ab"), 31);
    CHECK(stored_changes("ab") == "");
}

TEST_CASE("changes that cannot be read or written") {
    const StateFolder state;
    store_changes("ab", kPatch);
    fs::resize_file(changes_file("ab"), (std::uintmax_t{64} << 20) + 1);
    CHECK_FALSE(stored_changes("ab"));
    for (const char* text : {"", "{\"views\":", "[]"}) {
        state.folder.write(fs::relative(changes_file("ab"), state.folder.path()), text);
        CHECK_FALSE(stored_changes("ab"));
    }
    fs::remove(changes_file("ab"));
    fs::create_directories(changes_file("ab") / "in its place");
    CHECK_FALSE(stored_changes("ab"));
    CHECK_THROWS_WITH(store_changes("ab", kPatch), doctest::Contains("cannot be written"));

    const EnvironmentVariable none("XDG_STATE_HOME", "relative/is/none"), home("HOME", nullptr);
    CHECK(stored_changes("ab") == "");
    CHECK_THROWS_WITH(store_changes("ab", kPatch), doctest::Contains("there is no folder"));
}

TEST_CASE("changes that cannot be read are set aside, and nothing that was set aside is written over") {
    const StateFolder state;
    const std::string date = "2026-11-29T10:11:12Z";
    CHECK(set_changes_aside("ab", "", date) == "");  // there are none
    const fs::path file = changes_file("ab"), folder = file.parent_path();
    const auto write = [&](const std::string& text) {
        state.folder.write(fs::relative(file, state.folder.path()), text);
    };
    const auto text_of = [](const fs::path& path) {
        std::ifstream stream(path, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    const std::string name = file.filename().string() + ".unreadable-2026-11-29T10-11-12Z";
    int count = 0;
    for (const std::string text : {"", "{\"views\":", "[]", "{\"views\":{\xff}}"}) {
        write(text);
        age(file, 29);
        const std::string expected = name + (++count == 1 ? "" : "-" + std::to_string(count));
        CHECK(set_changes_aside("ab", "", date) == expected);
        CHECK_FALSE(fs::exists(file));
        CHECK(text_of(folder / expected) == text);
        CHECK(fs::last_write_time(folder / expected) >
              fs::file_time_type::clock::now() - std::chrono::hours(1));
    }
    CHECK(text_of(folder / name) == "");
    fs::create_directories(file / "in its place");
    CHECK(set_changes_aside("ab", "", date) == name + "-5");

    store_changes("ab", kPatch);
    CHECK(set_changes_aside("ab", "", date) == "");
    CHECK(set_changes_aside("ab", "{}", date) == "");  // what could not be used is there no longer
    CHECK(stored_changes("ab") == kPatch);
    CHECK(set_changes_aside("ab", kPatch, date) == name + "-6");
    CHECK(text_of(folder / (name + "-6")) == kPatch);
    CHECK(stored_changes("ab") == "");
}

TEST_CASE("changes that cannot be set aside stay") {
    const StateFolder state;
    store_changes("ab", kPatch);
    CHECK_THROWS_WITH(set_changes_aside("ab", kPatch, "no/such/folder"),
                      doctest::Contains("cannot be set aside"));
    CHECK(stored_changes("ab") == kPatch);
    const EnvironmentVariable none("XDG_STATE_HOME", "relative/is/none"), home("HOME", nullptr);
    CHECK(set_changes_aside("ab", kPatch, "2026-11-29") == "");
}

TEST_CASE("the axis that was chosen for up is kept for a file, as long as its changes") {
    using protocol::UpAxis;
    const StateFolder state;
    CHECK_FALSE(stored_up_axis("ab"));
    store_up_axis("ab", UpAxis::z);
    CHECK(stored_up_axis("ab") == UpAxis::z);
    CHECK_FALSE(stored_up_axis("ac"));
    CHECK(stored_changes("ab") == "");
    store_up_axis("ab", UpAxis::y);
    CHECK(stored_up_axis("ab") == UpAxis::y);
    const fs::path folder = changes_file("ab").parent_path();
    const fs::path file = fs::directory_iterator(folder)->path();
    age(file, 29);
    CHECK(stored_changes("other") == "");
    CHECK(stored_up_axis("ab") == UpAxis::y);
    CHECK(fs::last_write_time(file) > fs::file_time_type::clock::now() - std::chrono::hours(1));
    age(file, 31);
    CHECK(stored_changes("other") == "");
    CHECK(fs::is_empty(folder));
}

TEST_CASE("an axis that cannot be read or written counts as none") {
    using protocol::UpAxis;
    const StateFolder state;
    store_up_axis("ab", UpAxis::z);
    const fs::path file = fs::directory_iterator(changes_file("ab").parent_path())->path();
    for (const char* text : {"", "x\n", "z\nz\n"}) {
        state.folder.write(fs::relative(file, state.folder.path()), text);
        CHECK_FALSE(stored_up_axis("ab"));
    }
    fs::remove(file);
    fs::create_directories(file / "in its place");
    store_up_axis("ab", UpAxis::z);
    CHECK_FALSE(stored_up_axis("ab"));
    const EnvironmentVariable none("XDG_STATE_HOME", "relative/is/none"), home("HOME", nullptr);
    store_up_axis("ab", UpAxis::z);
    CHECK_FALSE(stored_up_axis("ab"));
}
