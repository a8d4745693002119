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

/// `number` in the order px nx py ny pz nz.
void add_face(TextureData& data, const scene::Image& image, GLint level, std::size_t number) {
    constexpr std::array<GLint, 6> kFaces{0, 1, 2, 3, 5, 4};
    data.made.push_back(upside_down(image));  // GL has the top row of a face first
    data.images.push_back({&data.made.back(), level, kFaces[number]});
}

bool fits(const scene::Image& image, int largest) { return std::max(image.width, image.height) <= largest; }

GLint gl_wrap(scene::Wrap wrap) {
    return wrap == scene::Wrap::clamp    ? GL_CLAMP_TO_EDGE
           : wrap == scene::Wrap::mirror ? GL_MIRRORED_REPEAT
                                         : GL_REPEAT;
}

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
    TextureData data;
    for (std::size_t k = 0; k < 6; ++k) {
        const TextureData face = texture_data(*images[k], largest);
        for (const TextureImage& level : face.images) add_face(data, *level.image, level.level, k);
    }
    return data;
}

TextureData prefiltered_data(const scene::EnvironmentLight& light) {
    TextureData data;
    for (std::size_t level = 0; level < light.prefiltered.size(); ++level)
        for (std::size_t k = 0; k < 6; ++k)
            add_face(data, light.prefiltered[level][k], static_cast<GLint>(level), k);
    return data;
}

GlTexture make_texture_for(const TextureData& data) {
    const bool is_cube_map = data.images.front().face.has_value();
    const scene::Image& largest = *data.images.front().image;
    GlTexture texture = make_mipmapped_texture(is_cube_map ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D,
                                               data.is_color ? GL_RGBA8 : GL_RGBA16, largest.width,
                                               largest.height, data.images.back().level + 1);
    glTextureParameteri(texture.get(), GL_TEXTURE_WRAP_S, gl_wrap(data.sampler.wraps[0]));
    glTextureParameteri(texture.get(), GL_TEXTURE_WRAP_T, gl_wrap(data.sampler.wraps[1]));
    if (data.sampler.magnification == scene::Magnification::nearest)
        glTextureParameteri(texture.get(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

}  // namespace vrut::gl
