#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vrut::scene {

/// 8-bit RGBA in OpenGL's order: rows from the bottom up.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;

    void resize(int new_width, int new_height) {
        width = new_width;
        height = new_height;
        rgba.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    }
};

/// 8-bit Y'CbCr by JFIF (ITU-T T.871), in the layout that a JPEG encoder takes: rows from the top down, each
/// padded to whole MCUs with its last pixel.
struct PlanarImage {
    int width = 0, height = 0;
    bool subsampled = false;  ///< 4:2:0, else 4:4:4
    /// rows() rows of stride() bytes. First those of Y. Then in 4:4:4 the rows of Cb, and those of Cr; in
    /// 4:2:0 rows that hold one of Cb in their left half and one of Cr in their right half.
    std::vector<std::uint8_t> bytes;

    int mcu_side() const { return subsampled ? 16 : 8; }  ///< in pixels
    int stride() const { return (width + mcu_side() - 1) / mcu_side() * mcu_side(); }
    /// Rows of Y: an even number in 4:2:0, the last one twice if need be.
    int luma_rows() const { return subsampled ? height + height % 2 : height; }
    int rows() const { return subsampled ? luma_rows() / 2 * 3 : luma_rows() * 3; }

    void resize(int new_width, int new_height, bool new_subsampled) {
        width = new_width;
        height = new_height;
        subsampled = new_subsampled;
        bytes.resize(static_cast<std::size_t>(stride()) * static_cast<std::size_t>(rows()));
    }
};

}  // namespace vrut::scene
