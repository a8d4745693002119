#include "io/image_file.hpp"

#include <png.h>
#include <turbojpeg.h>

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "base/file_bytes.hpp"

namespace vrut::io {

namespace {

using Result = tl::expected<scene::Image, std::string>;

// What the largest image takes uncompressed: 16 bits RGBA.
constexpr std::uintmax_t kMaxFileBytes = kMaxImagePixels * 8 + (std::uintmax_t{1} << 20);

std::optional<std::string> size_fault(std::uint32_t width, std::uint32_t height, std::uint64_t max_pixels) {
    const std::string size =
        "its size is " + std::to_string(width) + " x " + std::to_string(height) + " pixels, ";
    if (width > kMaxImageSide || height > kMaxImageSide)
        return size + "but a side may have at most " + std::to_string(kMaxImageSide);
    if (std::uint64_t{width} * height > max_pixels)
        return size + "but at most " + std::to_string(max_pixels) + " in all can be read";
    return std::nullopt;
}

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

Result decode_png(std::string_view bytes, std::uint64_t max_pixels) {
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

Result decode_jpeg(std::string_view bytes, std::uint64_t max_pixels) {
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

}  // namespace

Result decode_image(std::string_view bytes, std::uint64_t max_pixels) {
    if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return decode_png(bytes, max_pixels);
    if (bytes.starts_with("\xFF\xD8\xFF")) return decode_jpeg(bytes, max_pixels);
    return tl::unexpected(std::string("it is neither PNG nor JPEG"));
}

Result read_image_file(const std::filesystem::path& path, std::uint64_t max_pixels) {
    const auto bytes = base::read_bytes(path, kMaxFileBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    return decode_image(*bytes, max_pixels);
}

}  // namespace vrut::io
