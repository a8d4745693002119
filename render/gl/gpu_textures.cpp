#include "gl/gpu_textures.hpp"

#include <algorithm>

#include "gl/mipmaps.hpp"

namespace vrut::gl {

namespace {

/// An image and the levels below it, from the first that is no larger than `limit` names.
class MipChain {
public:
    MipChain(const scene::Image& image, GLenum limit) : image_(image), below_(mip_levels(image)) {
        GLint largest = 0;
        glGetIntegerv(limit, &largest);
        while (std::max(at(0).width, at(0).height) > largest) ++first_;
    }
    int count() const { return static_cast<int>(below_.size() - first_) + 1; }
    const scene::Image& at(int level) const {
        const std::size_t i = first_ + static_cast<std::size_t>(level);
        return i == 0 ? image_ : below_[i - 1];
    }

private:
    const scene::Image& image_;
    std::vector<scene::Image> below_;
    std::size_t first_ = 0;
};

scene::Image upside_down(const scene::Image& image) {
    scene::Image result;
    result.resize(image.width, image.height);
    const auto row = static_cast<std::ptrdiff_t>(image.width) * 4;
    for (std::ptrdiff_t y = 0; y < image.height; ++y)
        std::copy_n(image.rgba.begin() + y * row, row, result.rgba.end() - (y + 1) * row);
    return result;
}

}  // namespace

GlTexture upload_texture(const scene::Image& image) {
    const MipChain levels(image, GL_MAX_TEXTURE_SIZE);
    GlTexture texture =
        make_mipmapped_texture(GL_TEXTURE_2D, levels.at(0).width, levels.at(0).height, levels.count());
    for (int i = 0; i < levels.count(); ++i) {
        const scene::Image& level = levels.at(i);
        glTextureSubImage2D(texture.get(), i, 0, 0, level.width, level.height, GL_RGBA, GL_UNSIGNED_BYTE,
                            level.rgba.data());
    }
    return texture;
}

GlTexture upload_cube_map(const std::array<const scene::Image*, 6>& images) {
    constexpr std::array<int, 6> kFaces{0, 1, 2, 3, 5, 4};  // of px nx py ny pz nz
    GlTexture texture;
    for (std::size_t face = 0; face < 6; ++face) {
        const MipChain levels(*images[face], GL_MAX_CUBE_MAP_TEXTURE_SIZE);
        if (!texture)
            texture = make_mipmapped_texture(GL_TEXTURE_CUBE_MAP, levels.at(0).width, levels.at(0).height,
                                             levels.count());
        for (int i = 0; i < levels.count(); ++i) {
            const scene::Image level = upside_down(levels.at(i));  // GL has the top row of a face first
            glTextureSubImage3D(texture.get(), i, 0, 0, kFaces[face], level.width, level.height, 1, GL_RGBA,
                                GL_UNSIGNED_BYTE, level.rgba.data());
        }
    }
    return texture;
}

}  // namespace vrut::gl
