#include "commands/film_writer.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "commands/libav.hpp"

namespace vrut::server::commands {

namespace fs = std::filesystem;

// Not in the namespace below: the writer has members of these.
struct LibavDeleter {
    void operator()(AVCodecContext* codec) const { libav().avcodec_free_context(&codec); }
    void operator()(AVFrame* frame) const { libav().av_frame_free(&frame); }
    void operator()(AVPacket* packet) const { libav().av_packet_free(&packet); }
    void operator()(SwsContext* converter) const { libav().sws_freeContext(converter); }
    void operator()(AVFormatContext* format) const {
        libav().avio_closep(&format->pb);
        libav().avformat_free_context(format);
    }
};
template <class Type>
using Owned = std::unique_ptr<Type, LibavDeleter>;

namespace {

/// Those that need no device, the better one first.
constexpr std::array kFilmEncoders{"libx264", "mpeg4"};

/// How many there are decides about the bytes, so it is the same everywhere.
constexpr int kThreads = 4;

/// Constant, near what the eye can tell from the images.
void set_quality(AVCodecContext& codec) {
    codec.thread_count = kThreads;
    codec.flags |= AV_CODEC_FLAG_BITEXACT;
    if (codec.codec_id == AV_CODEC_ID_MPEG4) {
        codec.flags |= AV_CODEC_FLAG_QSCALE;
        codec.global_quality = 2 * FF_QP2LAMBDA;
    } else {
        libav().av_opt_set(codec.priv_data, "crf", "18", 0);
        // Else some of its routines depend on the processor, and on what memory held before (x264 164).
        libav().av_opt_set(codec.priv_data, "x264-params", "cpu-independent=1", 0);
    }
}

/// Null where there is no such encoder, or it does not take the size.
Owned<AVCodecContext> open_encoder(const char* name, int width, int height, int images_per_second) {
    const AVCodec* encoder = libav().avcodec_find_encoder_by_name(name);
    Owned<AVCodecContext> codec(encoder ? libav().avcodec_alloc_context3(encoder) : nullptr);
    if (!codec) return nullptr;
    codec->width = width;
    codec->height = height;
    codec->time_base = {1, images_per_second};
    codec->framerate = {images_per_second, 1};
    codec->pix_fmt = AV_PIX_FMT_YUV420P;
    codec->color_primaries = AVCOL_PRI_BT709;
    codec->color_trc = AVCOL_TRC_BT709;
    codec->colorspace = AVCOL_SPC_BT709;
    codec->color_range = AVCOL_RANGE_MPEG;
    codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;  // as MP4 has it
    set_quality(*codec);
    if (libav().avcodec_open2(codec.get(), encoder, nullptr) < 0) return nullptr;
    return codec;
}

/// Null where no encoder takes the size.
Owned<AVCodecContext> open_any_encoder(int width, int height, int images_per_second) {
    libav().av_log_set_level(AV_LOG_QUIET);  // what fails is thrown
    Owned<AVCodecContext> codec;
    for (const char* name : kFilmEncoders)
        if (!codec) codec = open_encoder(name, width, height, images_per_second);
    return codec;
}

/// From RGB of the full range to Y'CbCr of the limited range, both by BT.709.
Owned<SwsContext> open_converter(int width, int height) {
    constexpr int kFlags = SWS_BICUBIC | SWS_FULL_CHR_H_INP | SWS_ACCURATE_RND | SWS_BITEXACT;
    Owned<SwsContext> converter(libav().sws_getContext(width, height, AV_PIX_FMT_RGB0, width, height,
                                                       AV_PIX_FMT_YUV420P, kFlags, nullptr, nullptr,
                                                       nullptr));
    const int* bt709 = libav().sws_getCoefficients(SWS_CS_ITU709);
    if (converter) libav().sws_setColorspaceDetails(converter.get(), bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
    return converter;
}

Owned<AVFrame> empty_frame(int width, int height) {
    Owned<AVFrame> frame(libav().av_frame_alloc());
    if (!frame) return nullptr;
    frame->width = width;
    frame->height = height;
    frame->format = AV_PIX_FMT_YUV420P;
    return libav().av_frame_get_buffer(frame.get(), 0) < 0 ? nullptr : std::move(frame);
}

}  // namespace

void require_film_encoder(const fs::path& path) {
    const std::string otherwise = ", or name it " + path.stem().string() + ".png for numbered images";
    const auto has_encoder = [](const char* name) { return libav().avcodec_find_encoder_by_name(name); };
    try {
        if (std::ranges::any_of(kFilmEncoders, has_encoder)) return;
    } catch (const std::exception& missing) {
        throw std::runtime_error(path.string() + ": " + missing.what() + "; install libavformat" +
                                 std::to_string(LIBAVFORMAT_VERSION_MAJOR) + " and libswscale" +
                                 std::to_string(LIBSWSCALE_VERSION_MAJOR) + otherwise);
    }
    throw std::runtime_error(path.string() +
                             ": libavcodec has no encoder of H.264 or MPEG-4; install one with libx264" +
                             otherwise);
}

class FilmWriter::File {
public:
    File(const fs::path& path, int width, int height, int images_per_second)
        : path_(path), beside_(path.string() + "." + std::to_string(getpid()) + ".part") {
        codec_ = open_any_encoder(width, height, images_per_second);
        if (!codec_)
            throw std::runtime_error(path.string() + ": no encoder takes films of " + std::to_string(width) +
                                     "x" + std::to_string(height) + " pixels; choose another --size");
        converter_ = open_converter(width, height);
        frame_ = empty_frame(width, height);
        packet_.reset(libav().av_packet_alloc());
        if (!converter_ || !frame_ || !packet_) throw_error(AVERROR(ENOMEM));
    }

    ~File() {
        if (!format_) return;
        format_.reset();
        std::error_code ignored;
        fs::remove(beside_, ignored);
    }

    void begin() {
        if (fs::is_directory(path_)) throw_error(AVERROR(EISDIR));
        AVFormatContext* format = nullptr;
        check(libav().avformat_alloc_output_context2(&format, nullptr, "mp4", nullptr));
        format_.reset(format);
        format->flags |= AVFMT_FLAG_BITEXACT;
        stream_ = libav().avformat_new_stream(format, nullptr);
        if (!stream_) throw_error(AVERROR(ENOMEM));
        stream_->time_base = codec_->time_base;
        stream_->avg_frame_rate = codec_->framerate;
        check(libav().avcodec_parameters_from_context(stream_->codecpar, codec_.get()));
        check(libav().avio_open(&format->pb, ("file:" + beside_).c_str(), AVIO_FLAG_WRITE));
        check(libav().avformat_write_header(format, nullptr));
    }

    void add(const scene::Image& image) {
        if (image.width != codec_->width || image.height != codec_->height)
            throw std::runtime_error(path_.string() + ": image " + std::to_string(images_ + 1) + " has " +
                                     std::to_string(image.width) + "x" + std::to_string(image.height) +
                                     " pixels, and the film " + std::to_string(codec_->width) + "x" +
                                     std::to_string(codec_->height));
        check(libav().av_frame_make_writable(frame_.get()));
        const int stride = 4 * image.width;
        const auto last_row = static_cast<std::size_t>(stride) * static_cast<std::size_t>(image.height - 1);
        const std::array<const std::uint8_t*, 1> rows{image.rgba.data() + last_row};
        const std::array<int, 1> strides{-stride};  // from the top down
        libav().sws_scale(converter_.get(), rows.data(), strides.data(), 0, image.height, frame_->data,
                          frame_->linesize);
        frame_->pts = images_++;
        encode(frame_.get());
    }

    void finish() {
        encode(nullptr);
        check(libav().av_write_trailer(format_.get()));
        check(libav().avio_closep(&format_->pb));
        std::error_code error;
        fs::rename(beside_, path_, error);
        check(AVERROR(error.value()));
        format_.reset();
    }

private:
    /// `frame`: null at the end.
    void encode(const AVFrame* frame) {
        check(libav().avcodec_send_frame(codec_.get(), frame));
        for (;;) {
            const int received = libav().avcodec_receive_packet(codec_.get(), packet_.get());
            if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) return;
            check(received);
            libav().av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
            check(libav().av_interleaved_write_frame(format_.get(), packet_.get()));
        }
    }

    void check(int result) const {
        if (result < 0) throw_error(result);
    }

    [[noreturn]] void throw_error(int error) const {
        std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
        libav().av_strerror(error, text.data(), text.size());
        throw std::runtime_error(path_.string() + " cannot be written: " + text.data());
    }

    fs::path path_;
    std::string beside_;
    Owned<AVCodecContext> codec_;
    Owned<SwsContext> converter_;
    Owned<AVFrame> frame_;
    Owned<AVPacket> packet_;
    Owned<AVFormatContext> format_;  ///< null where there is no file under the other name
    AVStream* stream_ = nullptr;     // the format's
    std::int64_t images_ = 0;
};

FilmWriter::FilmWriter(const fs::path& path, int width, int height, int images_per_second)
    : file_(std::make_unique<File>(path, width, height, images_per_second)) {
    file_->begin();  // where that fails, the file goes
}

FilmWriter::~FilmWriter() = default;

void FilmWriter::add(const scene::Image& image) { file_->add(image); }

void FilmWriter::finish() { file_->finish(); }

}  // namespace vrut::server::commands
