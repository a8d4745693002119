#include "compare/difference.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace vrut::compare {

std::uint64_t Difference::count() const {
    return std::accumulate(pixels.begin(), pixels.end(), std::uint64_t{0});
}

int Difference::maximum() const {
    const auto last = std::find_if(pixels.rbegin(), pixels.rend(), [](std::uint64_t n) { return n > 0; });
    return std::max(static_cast<int>(pixels.rend() - last) - 1, 0);
}

double Difference::rms() const {
    const std::uint64_t n = count();
    return n > 0 ? std::sqrt(sum_of_squares / (3 * static_cast<double>(n))) : 0;
}

double Difference::psnr() const {
    return sum_of_squares > 0 ? 20 * std::log10(255 / rms()) : std::numeric_limits<double>::infinity();
}

double Difference::share_above(int steps) const {
    const std::uint64_t n = count();
    const std::uint64_t above = std::accumulate(pixels.begin() + steps + 1, pixels.end(), std::uint64_t{0});
    return n > 0 ? static_cast<double>(above) / static_cast<double>(n) : 0;
}

Difference difference(const scene::Image& a, const scene::Image& b, const std::vector<bool>& counts) {
    const std::size_t pixels = a.rgba.size() / 4;
    if (a.width != b.width || a.height != b.height || (!counts.empty() && counts.size() != pixels))
        throw std::invalid_argument("images of different sizes cannot be compared");
    Difference result;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (!counts.empty() && !counts[i]) continue;
        int furthest = 0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const int off = std::abs(int{a.rgba[i * 4 + channel]} - int{b.rgba[i * 4 + channel]});
            furthest = std::max(furthest, off);
            result.sum_of_squares += off * off;
        }
        ++result.pixels[static_cast<std::size_t>(furthest)];
    }
    return result;
}

std::vector<bool> interior_pixels(const std::vector<scene::Index>& nodes, int width, int height) {
    std::vector<bool> interior(nodes.size());
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    };
    for (int y = 1; y + 1 < height; ++y)
        for (int x = 1; x + 1 < width; ++x) {
            bool same = true;
            for (int neighbour = 0; neighbour < 9; ++neighbour)
                same = same && nodes[at(x + neighbour % 3 - 1, y + neighbour / 3 - 1)] == nodes[at(x, y)];
            interior[at(x, y)] = same;
        }
    return interior;
}

}  // namespace vrut::compare
