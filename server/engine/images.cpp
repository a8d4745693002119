#include "engine/images.hpp"

#include <turbojpeg.h>
#include <zlib.h>

#include <bit>
#include <memory>
#include <stdexcept>

namespace vrut::server::engine {

JpegEncoder::JpegEncoder() : handle_(tjInitCompress()) {
    if (!handle_) throw std::runtime_error("the JPEG encoder does not start");
}

JpegEncoder::~JpegEncoder() { tjDestroy(handle_); }

std::vector<std::uint8_t> JpegEncoder::encode(const scene::Image& image, int quality, bool subsampled) {
    const int sampling = subsampled ? TJSAMP_420 : TJSAMP_444;
    // What the worst picture needs is many times what most take: it is kept for the next, and the file
    // copied.
    const unsigned long worst = tjBufSize(image.width, image.height, sampling);
    if (worst == static_cast<unsigned long>(-1))
        throw std::runtime_error("a picture of " + std::to_string(image.width) + " x " +
                                 std::to_string(image.height) + " pixels cannot be encoded as JPEG");
    if (scratch_size_ < worst) {
        scratch_ = std::make_unique_for_overwrite<std::uint8_t[]>(worst);
        scratch_size_ = worst;
    }
    unsigned char* out = scratch_.get();
    unsigned long size = scratch_size_;
    if (tjCompress2(handle_, image.rgba.data(), image.width, 0, image.height, TJPF_RGBA, &out, &size,
                    sampling, quality, TJFLAG_BOTTOMUP | TJFLAG_NOREALLOC) != 0)
        throw std::runtime_error(std::string("a picture cannot be encoded as JPEG: ") +
                                 tjGetErrorStr2(handle_));
    return {scratch_.get(), scratch_.get() + size};
}

std::vector<std::uint8_t> encode_pfm(int width, int height, std::span<const glm::dvec3> colors) {
    const std::string header =
        "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";  // little-endian
    std::vector<std::uint8_t> pfm(header.begin(), header.end());
    pfm.reserve(pfm.size() + colors.size() * 12);
    for (const glm::dvec3& color : colors)
        for (int k = 0; k < 3; ++k) {
            const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(color[k]));
            for (unsigned shift = 0; shift < 32; shift += 8)
                pfm.push_back(static_cast<std::uint8_t>(bits >> shift));
        }
    return pfm;
}

std::vector<std::uint8_t> png_text_chunk(const std::string& text) {
    // Keyword, its end, no compression, the method of none, and empty language and translated keyword.
    const std::string body = std::string("iTXtvrut-preview") + std::string(5, '\0') + text;
    const auto* bytes = reinterpret_cast<const Bytef*>(body.data());
    const auto big_endian = [](std::size_t value) {
        std::string four(4, '\0');
        for (std::size_t i = 0; i < 4; ++i) four[i] = static_cast<char>(value >> (24 - 8 * i) & 0xFF);
        return four;
    };
    const std::string chunk =
        big_endian(body.size() - 4) + body + big_endian(crc32(0, bytes, static_cast<uInt>(body.size())));
    return {chunk.begin(), chunk.end()};
}

}  // namespace vrut::server::engine
