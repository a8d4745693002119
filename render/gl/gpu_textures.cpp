#include "gl/gpu_textures.hpp"

#include <algorithm>

#include "gl/mipmaps.hpp"

namespace vrut::gl {

namespace {

scene::Image upside_down(const scene::Image& image) {
    scene::Image result;
    result.resize(image.width, image.height);
    const auto row = static_cast<std::ptrdiff_t>(image.width) * 4;
    for (std::ptrdiff_t y = 0; y < image.height; ++y)
        std::copy_n(image.rgba.begin() + y * row, row, result.rgba.end() - (y + 1) * row);
    return result;
}

bool fits(const scene::Image& image, int largest) { return std::max(image.width, image.height) <= largest; }

}  // namespace

TextureData texture_data(const scene::Image& image, int largest) {
    TextureData data;
    if (fits(image, largest)) data.images.push_back({&image});
    for (scene::Image& level : mip_levels(image)) {
        if (!fits(level, largest)) continue;
        data.made.push_back(std::move(level));
        data.images.push_back({&data.made.back(), static_cast<GLint>(data.images.size())});
    }
    return data;
}

TextureData cube_map_data(const std::array<const scene::Image*, 6>& images, int largest) {
    constexpr std::array<GLint, 6> kFaces{0, 1, 2, 3, 5, 4};  // of px nx py ny pz nz
    TextureData data;
    for (std::size_t k = 0; k < 6; ++k) {
        const TextureData face = texture_data(*images[k], largest);
        for (const TextureImage& level : face.images) {
            data.made.push_back(upside_down(*level.image));  // GL has the top row of a face first
            data.images.push_back({&data.made.back(), level.level, kFaces[k]});
        }
    }
    return data;
}

GlTexture make_texture_for(const TextureData& data) {
    const bool is_cube_map = data.images.front().face.has_value();
    const scene::Image& largest = *data.images.front().image;
    return make_mipmapped_texture(is_cube_map ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D, largest.width,
                                  largest.height, data.images.back().level + 1);
}

}  // namespace vrut::gl
