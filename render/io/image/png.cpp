#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <vector>

#include "io/image/decoders.hpp"

namespace vrut::io {

namespace {

/// libpng leaves a call that fails by longjmp: nothing with a destructor lives in the functions that call it.
class PngDecoder {
public:
    explicit PngDecoder(std::string_view bytes)
        : rest_(bytes), png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore_warning)) {
        if (png_) info_ = png_create_info_struct(png_);
    }
    ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngDecoder(const PngDecoder&) = delete;
    PngDecoder& operator=(const PngDecoder&) = delete;

    bool read_header() {
        if (!png_ || !info_) return false;
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_set_read_fn(png_, this, read);
        // Of chunks, only those that pixels are made of: texts and profiles could unpack to anything.
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_read_info(png_, info_);
        return true;
    }
    std::uint32_t width() const { return png_get_image_width(png_, info_); }
    std::uint32_t height() const { return png_get_image_height(png_, info_); }

    /// `rows` from the top down, each of 4 bytes a pixel.
    bool read_pixels(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_set_expand(png_);
        png_set_scale_16(png_);
        png_set_gray_to_rgb(png_);
        png_set_add_alpha(png_, 255, PNG_FILLER_AFTER);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        png_read_image(png_, rows);
        png_read_end(png_, nullptr);
        return true;
    }

    std::string fault() const { return std::string("the PNG is damaged: ") + message_; }

private:
    static void fail(png_structp png, png_const_charp message) {
        auto* self = static_cast<PngDecoder*>(png_get_error_ptr(png));
        std::snprintf(self->message_, sizeof self->message_, "%s", message);
        png_longjmp(png, 1);
    }
    static void ignore_warning(png_structp, png_const_charp) {}
    static void read(png_structp png, png_bytep out, std::size_t count) {
        auto* self = static_cast<PngDecoder*>(png_get_io_ptr(png));
        if (count > self->rest_.size()) png_error(png, "it ends too early");
        std::memcpy(out, self->rest_.data(), count);
        self->rest_.remove_prefix(count);
    }

    std::string_view rest_;
    char message_[128] = "libpng cannot be initialized";
    png_structp png_;
    png_infop info_ = nullptr;
};

}  // namespace

DecodedImage decode_png(std::string_view bytes, std::uint64_t max_pixels) {
    PngDecoder decoder(bytes);
    if (!decoder.read_header()) return tl::unexpected(decoder.fault());
    if (auto fault = size_fault(decoder.width(), decoder.height(), max_pixels))
        return tl::unexpected(*std::move(fault));
    scene::Image image;
    image.resize(static_cast<int>(decoder.width()), static_cast<int>(decoder.height()));
    std::vector<png_bytep> rows;
    for (std::size_t row = decoder.height(); row-- > 0;)
        rows.push_back(image.rgba.data() + row * decoder.width() * 4);
    if (!decoder.read_pixels(rows.data())) return tl::unexpected(decoder.fault());
    return image;
}

}  // namespace vrut::io
