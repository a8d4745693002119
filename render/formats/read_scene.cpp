#include "read_scene.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "vrut_text.hpp"

namespace vrut {

namespace {

struct Format {
    const char* extension;
    ReadResult (*read)(std::string_view bytes, const std::string& file, const ReadProgress& progress);
};

constexpr Format kFormats[] = {
    {".vrut", read_vrut_text},
};

std::string known_extensions() {
    std::string list;
    for (const Format& format : kFormats) list += (list.empty() ? "" : ", ") + std::string(format.extension);
    return list;
}

}  // namespace

ReadResult read_scene(const std::filesystem::path& path, const ReadProgress& progress) {
    const std::string file = path.string();
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
        return c < 0x80 ? static_cast<char>(std::tolower(c)) : static_cast<char>(c);
    });
    const auto format = std::find_if(std::begin(kFormats), std::end(kFormats), [&](const Format& candidate) {
        return extension == candidate.extension;
    });
    std::error_code error;
    if (const auto status = std::filesystem::status(path, error); !std::filesystem::exists(status))
        return tl::unexpected(file + ": there is no such file");
    else if (!std::filesystem::is_regular_file(status))
        return tl::unexpected(file + ": is not a file");
    if (format == std::end(kFormats))
        return tl::unexpected(file + ": no reader for this ending; known are " + known_extensions());

    const std::uintmax_t size = std::filesystem::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream) return tl::unexpected(file + ": cannot be opened: " + std::strerror(errno));
    std::string bytes(static_cast<std::size_t>(size), '\0');
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
        return tl::unexpected(file + ": cannot be read to its end");
    return format->read(bytes, file, progress);
}

}  // namespace vrut
