#pragma once

#include <algorithm>
#include <array>

#include "scene/image.hpp"

namespace vrut {

/// As libjpeg converts and downsamples (jccolor.c, jcsample.c), pixel by pixel.
inline scene::PlanarImage planes_of(const scene::Image& image, bool subsampled) {
    scene::PlanarImage planes;
    planes.resize(image.width, image.height, subsampled);
    const auto pixel = [&](int x, int y) {
        x = std::min(x, image.width - 1);
        y = image.height - 1 - std::min(y, image.height - 1);
        const std::size_t at = (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                static_cast<std::size_t>(x)) *
                               4;
        return std::array<int, 3>{image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
    };
    const auto luma = [&](int x, int y) {
        const auto [r, g, b] = pixel(x, y);
        return (19595 * r + 38470 * g + 7471 * b + 32768) / 65536;
    };
    const auto chroma = [&](bool red, int x, int y) {
        const auto [r, g, b] = pixel(x, y);
        const int sum = red ? 32768 * r - 27439 * g - 5329 * b : 32768 * b - 11059 * r - 21709 * g;
        return (sum + 128 * 65536 + 32767) / 65536;
    };
    const auto set = [&](int x, int row, int value) {
        planes.bytes[static_cast<std::size_t>(row) * static_cast<std::size_t>(planes.stride()) +
                     static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(value);
    };
    const int stride = planes.stride(), rows = planes.luma_rows();
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < stride; ++x) {
            set(x, y, luma(x, y));
            for (const bool red : {false, true}) {
                if (!subsampled) {
                    set(x, rows * (red ? 2 : 1) + y, chroma(red, x, y));
                } else if (x % 2 == 0 && y % 2 == 0) {
                    const int sum = chroma(red, x, y) + chroma(red, x + 1, y) + chroma(red, x, y + 1) +
                                    chroma(red, x + 1, y + 1);
                    set(x / 2 + (red ? stride / 2 : 0), rows + y / 2, (sum + 1 + x / 2 % 2) / 4);
                }
            }
        }
    return planes;
}

}  // namespace vrut
