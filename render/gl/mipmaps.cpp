#include "gl/mipmaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace vrut::gl {

namespace {

/// A level before it is rounded, each channel 0 to 255.
struct FloatMipLevel {
    int width = 0, height = 0;
    std::vector<glm::vec4> texels;
};

/// What a new texel covers of a row (or column) of old ones: their shares add up to 1.
struct TexelFootprint {
    int first = 0, count = 0;
    std::array<float, 4> shares{};
};

int half_of(int size) { return std::max(size / 2, 1); }

std::vector<TexelFootprint> footprints(int old_size) {
    const int size = half_of(old_size);
    std::vector<TexelFootprint> result;
    result.reserve(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) {
        // In units of an old texel's `size`-th part, so that all but the shares are whole numbers.
        const auto begin = std::int64_t{i} * old_size, end = begin + old_size;
        TexelFootprint footprint{static_cast<int>(begin / size), 0, {}};
        for (std::int64_t k = footprint.first; k * size < end; ++k, ++footprint.count) {
            const auto length = std::min((k + 1) * size, end) - std::max(k * size, begin);
            footprint.shares[static_cast<std::size_t>(footprint.count)] =
                static_cast<float>(static_cast<double>(length) / old_size);
        }
        result.push_back(footprint);
    }
    return result;
}

/// `texel(i)` counts along the rows from the bottom up.
template <typename Texel>
FloatMipLevel half(int width, int height, const Texel& texel) {
    const std::vector<TexelFootprint> columns = footprints(width), rows = footprints(height);
    FloatMipLevel result{half_of(width), half_of(height), {}};
    result.texels.reserve(columns.size() * rows.size());
    std::vector<glm::vec4> line(static_cast<std::size_t>(width));
    for (const TexelFootprint& row : rows) {
        std::fill(line.begin(), line.end(), glm::vec4(0));
        for (int k = 0; k < row.count; ++k) {
            const std::size_t start =
                (static_cast<std::size_t>(row.first) + static_cast<std::size_t>(k)) * line.size();
            for (std::size_t x = 0; x < line.size(); ++x)
                line[x] += row.shares[static_cast<std::size_t>(k)] * texel(start + x);
        }
        for (const TexelFootprint& column : columns) {
            glm::vec4 sum(0);
            for (int k = 0; k < column.count; ++k)
                sum += column.shares[static_cast<std::size_t>(k)] *
                       line[static_cast<std::size_t>(column.first) + static_cast<std::size_t>(k)];
            result.texels.push_back(sum);
        }
    }
    return result;
}

scene::Image rounded(const FloatMipLevel& level) {
    scene::Image image;
    image.resize(level.width, level.height);
    for (std::size_t i = 0; i < level.texels.size(); ++i)
        for (int channel = 0; channel < 4; ++channel)
            image.rgba[4 * i + static_cast<std::size_t>(channel)] =
                static_cast<std::uint8_t>(std::floor(level.texels[i][channel] + 0.5F));
    return image;
}

}  // namespace

std::vector<scene::Image> mip_levels(const scene::Image& image) {
    std::vector<scene::Image> levels;
    if (image.width <= 1 && image.height <= 1) return levels;
    FloatMipLevel level = half(image.width, image.height, [&](std::size_t i) {
        const std::uint8_t* bytes = image.rgba.data() + 4 * i;
        return glm::vec4(bytes[0], bytes[1], bytes[2], bytes[3]);
    });
    levels.push_back(rounded(level));
    while (level.width > 1 || level.height > 1) {
        level = half(level.width, level.height, [&](std::size_t i) { return level.texels[i]; });
        levels.push_back(rounded(level));
    }
    return levels;
}

}  // namespace vrut::gl
