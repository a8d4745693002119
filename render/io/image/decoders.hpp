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

// Each checks the size, and then decodes the image.
DecodedImage decode_png(std::string_view bytes, std::uint64_t max_pixels);
DecodedImage decode_jpeg(std::string_view bytes, std::uint64_t max_pixels);
/// An animation is refused.
DecodedImage decode_webp(std::string_view bytes, std::uint64_t max_pixels);
/// Of several images the first.
DecodedImage decode_tiff(std::string_view bytes, std::uint64_t max_pixels);
/// BMP, GIF (of several images the first) or TGA.
DecodedImage decode_bmp_gif_tga(std::string_view bytes, std::uint64_t max_pixels);
/// Returns true if the file has a plausible header of TGA, which has no signature.
bool may_be_tga(std::string_view bytes);

/// Why an image of this size (pixels) is not read, if it is not.
std::optional<std::string> size_fault(std::uint32_t width, std::uint32_t height, std::uint64_t max_pixels);

}  // namespace vrut::io
