#include "engine/log_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>

namespace vrut::server::engine {

namespace {

constexpr std::size_t kFirstLines = std::size_t{64} * 1024;  // bytes

std::string formatted_now(const char* format) {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[40];
    return {text, std::strftime(text, sizeof text, format, &utc)};
}

class DescriptorFile final : public LogFile {
public:
    DescriptorFile(int descriptor, std::filesystem::path path)
        : descriptor_(descriptor), path_(std::move(path)) {}
    ~DescriptorFile() override { close(descriptor_); }
    DescriptorFile(const DescriptorFile&) = delete;
    DescriptorFile& operator=(const DescriptorFile&) = delete;

    tl::expected<void, std::string> append(std::string_view text) override {
        while (!text.empty()) {
            const ssize_t written = write(descriptor_, text.data(), text.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) return tl::unexpected(std::string(std::strerror(errno)));
            text.remove_prefix(static_cast<std::size_t>(written));
        }
        return {};
    }
    void remove() override { unlink(path_.c_str()); }
    /// Whether there is room is better known before anything is told of a recording.
    tl::expected<void, std::string> find_room() {
        auto written = append(std::string(kFirstLines, ' '));
        if (written && ftruncate(descriptor_, 0) != 0)
            return tl::unexpected(std::string(std::strerror(errno)));
        return written;
    }

private:
    int descriptor_;
    std::filesystem::path path_;
};

/// The name that was asked for, or the nth of those that are made of `wanted`.
std::string nth_name(const std::string& wanted, int n) {
    return n == 1 ? wanted : wanted + "-" + std::to_string(n);
}

}  // namespace

std::string iso_time_now() { return formatted_now("%Y-%m-%dT%H:%M:%SZ"); }

tl::expected<OpenedLog, std::string> open_log(const std::filesystem::path& folder, const std::string& name) {
    const std::string wanted = name.empty() ? formatted_now("session-%Y%m%d-%H%M%S") : name;
    std::string chosen;
    std::filesystem::path path;
    int descriptor = -1;
    for (int n = 1; descriptor < 0; ++n) {
        chosen = nth_name(wanted, n);
        path = folder / (chosen + ".jsonl");
        constexpr mode_t kMode = 0666;  // less the umask
        descriptor =
            open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_APPEND | O_CLOEXEC, kMode);
        if (descriptor >= 0) break;
        if (errno == EINTR) --n;
        if (errno != EEXIST)
            return tl::unexpected(chosen + ".jsonl cannot be written: " + std::strerror(errno));
        if (!name.empty()) return tl::unexpected("there is a recording '" + name + "' already");
    }
    auto file = std::make_unique<DescriptorFile>(descriptor, path);
    if (const auto room = file->find_room(); !room) {
        file->remove();
        return tl::unexpected(chosen + ".jsonl cannot be written: " + room.error());
    }
    return OpenedLog{chosen, std::move(file)};
}

}  // namespace vrut::server::engine
