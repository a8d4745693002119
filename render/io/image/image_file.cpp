#include "io/image/image_file.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/file_bytes.hpp"
#include "io/image/decoders.hpp"

namespace vrut::io {

namespace {

// What the largest image takes uncompressed: 16 bits RGBA.
constexpr std::uintmax_t kMaxFileBytes = kMaxImagePixels * 8 + (std::uintmax_t{1} << 20);

using Decoder = DecodedImage (*)(std::string_view bytes, std::uint64_t max_pixels);

struct Format {
    std::string_view signature;
    std::size_t offset;
    Decoder decode;
};

using namespace std::string_view_literals;
constexpr Format kFormats[] = {
    {"\x89PNG\r\n\x1a\n", 0, decode_png}, {"\xFF\xD8\xFF", 0, decode_jpeg}, {"WEBP", 8, decode_webp},
    {"II*\0"sv, 0, decode_tiff},          {"MM\0*"sv, 0, decode_tiff},      {"BM", 0, decode_bmp_gif_tga},
    {"GIF8", 0, decode_bmp_gif_tga},
};
/// Told by name, since tools write them.
constexpr std::pair<std::string_view, const char*> kUnsupported[] = {
    {"\xABKTX 20\xBB", "KTX2"},      {"\xABKTX 11\xBB", "KTX"}, {"DDS ", "DDS"},
    {"\x76\x2f\x31\x01", "OpenEXR"}, {"#?", "Radiance HDR"},    {"8BPS", "Photoshop"},
};

}  // namespace

std::optional<std::string> size_fault(std::uint32_t width, std::uint32_t height, std::uint64_t max_pixels) {
    const std::string size =
        "its size is " + std::to_string(width) + " x " + std::to_string(height) + " pixels, ";
    if (width > kMaxImageSide || height > kMaxImageSide)
        return size + "but a side may have at most " + std::to_string(kMaxImageSide);
    if (std::uint64_t{width} * height > max_pixels)
        return size + "but at most " + std::to_string(max_pixels) + " in all can be read";
    return std::nullopt;
}

DecodedImage decode_image(std::string_view bytes, std::uint64_t max_pixels) {
    for (const Format& format : kFormats)
        if (bytes.substr(std::min(format.offset, bytes.size())).starts_with(format.signature))
            return format.decode(bytes, max_pixels);
    for (const auto& [signature, name] : kUnsupported)
        if (bytes.starts_with(signature))
            return tl::unexpected("it is " + std::string(name) + ", which is not supported: save it as PNG");
    if (may_be_tga(bytes)) return decode_bmp_gif_tga(bytes, max_pixels);
    return tl::unexpected(std::string("it is none of PNG, JPEG, WebP, TIFF, BMP, GIF and TGA"));
}

DecodedImage read_image_file(const std::filesystem::path& path, std::uint64_t max_pixels) {
    const auto bytes = base::read_bytes(path, kMaxFileBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    return decode_image(*bytes, max_pixels);
}

}  // namespace vrut::io
