#pragma once

#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace vrut::server::commands {

/// A shared library of the system.
class SharedLibrary {
public:
    /// Throws std::runtime_error where it is not there: a phrase that names it.
    explicit SharedLibrary(const std::string& name);
    /// Throws likewise.
    void* find(const char* function) const;

private:
    std::string name_;
    void* library_;
};

/// The functions of FFmpeg's libraries by their own names. They are loaded when a film is written: with them
/// come about a hundred libraries, for which every start of the program would wait.
class Libav {
    template <class Function>
    static Function find(const SharedLibrary& library, const char* name) {
        return reinterpret_cast<Function>(library.find(name));
    }

    SharedLibrary format_{"libavformat.so." +
                          std::to_string(LIBAVFORMAT_VERSION_MAJOR)};  // and what it is linked with
    SharedLibrary scale_{"libswscale.so." + std::to_string(LIBSWSCALE_VERSION_MAJOR)};

public:
    /// Throws std::runtime_error where a library is not there: a phrase that names it.
    Libav() = default;

// NOLINTNEXTLINE(bugprone-macro-parentheses): a member cannot be declared in them
#define VRUT_FUNCTION(library, name) decltype(&::name) name = find<decltype(&::name)>(library, #name)
    VRUT_FUNCTION(format_, av_frame_alloc);
    VRUT_FUNCTION(format_, av_frame_free);
    VRUT_FUNCTION(format_, av_frame_get_buffer);
    VRUT_FUNCTION(format_, av_frame_make_writable);
    VRUT_FUNCTION(format_, av_interleaved_write_frame);
    VRUT_FUNCTION(format_, av_log_set_level);
    VRUT_FUNCTION(format_, av_opt_set);
    VRUT_FUNCTION(format_, av_packet_alloc);
    VRUT_FUNCTION(format_, av_packet_free);
    VRUT_FUNCTION(format_, av_packet_rescale_ts);
    VRUT_FUNCTION(format_, av_strerror);
    VRUT_FUNCTION(format_, av_write_trailer);
    VRUT_FUNCTION(format_, avcodec_alloc_context3);
    VRUT_FUNCTION(format_, avcodec_find_encoder_by_name);
    VRUT_FUNCTION(format_, avcodec_free_context);
    VRUT_FUNCTION(format_, avcodec_open2);
    VRUT_FUNCTION(format_, avcodec_parameters_from_context);
    VRUT_FUNCTION(format_, avcodec_receive_packet);
    VRUT_FUNCTION(format_, avcodec_send_frame);
    VRUT_FUNCTION(format_, avformat_alloc_output_context2);
    VRUT_FUNCTION(format_, avformat_free_context);
    VRUT_FUNCTION(format_, avformat_new_stream);
    VRUT_FUNCTION(format_, avformat_write_header);
    VRUT_FUNCTION(format_, avio_closep);
    VRUT_FUNCTION(format_, avio_open);
    VRUT_FUNCTION(scale_, sws_freeContext);
    VRUT_FUNCTION(scale_, sws_getCoefficients);
    VRUT_FUNCTION(scale_, sws_getContext);
    VRUT_FUNCTION(scale_, sws_scale);
    VRUT_FUNCTION(scale_, sws_setColorspaceDetails);
#undef VRUT_FUNCTION
};

/// The same for the whole program. Throws as its constructor.
const Libav& libav();

}  // namespace vrut::server::commands
