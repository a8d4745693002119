#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "scene/image.hpp"

namespace vrut::io {

/// The most pixels, and the longest side, of a picture that is read.
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t{1} << 26;
inline constexpr std::uint32_t kMaxImageSide = 16384;

/// The picture in a PNG file (of any kind) or a JPEG file (grey or colour), told apart by their first bytes.
/// Its values are the file's: gamma, colour profile and orientation tags mean nothing here; 16 bits are
/// rounded to 8. Size is judged before pixels get any memory. Else why there is none, without the file's
/// name.
tl::expected<scene::Image, std::string> decode_image(std::string_view bytes,
                                                     std::uint64_t max_pixels = kMaxImagePixels);

/// The same, from a file.
tl::expected<scene::Image, std::string> read_image_file(const std::filesystem::path& path,
                                                        std::uint64_t max_pixels = kMaxImagePixels);

}  // namespace vrut::io
