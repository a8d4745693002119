#pragma once

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

}  // namespace vrut::scene
