#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "scene/image.hpp"

namespace vrut::io {

/// The largest number of pixels, and the longest side, of an image that is read.
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t{1} << 26;
inline constexpr std::uint32_t kMaxImageSide = 16384;

/// Decodes a PNG (of any kind), JPEG (grey or colour), WebP, TIFF, BMP, GIF or TGA, recognized by its first
/// bytes. Values are the file's: gamma, colour profile and, but for TIFF, orientation are ignored; 16 bits
/// are rounded to 8, and so are colours times alpha of a TIFF. The size is checked before pixels are
/// allocated. Returns an error without the file's name.
tl::expected<scene::Image, std::string> decode_image(std::string_view bytes,
                                                     std::uint64_t max_pixels = kMaxImagePixels);

/// The same, from a file.
tl::expected<scene::Image, std::string> read_image_file(const std::filesystem::path& path,
                                                        std::uint64_t max_pixels = kMaxImagePixels);

}  // namespace vrut::io
