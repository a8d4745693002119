#include <webp/decode.h>

#include "io/image/decoders.hpp"

namespace vrut::io {

DecodedImage decode_webp(std::string_view bytes, std::uint64_t max_pixels) {
    const auto damaged = [] { return tl::unexpected(std::string("the WebP is damaged")); };
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    WebPDecoderConfig config;
    if (WebPInitDecoderConfig(&config) == 0 ||
        WebPGetFeatures(data, bytes.size(), &config.input) != VP8_STATUS_OK)
        return damaged();
    if (config.input.has_animation != 0)
        return tl::unexpected(std::string("it is an animated WebP: save one of its images"));
    const int width = config.input.width, height = config.input.height;
    if (auto fault =
            size_fault(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), max_pixels))
        return tl::unexpected(*std::move(fault));
    scene::Image image;
    image.resize(width, height);
    config.options.flip = 1;  // our rows are from the bottom up
    config.output.colorspace = MODE_RGBA;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = image.rgba.data();
    config.output.u.RGBA.stride = 4 * width;
    config.output.u.RGBA.size = image.rgba.size();
    const bool good = WebPDecode(data, bytes.size(), &config) == VP8_STATUS_OK;
    WebPFreeDecBuffer(&config.output);
    if (!good) return damaged();
    return image;
}

}  // namespace vrut::io
