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
    CHECK(stored_changes("ab").empty());
    store_changes("ab", kPatch);
    CHECK(changes_file("ab").parent_path() == state.folder.path() / "vrut-preview/scenes");
    CHECK(stored_changes("ab") == kPatch);
    CHECK(stored_changes("ac").empty());
    store_changes("ab", R"({"markers":{}})");
    CHECK(stored_changes("ab") == R"({"markers":{}})");
    store_changes("ab", "{}");
    CHECK(fs::is_empty(changes_file("ab").parent_path()));
    store_changes("ab", "{}");  // twice is no error
    CHECK(stored_changes("ab").empty());
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
    CHECK(stored_changes("ab").empty());
}

TEST_CASE("changes that cannot be read or written") {
    const StateFolder state;
    store_changes("ab", kPatch);
    fs::resize_file(changes_file("ab"), (std::uintmax_t{64} << 20) + 1);
    CHECK(stored_changes("ab").empty());
    for (const char* text : {"", "{\"views\":", "[]"}) {
        state.folder.write(fs::relative(changes_file("ab"), state.folder.path()), text);
        CHECK(stored_changes("ab").empty());
    }
    fs::remove(changes_file("ab"));
    fs::create_directories(changes_file("ab") / "in its place");
    CHECK(stored_changes("ab").empty());
    CHECK_THROWS_WITH(store_changes("ab", kPatch), doctest::Contains("cannot be written"));

    const EnvironmentVariable none("XDG_STATE_HOME", "relative/is/none"), home("HOME", nullptr);
    CHECK(stored_changes("ab").empty());
    CHECK_THROWS_WITH(store_changes("ab", kPatch), doctest::Contains("there is no folder"));
}

TEST_CASE("the axis that was chosen for up is kept for a file, as long as its changes") {
    using protocol::UpAxis;
    const StateFolder state;
    CHECK_FALSE(stored_up_axis("ab"));
    store_up_axis("ab", UpAxis::z);
    CHECK(stored_up_axis("ab") == UpAxis::z);
    CHECK_FALSE(stored_up_axis("ac"));
    CHECK(stored_changes("ab").empty());
    store_up_axis("ab", UpAxis::y);
    CHECK(stored_up_axis("ab") == UpAxis::y);
    const fs::path folder = changes_file("ab").parent_path();
    const fs::path file = fs::directory_iterator(folder)->path();
    age(file, 29);
    CHECK(stored_changes("other").empty());
    CHECK(stored_up_axis("ab") == UpAxis::y);
    CHECK(fs::last_write_time(file) > fs::file_time_type::clock::now() - std::chrono::hours(1));
    age(file, 31);
    CHECK(stored_changes("other").empty());
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
