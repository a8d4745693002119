#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <memory>
#include <vector>

#include "io/image/decoders.hpp"

namespace vrut::io {

namespace {

/// A TIFF in memory, as libtiff reads files, and the first thing that it complained of.
class TiffReader {
public:
    explicit TiffReader(std::string_view bytes) : bytes_(bytes), tiff_(nullptr, TIFFClose) {
        const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                                   TIFFOpenOptionsFree);
        if (!options) return;
        TIFFOpenOptionsSetErrorHandlerExtR(options.get(), complain, this);
        TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_warning, this);
        tiff_.reset(TIFFClientOpenExt("", "rm", this, read, write, seek, close, size, nullptr, nullptr,
                                      options.get()));
    }
    TiffReader(const TiffReader&) = delete;
    TiffReader& operator=(const TiffReader&) = delete;

    TIFF* get() const { return tiff_.get(); }
    std::string fault() const { return std::string("the TIFF is damaged: ") + message_; }

private:
    static TiffReader& of(thandle_t handle) { return *static_cast<TiffReader*>(handle); }
    static tmsize_t read(thandle_t handle, void* out, tmsize_t count) {
        TiffReader& self = of(handle);
        const std::size_t from = std::min<std::size_t>(self.position_, self.bytes_.size());
        const std::size_t read = self.bytes_.substr(from).copy(
            static_cast<char*>(out), static_cast<std::size_t>(std::max<tmsize_t>(count, 0)));
        self.position_ += read;
        return static_cast<tmsize_t>(read);
    }
    static tmsize_t write(thandle_t, void*, tmsize_t) { return 0; }
    static toff_t seek(thandle_t handle, toff_t offset, int whence) {
        TiffReader& self = of(handle);
        const toff_t base = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? self.position_ : self.bytes_.size();
        self.position_ = base + offset;
        return self.position_;
    }
    static int close(thandle_t) { return 0; }
    static toff_t size(thandle_t handle) { return of(handle).bytes_.size(); }
    static int complain(TIFF*, void* user, const char*, const char* format, va_list values) {
        auto* self = static_cast<TiffReader*>(user);
        if (!self->complained_) std::vsnprintf(self->message_, sizeof self->message_, format, values);
        self->complained_ = true;
        return 1;
    }
    static int ignore_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

    std::string_view bytes_;
    toff_t position_ = 0;
    char message_[160] = "it cannot be read";
    bool complained_ = false;
    std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_;
};

/// libtiff gives colours times alpha.
void divide_by_alpha(scene::Image& image) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const unsigned alpha = image.rgba[i + 3];
        if (alpha == 0 || alpha == 255) continue;
        for (std::size_t k = i; k < i + 3; ++k)
            image.rgba[k] =
                static_cast<std::uint8_t>(std::min(255U, (image.rgba[k] * 255U + alpha / 2) / alpha));
    }
}

}  // namespace

DecodedImage decode_tiff(std::string_view bytes, std::uint64_t max_pixels) {
    const TiffReader reader(bytes);
    std::uint32_t width = 0, height = 0;
    if (!reader.get() || TIFFGetField(reader.get(), TIFFTAG_IMAGEWIDTH, &width) == 0 ||
        TIFFGetField(reader.get(), TIFFTAG_IMAGELENGTH, &height) == 0 || width == 0 || height == 0)
        return tl::unexpected(reader.fault());
    if (auto fault = size_fault(width, height, max_pixels)) return tl::unexpected(*std::move(fault));
    scene::Image image;
    image.resize(static_cast<int>(width), static_cast<int>(height));
    std::vector<std::uint32_t> pixels(std::size_t{width} * height);
    constexpr int kStopOnError = 1;
    if (TIFFReadRGBAImageOriented(reader.get(), width, height, pixels.data(), ORIENTATION_BOTLEFT,
                                  kStopOnError) == 0)
        return tl::unexpected(reader.fault());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        image.rgba[4 * i] = static_cast<std::uint8_t>(TIFFGetR(pixels[i]));
        image.rgba[4 * i + 1] = static_cast<std::uint8_t>(TIFFGetG(pixels[i]));
        image.rgba[4 * i + 2] = static_cast<std::uint8_t>(TIFFGetB(pixels[i]));
        image.rgba[4 * i + 3] = static_cast<std::uint8_t>(TIFFGetA(pixels[i]));
    }
    divide_by_alpha(image);
    return image;
}

}  // namespace vrut::io
