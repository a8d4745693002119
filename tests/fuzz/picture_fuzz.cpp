#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "io/image/image_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::uint64_t kMostPixels = 1 << 16;
    const auto image = vrut::io::decode_image({reinterpret_cast<const char*>(data), size}, kMostPixels);
    if (!image) return 0;
    const auto pixels = static_cast<std::uint64_t>(image->width) * static_cast<std::uint64_t>(image->height);
    if (pixels > kMostPixels || image->rgba.size() != 4 * pixels) throw std::logic_error("of another size");
    return 0;
}
