#pragma once

#include <png.h>
#include <turbojpeg.h>

#include <cstdint>
#include <string>
#include <vector>

/// A PNG to be written: `rows` from the top down, packed as the kind of file has them.
struct PngFile {
    int width = 1, height = 1;
    int color_type = PNG_COLOR_TYPE_RGB, depth = 8;
    bool interlaced = false;
    std::vector<std::vector<std::uint8_t>> rows = {};
    std::vector<png_color> palette = {};
    std::vector<std::uint8_t> palette_alpha = {};
    const png_color_16* key = nullptr;  ///< the colour that is seen through
    double gamma = 0;                   ///< 0: no gAMA
};

inline std::string png_bytes(PngFile file) {
    std::string bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &bytes,
        [](png_structp self, png_bytep data, png_size_t size) {
            static_cast<std::string*>(png_get_io_ptr(self))->append(reinterpret_cast<char*>(data), size);
        },
        nullptr);
    png_set_IHDR(png, info, static_cast<unsigned>(file.width), static_cast<unsigned>(file.height), file.depth,
                 file.color_type, file.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!file.palette.empty())
        png_set_PLTE(png, info, file.palette.data(), static_cast<int>(file.palette.size()));
    if (!file.palette_alpha.empty())
        png_set_tRNS(png, info, file.palette_alpha.data(), static_cast<int>(file.palette_alpha.size()),
                     nullptr);
    if (file.key) png_set_tRNS(png, info, nullptr, 0, file.key);
    if (file.gamma > 0) png_set_gAMA(png, info, file.gamma);
    png_write_info(png, info);
    std::vector<png_bytep> rows;
    for (auto& row : file.rows) rows.push_back(row.data());
    png_write_image(png, rows.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

/// One colour all over; RGBA.
inline std::string flat_png(int width, int height, const std::vector<std::uint8_t>& rgba) {
    std::vector<std::uint8_t> row;
    for (int x = 0; x < width; ++x) row.insert(row.end(), rgba.begin(), rgba.end());
    return png_bytes({.width = width,
                      .height = height,
                      .color_type = PNG_COLOR_TYPE_RGBA,
                      .rows = std::vector(static_cast<std::size_t>(height), row)});
}

/// From RGB rows, top down, at quality 100 and full colour.
inline std::string jpeg_bytes(int width, int height, const std::vector<std::uint8_t>& rgb, bool grey = false,
                              int flags = 0) {
    tjhandle encoder = tjInitCompress();
    unsigned char* data = nullptr;
    unsigned long size = 0;
    tjCompress2(encoder, rgb.data(), width, 0, height, TJPF_RGB, &data, &size,
                grey ? TJSAMP_GRAY : TJSAMP_444, 100, flags);
    std::string bytes(reinterpret_cast<char*>(data), size);
    tjFree(data);
    tjDestroy(encoder);
    return bytes;
}
