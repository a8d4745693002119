#include "scenes/change_store.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
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
constexpr const char *kY = "y\n", *kZ = "z\n";

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

/// Of a name of a known length, whatever the scene's is.
fs::path file_of(const std::string& scene, const char* ending) {
    const fs::path folder = state_folder();
    return folder.empty() ? folder : folder / "scenes" / (sha256_of_text(scene) + ending);
}

/// The text of a patch, or in words that end a sentence why it cannot be read.
tl::expected<std::string, std::string> read_patch(const fs::path& path) {
    auto text = read_state_file(path, kLargestPatch);
    if (text)
        if (const auto patch = protocol::parse_patch(*text); !patch)
            text = tl::unexpected(patch.error().message);
    return text;
}

/// Returns false where a file has the new name already. Throws std::runtime_error with a sentence.
bool rename_to_new(const fs::path& from, const fs::path& to) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
    if (errno == EEXIST) return false;
    if (errno == EINVAL) {  // some file systems do not have the flag
        if (fs::exists(fs::symlink_status(to))) return false;
        if (std::rename(from.c_str(), to.c_str()) == 0) return true;
    }
    throw std::runtime_error(from.string() + " cannot be set aside: " + std::strerror(errno));
}

fs::path up_axis_file(const std::string& sha256) { return file_of(sha256, ".up-axis"); }

}  // namespace

fs::path changes_file(const std::string& scene) { return file_of(scene, ".json"); }

void store_changes(const std::string& scene, const std::string& patch) {
    const fs::path path = changes_file(scene);
    if (path.empty())
        throw std::runtime_error(
            "there is no folder to keep them in: neither XDG_STATE_HOME nor HOME is set");
    if (patch != "{}") return write_state_file(path, patch);
    std::error_code error;
    fs::remove(path, error);
    if (error) throw std::runtime_error(path.string() + " cannot be removed: " + error.message());
}

tl::expected<std::string, std::string> stored_changes(const std::string& scene) {
    const fs::path path = changes_file(scene);
    if (path.empty()) return {};
    remove_old(path.parent_path());
    std::error_code error;
    if (!fs::exists(path, error)) return {};
    auto text = read_patch(path);
    if (text)
        fs::last_write_time(path, fs::file_time_type::clock::now(), error);
    else
        observe::log_warning("changes_not_used", {{"file", path.string()}, {"reason", text.error()}});
    return text;
}

std::string set_changes_aside(const std::string& scene, const std::string& unusable, std::string date) {
    const fs::path path = changes_file(scene);
    std::error_code error;
    if (path.empty() || !fs::exists(fs::symlink_status(path, error))) return {};
    if (const auto text = read_patch(path); text && *text != unusable) return {};
    std::ranges::replace(date, ':', '-');  // not every file system takes it
    const std::string first = path.string() + ".unreadable-" + date;
    fs::path aside = first;
    for (int n = 2; !rename_to_new(path, aside); ++n) aside = first + "-" + std::to_string(n);
    fs::last_write_time(aside, fs::file_time_type::clock::now(), error);
    observe::log_warning("changes_set_aside", {{"file", aside.string()}});
    return aside.filename().string();
}

void store_up_axis(const std::string& sha256, protocol::UpAxis axis) try {
    if (const fs::path path = up_axis_file(sha256); !path.empty())
        write_state_file(path, axis == protocol::UpAxis::z ? kZ : kY);
} catch (const std::exception& error) {
    observe::log_warning("up_axis_not_kept", {{"reason", error.what()}});
}

std::optional<protocol::UpAxis> stored_up_axis(const std::string& sha256) {
    const fs::path path = up_axis_file(sha256);
    std::error_code error;
    if (path.empty() || !fs::exists(path, error)) return std::nullopt;
    const auto text = read_state_file(path, std::string_view(kZ).size());
    if (!text || (*text != kY && *text != kZ)) {
        observe::log_warning(
            "up_axis_not_used",
            {{"file", path.string()}, {"reason", text ? "it says neither y nor z" : text.error()}});
        return std::nullopt;
    }
    fs::last_write_time(path, fs::file_time_type::clock::now(), error);
    return *text == kZ ? protocol::UpAxis::z : protocol::UpAxis::y;
}

}  // namespace vrut::server::scenes
