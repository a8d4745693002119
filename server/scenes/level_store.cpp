#include "scenes/level_store.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>
#include <stdexcept>

#include "base/files.hpp"
#include "observe/log.hpp"
#include "scenes/library.hpp"

namespace vrut::server::scenes {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kLargestFile = 1 << 20;

/// The XDG base directory specification: a relative path counts as none.
fs::path state_folder() {
    const auto absolute = [](const char* variable) {
        const char* value = std::getenv(variable);
        const fs::path path = value ? value : "";
        return path.is_absolute() ? path : fs::path();
    };
    if (fs::path state = absolute("XDG_STATE_HOME"); !state.empty()) return state;
    const fs::path home = absolute("HOME");
    return home.empty() ? home : home / ".local/state";
}

tl::expected<protocol::LevelTable, std::string> read_levels(const fs::path& path) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);  // of a folder it is an error
    if (error) return tl::unexpected("it cannot be read: " + error.message());
    if (size > kLargestFile) return tl::unexpected(std::string("it is too large"));
    std::string text(size, '\0');
    std::ifstream stream(path, std::ios::binary);
    if (!stream.read(text.data(), static_cast<std::streamsize>(size)))
        return tl::unexpected(std::string("it cannot be read"));
    return protocol::parse_level_table(text);
}

/// Or not at all.
void write_whole(const fs::path& path, const std::string& text) {
    const fs::path beside = path.string() + "." + std::to_string(getpid());
    try {
        base::write_file(beside, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
        if (std::rename(beside.c_str(), path.c_str()) != 0)
            throw std::runtime_error(path.string() + " cannot be written: " + std::strerror(errno));
    } catch (...) {
        std::error_code ignored;
        fs::remove(beside, ignored);
        throw;
    }
}

}  // namespace

fs::path levels_file(const std::string& scene_sha256, const std::string& renderer) {
    const fs::path folder = state_folder();
    if (folder.empty()) return {};
    return folder / "vrut-preview/levels" / (sha256_of_text(scene_sha256 + "\n" + renderer) + ".json");
}

fs::path store_levels(const protocol::LevelTable& table) {
    fs::path path = levels_file(table.scene, table.renderer);
    const std::string text = protocol::encode(table);
    if (const auto readable = protocol::parse_level_table(text); !readable)
        throw std::runtime_error("these levels cannot be kept: " + readable.error());
    if (path.empty())
        throw std::runtime_error(
            "there is no folder to keep levels in: neither XDG_STATE_HOME nor HOME is set");
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) throw std::runtime_error(path.parent_path().string() + " cannot be made: " + error.message());
    write_whole(path, text);
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
