#include "decoded_film.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstdlib>
#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

namespace vrut::test {

namespace {

/// From the bottom row up, by the film's own tags.
scene::Image image_of(const AVFrame& frame) {
    scene::Image image;
    image.resize(frame.width, frame.height);
    SwsContext* const converter = sws_getContext(
        frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.width, frame.height,
        AV_PIX_FMT_RGBA, SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT, nullptr, nullptr,
        nullptr);
    REQUIRE(converter);
    const int matrix = frame.colorspace == AVCOL_SPC_BT709 ? SWS_CS_ITU709 : SWS_CS_DEFAULT;
    sws_setColorspaceDetails(converter, sws_getCoefficients(matrix), frame.color_range == AVCOL_RANGE_JPEG,
                             sws_getCoefficients(matrix), 1, 0, 1 << 16, 1 << 16);
    const int stride = 4 * frame.width;
    const std::array rows{image.rgba.data() +
                          static_cast<std::size_t>(stride) * static_cast<std::size_t>(frame.height - 1)};
    const std::array strides{-stride};
    sws_scale(converter, frame.data, frame.linesize, 0, frame.height, rows.data(), strides.data());
    sws_freeContext(converter);
    return image;
}

void take_images(AVCodecContext& codec, AVFrame& frame, DecodedFilm& film) {
    while (avcodec_receive_frame(&codec, &frame) == 0) film.images.push_back(image_of(frame));
}

}  // namespace

DecodedFilm decode_film(const std::filesystem::path& file) {
    AVFormatContext* format = nullptr;
    REQUIRE(avformat_open_input(&format, file.c_str(), nullptr, nullptr) == 0);
    REQUIRE(avformat_find_stream_info(format, nullptr) >= 0);
    REQUIRE(format->nb_streams == 1);
    const AVStream& stream = **format->streams;
    const AVCodec* const decoder = avcodec_find_decoder(stream.codecpar->codec_id);
    REQUIRE(decoder);
    AVCodecContext* codec = avcodec_alloc_context3(decoder);
    avcodec_parameters_to_context(codec, stream.codecpar);
    REQUIRE(avcodec_open2(codec, decoder, nullptr) == 0);
    DecodedFilm film{decoder->name,
                     codec->colorspace == AVCOL_SPC_BT709 && codec->color_primaries == AVCOL_PRI_BT709 &&
                         codec->color_trc == AVCOL_TRC_BT709,
                     codec->color_range == AVCOL_RANGE_MPEG,
                     av_q2d(stream.avg_frame_rate),
                     static_cast<double>(format->duration) / AV_TIME_BASE,
                     {}};
    AVPacket* packet = av_packet_alloc();
    AVFrame* frame = av_frame_alloc();
    while (av_read_frame(format, packet) == 0) {
        REQUIRE(avcodec_send_packet(codec, packet) == 0);
        av_packet_unref(packet);
        take_images(*codec, *frame, film);
    }
    avcodec_send_packet(codec, nullptr);
    take_images(*codec, *frame, film);
    av_frame_free(&frame);
    av_packet_free(&packet);
    avcodec_free_context(&codec);
    avformat_close_input(&format);
    return film;
}

double mean_difference(const scene::Image& a, const scene::Image& b) {
    REQUIRE(a.width == b.width);
    REQUIRE(a.height == b.height);
    double sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        if (i % 4 != 3) sum += std::abs(a.rgba[i] - b.rgba[i]);
    return sum / (3.0 * a.width * a.height);
}

}  // namespace vrut::test
