#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/image.hpp"
#include "scene/scene.hpp"

namespace vrut::compare {

/// The difference of two images in red, green and blue, in steps of 1/255; alpha is not compared.
struct Difference {
    /// pixels[k]: those whose channel furthest off is off by k.
    std::array<std::uint64_t, 256> pixels{};
    double sum_of_squares = 0;  ///< over all channels of all pixels

    std::uint64_t count() const;
    /// The largest difference of a channel.
    int maximum() const;
    /// Root of the mean square over channels and pixels; 0 without pixels.
    double rms() const;
    /// Peak signal-to-noise ratio in dB, 20 log10(255 / rms()); infinite for equal images.
    double psnr() const;
    /// Part of the pixels, 0 to 1, with a channel off by more than `steps`.
    double share_above(int steps) const;
};

/// Compares the pixels for which `counts` (one value for each pixel, in the images' row order) is true, or
/// all if it is empty. Throws std::invalid_argument if sizes differ.
Difference difference(const scene::Image& a, const scene::Image& b, const std::vector<bool>& counts = {});

/// Returns for each pixel whether it and its eight neighbours, all inside the image, show the same node.
std::vector<bool> interior_pixels(const std::vector<scene::Index>& nodes, int width, int height);

}  // namespace vrut::compare
