#pragma once

#include <condition_variable>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "io/texture_writer.hpp"
#include "scene/image.hpp"

namespace vrut::server::engine {

/// Encodes images as baseline JPEG (JFIF) with the Huffman tables of ITU-T T.81, K.3. Its threads encode
/// horizontal strips of an image, which are restart intervals of the file (E.1.3). The file depends on the
/// image alone, not on the number of threads. One caller at a time.
class JpegEncoder {
public:
    /// The caller's thread is one of them.
    static constexpr unsigned kMaxThreads = 4;

    JpegEncoder();
    ~JpegEncoder();

    /// `quality` 1 to 100; 4:2:0 when `subsampled`, else 4:4:4. Throws std::runtime_error.
    std::vector<std::uint8_t> encode(const scene::Image& image, int quality, bool subsampled);
    /// The same, without the conversion from RGBA.
    std::vector<std::uint8_t> encode(const scene::PlanarImage& image, int quality);

private:
    class Compressor;
    struct Job;

    std::vector<std::uint8_t> encode(Job job);

    void work(const std::stop_token& stop, Compressor& compressor);
    void compress_strips(std::unique_lock<std::mutex>& lock, Compressor& compressor);

    std::unique_ptr<Compressor> compressor_;  // of the caller's thread
    std::mutex mutex_;
    Job* job_ = nullptr;  // guarded by mutex_
    std::condition_variable_any strips_left_, strip_done_;
    std::vector<std::jthread> workers_;  // last: they use all of the above
};

/// RGB in 32-bit floats, rows from the bottom up, as a PFM file.
std::vector<std::uint8_t> encode_pfm(int width, int height, std::span<const glm::dvec3> colors);

/// Where in a PNG file a text chunk may go: behind its signature and IHDR.
inline constexpr std::size_t kPngTextOffset = 33;
/// An uncompressed iTXt chunk with keyword `vrut-preview` that holds `text`.
std::vector<std::uint8_t> png_text_chunk(const std::string& text);

}  // namespace vrut::server::engine
