#include "scenes/level_store.hpp"

#include <stdexcept>

#include "observe/log.hpp"
#include "scenes/library.hpp"
#include "scenes/state_folder.hpp"

namespace vrut::server::scenes {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kLargestTable = 1 << 20;

tl::expected<protocol::LevelTable, std::string> read_levels(const fs::path& path) {
    return read_state_file(path, kLargestTable).and_then([](const std::string& text) {
        return protocol::parse_level_table(text);
    });
}

}  // namespace

fs::path levels_file(const std::string& scene_sha256, const std::string& renderer) {
    const fs::path folder = state_folder();
    if (folder.empty()) return {};
    return folder / "levels" / (sha256_of_text(scene_sha256 + "\n" + renderer) + ".json");
}

fs::path store_levels(const protocol::LevelTable& table) {
    fs::path path = levels_file(table.scene, table.renderer);
    const std::string text = protocol::encode(table);
    if (const auto readable = protocol::parse_level_table(text); !readable)
        throw std::runtime_error("these levels cannot be kept: " + readable.error());
    if (path.empty())
        throw std::runtime_error(
            "there is no folder to keep levels in: neither XDG_STATE_HOME nor HOME is set");
    write_state_file(path, text);
    return path;
}

std::optional<protocol::LevelTable> stored_levels(const std::string& scene_sha256,
                                                  const std::string& renderer) {
    const fs::path path = levels_file(scene_sha256, renderer);
    std::error_code error;
    if (path.empty() || !fs::exists(path, error)) return std::nullopt;
    auto table = read_levels(path);
    if (table && (table->scene != scene_sha256 || table->renderer != renderer))
        table = tl::unexpected(std::string("it is of another scene or machine"));
    if (table) return *std::move(table);
    observe::log_warning("levels_not_used", {{"file", path.string()}, {"reason", table.error()}});
    return std::nullopt;
}

protocol::LevelTable levels_of(const std::string& scene_sha256, const std::string& renderer) {
    if (auto stored = stored_levels(scene_sha256, renderer)) {
        observe::log_info("levels_as_measured", {{"levels", stored->levels.size()}});
        return *std::move(stored);
    }
    protocol::LevelTable table = built_in_levels();
    if (table.scene != scene_sha256)
        for (protocol::Level& level : table.levels) level.quality.error.reset();
    return table;
}

}  // namespace vrut::server::scenes
