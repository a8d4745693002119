#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace vrut::base {

/// Returns why the path is not a readable file, without its name; none if it is one.
std::optional<std::string> file_error(const std::filesystem::path& path);

/// Resolves `name` relative to a scene's folder, symbolic links included. Returns an error if the file lies
/// outside of the folder.
tl::expected<std::filesystem::path, std::string> find_below(const std::filesystem::path& folder,
                                                            const std::string& name);

/// The error for a file that ends before its size, for example since another process truncates it.
inline constexpr std::string_view kCutShort = "it cannot be read to its end";

/// A file that is read sequentially. It is not mapped: truncation by another process would raise SIGBUS, and
/// mapped pages would count as the process's memory.
class FileReader {
public:
    /// Returns an error, without the file's name, if it cannot be read.
    static tl::expected<FileReader, std::string> open(const std::filesystem::path& path);

    std::uintmax_t size() const { return size_; }
    /// Reads `count` bytes. Returns false if fewer are left.
    bool read(char* to, std::size_t count);

private:
    FileReader(std::ifstream stream, std::uintmax_t size) : stream_(std::move(stream)), size_(size) {}

    std::ifstream stream_;
    std::uintmax_t size_;
};

/// Returns the bytes of a file, or an error without its name. Rejects files of more than `most` bytes.
tl::expected<std::string, std::string> read_bytes(const std::filesystem::path& path,
                                                  std::uintmax_t most = UINTMAX_MAX);

}  // namespace vrut::base
