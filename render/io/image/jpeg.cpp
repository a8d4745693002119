#include <turbojpeg.h>

#include <memory>

#include "io/image/decoders.hpp"

namespace vrut::io {

DecodedImage decode_jpeg(std::string_view bytes, std::uint64_t max_pixels) {
    const std::unique_ptr<void, int (*)(tjhandle)> decoder(tjInitDecompress(), tjDestroy);
    const auto fault = [&] {
        return tl::unexpected(std::string("the JPEG is damaged: ") + tjGetErrorStr2(decoder.get()));
    };
    if (!decoder) return fault();
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    int width = 0, height = 0, sampling = 0, colors = 0;
    if (tjDecompressHeader3(decoder.get(), data, bytes.size(), &width, &height, &sampling, &colors) != 0)
        return fault();
    if (colors == TJCS_CMYK || colors == TJCS_YCCK)
        return tl::unexpected(std::string("it is a CMYK JPEG: save it as RGB"));
    if (auto why =
            size_fault(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), max_pixels))
        return tl::unexpected(*std::move(why));
    scene::Image image;
    image.resize(width, height);
    // The limit is for progressive files: each of thousands of scans costs as much as the whole image.
    constexpr int kFlags = TJFLAG_BOTTOMUP | TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS;
    if (tjDecompress2(decoder.get(), data, bytes.size(), image.rgba.data(), width, 0, height, TJPF_RGBA,
                      kFlags) != 0)
        return fault();
    return image;
}

}  // namespace vrut::io
