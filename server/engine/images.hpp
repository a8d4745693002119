#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/texture_writer.hpp"
#include "scene/image.hpp"

namespace vrut::server::engine {

/// Encodes pictures as JFIF files. One for each thread.
class JpegEncoder {
public:
    JpegEncoder();
    ~JpegEncoder();
    JpegEncoder(const JpegEncoder&) = delete;
    JpegEncoder& operator=(const JpegEncoder&) = delete;

    /// `quality` 1 to 100; 4:2:0 when `subsampled`, else 4:4:4. Throws std::runtime_error.
    std::vector<std::uint8_t> encode(const scene::Image& image, int quality, bool subsampled);

private:
    void* handle_;
    std::unique_ptr<std::uint8_t[]> scratch_;  // of the largest size that was needed
    std::size_t scratch_size_ = 0;
};

/// RGB in 32-bit floats, rows from the bottom up, as a PFM file.
std::vector<std::uint8_t> encode_pfm(int width, int height, std::span<const glm::dvec3> colors);

/// Where in a PNG file a text chunk may go: behind its signature and IHDR.
inline constexpr std::size_t kPngTextOffset = 33;
/// An uncompressed iTXt chunk with keyword `vrut-preview` that holds `text`.
std::vector<std::uint8_t> png_text_chunk(const std::string& text);

}  // namespace vrut::server::engine
