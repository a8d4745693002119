#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace vrut::base {

/// Why a path names no file that could be read, without its name; nothing where it names one.
std::optional<std::string> file_error(const std::filesystem::path& path);

/// The file that `name`, relative to a scene's folder, means there or below, links followed; or why it is
/// none that may be read: what lies outside of the folder is not.
tl::expected<std::filesystem::path, std::string> find_below(const std::filesystem::path& folder,
                                                            const std::string& name);

/// Of a file that ends before its size, as when someone cuts it short meanwhile.
inline constexpr std::string_view kCutShort = "it cannot be read to its end";

/// A file that is read sequentially. It is not mapped: truncation by another process would raise SIGBUS, and
/// mapped pages would count as the process's memory.
class FileReader {
public:
    /// Or why it cannot be read, without its name.
    static tl::expected<FileReader, std::string> open(const std::filesystem::path& path);

    std::uintmax_t size() const { return size_; }
    /// Whether there were so many bytes more.
    bool read(char* to, std::size_t count);

private:
    FileReader(std::ifstream stream, std::uintmax_t size) : stream_(std::move(stream)), size_(size) {}

    std::ifstream stream_;
    std::uintmax_t size_;
};

/// A whole file, or why it cannot be read, without its name. Files of more than `most` bytes are refused.
tl::expected<std::string, std::string> read_bytes(const std::filesystem::path& path,
                                                  std::uintmax_t most = UINTMAX_MAX);

}  // namespace vrut::base
