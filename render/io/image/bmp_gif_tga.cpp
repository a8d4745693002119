// Of stb_image, what reads these; no other file of ours sees it.
#define STBI_ONLY_BMP
#define STBI_ONLY_GIF
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>

#include "io/image/decoders.hpp"

namespace vrut::io {

namespace {

const stbi_uc* data_of(std::string_view bytes) { return reinterpret_cast<const stbi_uc*>(bytes.data()); }

// stb_image takes what is missing at the end of a file for zeros, or leaves pixels as memory has them.

/// Numbers of a file, little-endian; behind its end they are zero.
class FileNumbers {
public:
    explicit FileNumbers(std::string_view bytes) : bytes_(bytes) {}
    std::uint64_t size() const { return bytes_.size(); }
    std::uint64_t u8(std::uint64_t at) const {
        return at < bytes_.size() ? static_cast<unsigned char>(bytes_[static_cast<std::size_t>(at)]) : 0;
    }
    std::uint64_t u16(std::uint64_t at) const { return u8(at) | u8(at + 1) << 8; }
    std::uint64_t u32(std::uint64_t at) const { return u16(at) | u16(at + 2) << 16; }

private:
    std::string_view bytes_;
};

bool is_whole_bmp(const FileNumbers& file) {
    const bool core = file.u32(14) == 12;  // the header of OS/2
    const std::uint64_t width = core ? file.u16(18) : file.u32(18);
    const auto height = core ? static_cast<std::int64_t>(file.u16(20))
                             : std::int64_t{static_cast<std::int32_t>(file.u32(22))};
    const std::uint64_t bits = file.u16(core ? 24 : 28), row = (width * bits + 31) / 32 * 4;
    const auto rows = static_cast<std::uint64_t>(height < 0 ? -height : height);
    return file.u32(10) + row * rows <= file.size();
}

/// The place behind sub-blocks of GIF that begin here.
std::uint64_t behind_blocks(const FileNumbers& file, std::uint64_t at) {
    while (at < file.size() && file.u8(at) != 0) at += 1 + file.u8(at);
    return at + 1;
}

std::uint64_t gif_palette_size(std::uint64_t flags) {
    return (flags & 0x80) != 0 ? std::uint64_t{3} << ((flags & 7) + 1) : 0;
}

/// Its first image.
bool is_whole_gif(const FileNumbers& file) {
    std::uint64_t at = 13 + gif_palette_size(file.u8(10));
    while (file.u8(at) == 0x21) at = behind_blocks(file, at + 2);  // extensions
    if (file.u8(at) != 0x2C) return false;
    return behind_blocks(file, at + 11 + gif_palette_size(file.u8(at + 9))) <= file.size();
}

bool is_whole_tga(const FileNumbers& file) {
    const std::uint64_t palette = file.u8(1) != 0 ? file.u16(5) * ((file.u8(7) + 7) / 8) : 0;
    const std::uint64_t bytes = (file.u8(16) + 7) / 8, type = file.u8(2);
    std::uint64_t at = 18 + file.u8(0) + palette, left = file.u16(12) * file.u16(14);
    if (type < 8) return at + left * bytes <= file.size();
    while (left > 0 && at < file.size()) {  // packets of run lengths
        const std::uint64_t head = file.u8(at), pixels = (head & 0x7F) + 1;
        at += 1 + ((head & 0x80) != 0 ? 1 : pixels) * bytes;
        left -= std::min(left, pixels);
    }
    return left == 0 && at <= file.size();
}

bool is_whole(std::string_view bytes) {
    const FileNumbers file(bytes);
    if (bytes.starts_with("BM")) return is_whole_bmp(file);
    return bytes.starts_with("GIF8") ? is_whole_gif(file) : is_whole_tga(file);
}

}  // namespace

bool may_be_tga(std::string_view bytes) {
    int width = 0, height = 0, channels = 0;
    return bytes.size() <= std::numeric_limits<int>::max() &&
           stbi_info_from_memory(data_of(bytes), static_cast<int>(bytes.size()), &width, &height,
                                 &channels) != 0;
}

DecodedImage decode_bmp_gif_tga(std::string_view bytes, std::uint64_t max_pixels) {
    const auto damaged = [] {
        return tl::unexpected(std::string("the image is damaged: ") + stbi_failure_reason());
    };
    if (bytes.size() > std::numeric_limits<int>::max()) return tl::unexpected(std::string("it is too large"));
    const int length = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (stbi_info_from_memory(data_of(bytes), length, &width, &height, &channels) == 0) return damaged();
    if (auto fault =
            size_fault(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), max_pixels))
        return tl::unexpected(*std::move(fault));
    if (!is_whole(bytes)) return tl::unexpected(std::string("it ends too early"));
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data_of(bytes), length, &width, &height, &channels, STBI_rgb_alpha),
        stbi_image_free);
    if (!pixels) return damaged();
    scene::Image image;
    image.resize(width, height);
    const std::size_t row = 4 * static_cast<std::size_t>(width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)  // our rows are from the bottom up
        std::copy_n(pixels.get() + y * row, row,
                    image.rgba.data() + (static_cast<std::size_t>(height) - 1 - y) * row);
    return image;
}

}  // namespace vrut::io
