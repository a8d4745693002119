#include "scenes/level_store.hpp"

#include <doctest/doctest.h>
#include <spdlog/spdlog.h>

#include "environment_variable.hpp"
#include "temporary_folder.hpp"

using namespace vrut;
using namespace vrut::server::scenes;
using protocol::Quality;
namespace fs = std::filesystem;

namespace {

struct Store {
    TemporaryFolder folder;
    EnvironmentVariable state{"XDG_STATE_HOME", folder.path().c_str()};
    Store() { spdlog::set_level(spdlog::level::off); }
    ~Store() { spdlog::set_level(spdlog::level::info); }
    Store(const Store&) = delete;
    Store& operator=(const Store&) = delete;
};

protocol::LevelTable table_of(const std::string& scene, const std::string& renderer) {
    return {scene, renderer, 640, 480, {{{Quality::Level::moving, 0.5}, 12, 3000, "cheap"}}};
}

std::size_t count_files(const fs::path& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::recursive_directory_iterator(folder), fs::recursive_directory_iterator()));
}

}  // namespace

TEST_CASE("levels are kept for a scene on a machine, and no other") {
    const Store store;
    CHECK_FALSE(stored_levels("ab", "llvmpipe").has_value());
    const fs::path path = store_levels(table_of("ab", "llvmpipe"));
    CHECK(path == levels_file("ab", "llvmpipe"));
    CHECK(path.parent_path() == store.folder.path() / "vrut-preview/levels");
    CHECK(count_files(store.folder.path()) == 3);  // two folders, and nothing beside the file
    const auto stored = stored_levels("ab", "llvmpipe");
    REQUIRE(stored.has_value());
    CHECK(stored->levels[0].ms == 12);
    CHECK_FALSE(stored_levels("ac", "llvmpipe").has_value());
    CHECK_FALSE(stored_levels("ab", "a card").has_value());

    auto next = table_of("ab", "llvmpipe");
    next.levels[0].ms = 13;
    CHECK(store_levels(next) == path);
    CHECK(stored_levels("ab", "llvmpipe")->levels[0].ms == 13);
    CHECK(levels_of("ab", "llvmpipe").levels.size() == 1);
    CHECK(levels_of("ac", "llvmpipe").levels.size() == built_in_levels().levels.size());
}

TEST_CASE("a file that cannot be used is passed over") {
    const Store store;
    const fs::path path = store_levels(table_of("ab", "llvmpipe"));
    const std::string name = fs::relative(path, store.folder.path());
    for (const std::string& text : {std::string(), std::string("{"), std::string(2 << 20, ' '),
                                    protocol::encode(table_of("other", "llvmpipe"))}) {
        store.folder.write(name, text);
        CHECK_FALSE(stored_levels("ab", "llvmpipe").has_value());
    }
    fs::remove(path);
    fs::create_directories(path / "in its place");
    CHECK_FALSE(stored_levels("ab", "llvmpipe").has_value());
    const std::size_t before = count_files(store.folder.path());
    CHECK_THROWS_WITH(store_levels(table_of("ab", "llvmpipe")), doctest::Contains("cannot be written"));
    CHECK(count_files(store.folder.path()) == before);  // nothing is left beside it
}

TEST_CASE("what could not be read again is not kept") {
    const Store store;
    protocol::LevelTable table = table_of("ab", "llvmpipe");
    table.levels[0].ms = -1;
    CHECK_THROWS_WITH(store_levels(table), doctest::Contains("'levels[0].ms'"));
    CHECK(fs::is_empty(store.folder.path()));
}

TEST_CASE("without a home nothing is kept") {
    const EnvironmentVariable state("XDG_STATE_HOME", "relative/is/none"), home("HOME", nullptr);
    CHECK(levels_file("ab", "llvmpipe").empty());
    CHECK_FALSE(stored_levels("ab", "llvmpipe").has_value());
    CHECK_THROWS_WITH(store_levels(table_of("ab", "llvmpipe")), doctest::Contains("neither"));
    const EnvironmentVariable found("HOME", "/home/somebody");
    CHECK(levels_file("ab", "llvmpipe").parent_path() == "/home/somebody/.local/state/vrut-preview/levels");
}

TEST_CASE("the built-in table is one that could be read") {
    const auto& table = built_in_levels();
    const auto read = protocol::parse_level_table(protocol::encode(table));
    REQUIRE_MESSAGE(read.has_value(), read.error());
    CHECK(read->levels.size() == table.levels.size());
}
