#include "base/file_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace vrut::base {

std::optional<std::string> file_error(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) return "there is no such file";
    if (!std::filesystem::is_regular_file(status)) return "it is not a regular file";
    return std::nullopt;
}

tl::expected<std::filesystem::path, std::string> find_below(const std::filesystem::path& folder,
                                                            const std::string& name) {
    namespace fs = std::filesystem;
    const fs::path relative(name);
    const std::string outside = "it lies outside of the scene's folder: move it into that folder or below";
    if (name.empty() || name.find('\0') != std::string::npos)
        return tl::unexpected(std::string("its name is empty or contains a NUL byte"));
    if (relative.is_absolute() || std::find(relative.begin(), relative.end(), "..") != relative.end())
        return tl::unexpected(outside);
    std::error_code error;
    const fs::path root = fs::canonical(folder.empty() ? "." : folder, error);
    const fs::path file = error ? fs::path() : fs::canonical(root / relative, error);
    if (error == std::errc::no_such_file_or_directory)
        return tl::unexpected(std::string("there is no such file"));
    if (error) return tl::unexpected("it cannot be found: " + error.message());
    if (std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first != root.end())
        return tl::unexpected(outside);
    return file;
}

tl::expected<FileReader, std::string> FileReader::open(const std::filesystem::path& path) {
    if (auto fault = file_error(path)) return tl::unexpected(*std::move(fault));
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream) return tl::unexpected(std::string("it cannot be opened: ") + std::strerror(errno));
    return FileReader(std::move(stream), size);
}

bool FileReader::read(char* to, std::size_t count) {
    return static_cast<bool>(stream_.read(to, static_cast<std::streamsize>(count)));
}

tl::expected<std::string, std::string> read_bytes(const std::filesystem::path& path, std::uintmax_t most) {
    auto file = FileReader::open(path);
    if (!file) return tl::unexpected(file.error());
    if (file->size() > most) return tl::unexpected("it is larger than " + std::to_string(most) + " bytes");
    std::string bytes(static_cast<std::size_t>(file->size()), '\0');
    if (!file->read(bytes.data(), bytes.size())) return tl::unexpected(std::string(kCutShort));
    return bytes;
}

}  // namespace vrut::base
