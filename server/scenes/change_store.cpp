#include "scenes/change_store.hpp"

#include <chrono>
#include <stdexcept>

#include "observe/log.hpp"
#include "scenes/library.hpp"
#include "scenes/state_folder.hpp"
#include "state.hpp"

namespace vrut::server::scenes {

namespace fs = std::filesystem;

namespace {

constexpr std::chrono::hours kKept{24 * 30};
constexpr std::uintmax_t kLargestPatch = std::uintmax_t{64} << 20;
constexpr int kMostFiles = 10'000;  // that are looked at

void remove_old(const fs::path& folder) {
    std::error_code error;
    int left = kMostFiles;
    const fs::file_time_type oldest = fs::file_time_type::clock::now() - kKept;
    for (fs::directory_iterator file(folder, error); !error && file != fs::directory_iterator() && left-- > 0;
         file.increment(error)) {
        std::error_code ignored;
        const fs::file_time_type written = fs::last_write_time(*file, ignored);
        if (!ignored && written < oldest) fs::remove(*file, ignored);
    }
}

}  // namespace

fs::path changes_file(const std::string& scene_sha256) {
    const fs::path folder = state_folder();
    // A name of a known length, whatever the hash is.
    return folder.empty() ? folder : folder / "scenes" / (sha256_of_text(scene_sha256) + ".json");
}

void store_changes(const std::string& scene_sha256, const std::string& patch) {
    const fs::path path = changes_file(scene_sha256);
    if (path.empty())
        throw std::runtime_error(
            "there is no folder to keep them in: neither XDG_STATE_HOME nor HOME is set");
    if (patch != "{}") return write_state_file(path, patch);
    std::error_code error;
    fs::remove(path, error);
    if (error) throw std::runtime_error(path.string() + " cannot be removed: " + error.message());
}

std::string stored_changes(const std::string& scene_sha256) {
    const fs::path path = changes_file(scene_sha256);
    if (path.empty()) return {};
    remove_old(path.parent_path());
    std::error_code error;
    if (!fs::exists(path, error)) return {};
    auto text = read_state_file(path, kLargestPatch);
    if (text)
        if (const auto patch = protocol::parse_patch(*text); !patch)
            text = tl::unexpected(patch.error().message);
    if (!text) {
        observe::log_warning("changes_not_used", {{"file", path.string()}, {"reason", text.error()}});
        return {};
    }
    fs::last_write_time(path, fs::file_time_type::clock::now(), error);
    return *std::move(text);
}

}  // namespace vrut::server::scenes
