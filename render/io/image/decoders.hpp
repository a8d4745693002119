#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "scene/image.hpp"

namespace vrut::io {

/// An image, or a sentence about the file.
using DecodedImage = tl::expected<scene::Image, std::string>;

// Each decodes what its library calls so. The size is judged before pixels are allocated.
DecodedImage decode_png(std::string_view bytes, std::uint64_t max_pixels);
DecodedImage decode_jpeg(std::string_view bytes, std::uint64_t max_pixels);
/// The first image of an animation is not told from it: an animation is refused.
DecodedImage decode_webp(std::string_view bytes, std::uint64_t max_pixels);
/// Of several images the first.
DecodedImage decode_tiff(std::string_view bytes, std::uint64_t max_pixels);
/// BMP, GIF (of several images the first) or TGA.
DecodedImage decode_bmp_gif_tga(std::string_view bytes, std::uint64_t max_pixels);
/// TGA files begin with nothing that tells them.
bool may_be_tga(std::string_view bytes);

/// Why an image of this size (pixels) is not read, if it is not.
std::optional<std::string> size_fault(std::uint32_t width, std::uint32_t height, std::uint64_t max_pixels);

}  // namespace vrut::io
