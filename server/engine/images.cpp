#include "engine/images.hpp"

#include <turbojpeg.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <exception>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <variant>

namespace vrut::server::engine {

namespace {

using Bytes = std::vector<std::uint8_t>;

/// A strip has at most so many pixels, or one row of MCUs where that has more. It then has at most 65535
/// MCUs, as a restart interval must. Smaller ones gain nothing (tests/bench/jpeg_bench.cpp).
constexpr int kMaxStripPixels = 1 << 17;
constexpr int kMaxSide = 65'500;  // libjpeg's JPEG_MAX_DIMENSION

int mcu_side(bool subsampled) { return subsampled ? 16 : 8; }

int round_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

/// In pixels, a multiple of the MCU's height.
int strip_height(int width, bool subsampled) {
    const int mcu = mcu_side(subsampled);
    return std::max(1, kMaxStripPixels / (width * mcu)) * mcu;
}

std::size_t big_endian_16(std::span<const std::uint8_t> bytes, std::size_t at) {
    return static_cast<std::size_t>(bytes[at]) << 8 | bytes[at + 1];
}

/// Offset of the first marker segment of that kind, one that stands before the entropy-coded data.
std::size_t find_segment(std::span<const std::uint8_t> jpeg, std::uint8_t marker) {
    std::size_t at = 2;  // behind SOI
    while (jpeg[at + 1] != marker) at += 2 + big_endian_16(jpeg, at + 2);
    return at;
}

constexpr std::uint8_t kSof0 = 0xC0, kRst0 = 0xD0, kEoi = 0xD9, kSos = 0xDA, kDri = 0xDD;

/// The entropy-coded data between SOS and EOI.
std::span<const std::uint8_t> entropy_coded(std::span<const std::uint8_t> jpeg) {
    const std::size_t sos = find_segment(jpeg, kSos);
    const std::size_t start = sos + 2 + big_endian_16(jpeg, sos + 2);
    return jpeg.subspan(start, jpeg.size() - start - 2);
}

std::array<std::uint8_t, 2> two_bytes(int value) {
    return {static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value & 0xFF)};
}

/// ITU-T T.81, B.2.2.
void set_size(Bytes& jpeg, int width, int height) {
    const auto sof = static_cast<std::ptrdiff_t>(find_segment(jpeg, kSof0));
    std::ranges::copy(two_bytes(height), jpeg.begin() + sof + 5);
    std::ranges::copy(two_bytes(width), jpeg.begin() + sof + 7);
}

/// In MCUs; the file has none yet (B.2.4.4).
void set_restart_interval(Bytes& jpeg, int interval) {
    const auto sos = static_cast<std::ptrdiff_t>(find_segment(jpeg, kSos));
    const auto [high, low] = two_bytes(interval);
    const std::uint8_t dri[] = {0xFF, kDri, 0, 4, high, low};
    jpeg.insert(jpeg.begin() + sos, std::begin(dri), std::end(dri));
}

}  // namespace

struct JpegEncoder::Job {
    std::variant<const scene::Image*, const scene::PlanarImage*> image;
    int width, height;
    int quality;
    bool subsampled;
    int strip_height = 0;  // of all but the last
    std::vector<Bytes> strips =
        {};  // the first with its headers, the others from the first entropy-coded byte
    std::size_t next = 0, in_progress = 0;
    std::exception_ptr error = nullptr;
};

class JpegEncoder::Compressor {
public:
    Compressor() : handle_(tjInitCompress()) {
        if (!handle_) throw std::runtime_error("the JPEG encoder does not start");
    }
    ~Compressor() { tjDestroy(handle_); }
    Compressor(const Compressor&) = delete;
    Compressor& operator=(const Compressor&) = delete;

    Bytes compress(const Job& job, std::size_t strip) {
        const int top = static_cast<int>(strip) * job.strip_height;
        const int height = std::min(job.strip_height, job.height - top);
        const int sampling = job.subsampled ? TJSAMP_420 : TJSAMP_444;
        // What the worst strip needs is many times what most take: it is kept for the next, and the file
        // copied.
        const int side = mcu_side(job.subsampled);
        const unsigned long worst = tjBufSize(round_up(job.width, side), height, sampling);
        if (scratch_size_ < worst) {
            scratch_ = std::make_unique_for_overwrite<std::uint8_t[]>(worst);
            scratch_size_ = worst;
        }
        unsigned char* out = scratch_.get();
        unsigned long size = scratch_size_;
        const auto* rgba = std::get_if<const scene::Image*>(&job.image);
        const int status = rgba ? compress_rgba(job, **rgba, top, height, out, size)
                                : compress_planes(job, *std::get<1>(job.image), top, height, out, size);
        if (status != 0)
            throw std::runtime_error(std::string("an image cannot be encoded as JPEG: ") +
                                     tjGetErrorStr2(handle_));
        const std::span<const std::uint8_t> file(out, size), coded = entropy_coded(file);
        return {strip == 0 ? file.begin() : coded.begin(), coded.end()};
    }

private:
    int compress_rgba(const Job& job, const scene::Image& image, int top, int height, unsigned char* out,
                      unsigned long& size) {
        const auto rows_below = static_cast<std::size_t>(image.height - top - height);
        const std::uint8_t* pixels =
            image.rgba.data() + rows_below * static_cast<std::size_t>(image.width) * 4;
        return tjCompress2(handle_, pixels, image.width, 0, height, TJPF_RGBA, &out, &size,
                           job.subsampled ? TJSAMP_420 : TJSAMP_444, job.quality,
                           TJFLAG_BOTTOMUP | TJFLAG_NOREALLOC);
    }

    /// At the padded width: libjpeg would pad chroma in 4:2:0 with the average of the last pixels.
    int compress_planes(const Job& job, const scene::PlanarImage& image, int top, int height,
                        unsigned char* out, unsigned long& size) {
        const int stride = image.stride(), chroma_top = job.subsampled ? top / 2 : top;
        const auto row = [&](int y) {
            return image.bytes.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(stride);
        };
        const std::uint8_t* cb = row(image.luma_rows() + chroma_top);
        const std::uint8_t* cr = job.subsampled ? cb + stride / 2 : row(image.luma_rows() * 2 + top);
        const unsigned char* planes[] = {row(top), cb, cr};
        const int strides[] = {stride, stride, stride};
        return tjCompressFromYUVPlanes(handle_, planes, stride, strides, height,
                                       job.subsampled ? TJSAMP_420 : TJSAMP_444, &out, &size, job.quality,
                                       TJFLAG_NOREALLOC);
    }

    tjhandle handle_;
    std::unique_ptr<std::uint8_t[]> scratch_;  // of the largest size that was needed
    std::size_t scratch_size_ = 0;
};

JpegEncoder::JpegEncoder() : compressor_(std::make_unique<Compressor>()) {
    const unsigned threads = std::min(std::thread::hardware_concurrency(), kMaxThreads);
    try {
        while (workers_.size() + 1 < threads)
            workers_.emplace_back([this, compressor = std::make_unique<Compressor>()](
                                      const std::stop_token& stop) { work(stop, *compressor); });
    } catch (const std::system_error&) {  // no thread can be had: it encodes with fewer
    }
}

JpegEncoder::~JpegEncoder() = default;

void JpegEncoder::work(const std::stop_token& stop, Compressor& compressor) {
    std::unique_lock lock(mutex_);
    while (strips_left_.wait(lock, stop, [&] { return job_ && job_->next < job_->strips.size(); })) {
        compress_strips(lock, compressor);
        strip_done_.notify_one();
    }
}

/// Until none is left to begin.
void JpegEncoder::compress_strips(std::unique_lock<std::mutex>& lock, Compressor& compressor) {
    Job& job = *job_;
    while (job.next < job.strips.size()) {
        const std::size_t strip = job.next++;
        ++job.in_progress;
        lock.unlock();
        std::exception_ptr error;
        try {
            job.strips[strip] = compressor.compress(job, strip);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        --job.in_progress;
        if (error) {
            job.error = error;
            job.next = job.strips.size();
        }
    }
}

Bytes JpegEncoder::encode(const scene::Image& image, int quality, bool subsampled) {
    return encode(Job{&image, image.width, image.height, quality, subsampled});
}

Bytes JpegEncoder::encode(const scene::PlanarImage& image, int quality) {
    return encode(Job{&image, image.width, image.height, quality, image.subsampled});
}

Bytes JpegEncoder::encode(Job job) {
    if (std::min(job.width, job.height) < 1 || std::max(job.width, job.height) > kMaxSide)
        throw std::runtime_error("an image of " + std::to_string(job.width) + " x " +
                                 std::to_string(job.height) + " pixels cannot be encoded as JPEG");
    job.strip_height = strip_height(job.width, job.subsampled);
    job.strips.resize(static_cast<std::size_t>((job.height - 1) / job.strip_height) + 1);
    {
        std::unique_lock lock(mutex_);
        job_ = &job;
        for (std::size_t i = 1; i < std::min(job.strips.size(), workers_.size() + 1); ++i)
            strips_left_.notify_one();
        compress_strips(lock, *compressor_);
        strip_done_.wait(lock, [&] { return job.in_progress == 0; });
        job_ = nullptr;
    }
    if (job.error) std::rethrow_exception(job.error);

    Bytes jpeg = std::move(job.strips[0]);
    set_size(jpeg, job.width, job.height);
    if (job.strips.size() > 1) {
        const int mcu = mcu_side(job.subsampled);
        set_restart_interval(jpeg, round_up(job.width, mcu) / mcu * (job.strip_height / mcu));
    }
    std::size_t size = jpeg.size();
    for (const Bytes& strip : job.strips) size += strip.size() + 2;  // the first is empty now
    jpeg.reserve(size);
    for (std::size_t i = 1; i < job.strips.size(); ++i) {
        jpeg.insert(jpeg.end(), {0xFF, static_cast<std::uint8_t>(kRst0 + (i - 1) % 8)});
        jpeg.insert(jpeg.end(), job.strips[i].begin(), job.strips[i].end());
    }
    jpeg.insert(jpeg.end(), {0xFF, kEoi});
    return jpeg;
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
