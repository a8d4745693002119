#include "scenes/state_folder.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "base/files.hpp"

namespace vrut::server::scenes {

namespace fs = std::filesystem;

fs::path state_folder() {
    // The XDG base directory specification: a relative path counts as none.
    const auto absolute = [](const char* variable) {
        const char* value = std::getenv(variable);
        const fs::path path = value ? value : "";
        return path.is_absolute() ? path : fs::path();
    };
    if (const fs::path state = absolute("XDG_STATE_HOME"); !state.empty()) return state / "vrut-preview";
    const fs::path home = absolute("HOME");
    return home.empty() ? home : home / ".local/state/vrut-preview";
}

void write_state_file(const fs::path& path, const std::string& text) {
    static std::atomic<unsigned> written{0};
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) throw std::runtime_error(path.parent_path().string() + " cannot be made: " + error.message());
    const fs::path beside = path.string() + "." + std::to_string(getpid()) + "." + std::to_string(written++);
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

tl::expected<std::string, std::string> read_state_file(const fs::path& path, std::uintmax_t most_bytes) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);  // of a folder it is an error
    if (error) return tl::unexpected("it cannot be read: " + error.message());
    if (size > most_bytes) return tl::unexpected(std::string("it is too large"));
    std::string text(size, '\0');
    std::ifstream stream(path, std::ios::binary);
    if (!stream.read(text.data(), static_cast<std::streamsize>(size)))
        return tl::unexpected(std::string("it cannot be read"));
    return text;
}

}  // namespace vrut::server::scenes
