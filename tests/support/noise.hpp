#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "scene/image.hpp"

namespace vrut {

/// Opaque; every texel is random.
inline scene::Image noise(int width, int height, unsigned seed = 1) {
    std::mt19937 random(seed);
    scene::Image image;
    image.resize(width, height);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(random() >> 24);
    return image;
}

/// Opaque: the sum of noise of all cell sizes, whose spectrum is like a photograph's.
inline scene::Image cloudy(int width, int height, unsigned seed = 1) {
    scene::Image image;
    image.resize(width, height);
    std::vector<double> sums(image.rgba.size(), 0);
    for (int cell = std::max(width, height); cell >= 1; cell /= 2) {
        const scene::Image layer =
            noise(width / cell + 1, height / cell + 1, seed + static_cast<unsigned>(cell));
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const auto texel = static_cast<int>(i / 4);
            const int x = texel % width / cell, y = texel / width / cell;
            sums[i] += layer.rgba[static_cast<std::size_t>(y * layer.width + x) * 4 + i % 4] - 127.5;
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        image.rgba[i] =
            i % 4 == 3 ? 255 : static_cast<std::uint8_t>(std::clamp(127.5 + sums[i] / 3, 0.0, 255.0));
    return image;
}

}  // namespace vrut
