#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "gl/handles.hpp"
#include "scene/image.hpp"

namespace vrut::gl {

/// What fills a level of a texture, or of one of a cube map's faces.
struct TextureImage {
    const scene::Image* image = nullptr;
    GLint level = 0;
    std::optional<GLint> face = {};
};

/// A texture in memory, with all its mip levels.
struct TextureData {
    std::vector<TextureImage> images;
    std::deque<scene::Image> made;  ///< of the images those that are not the scene's
};

/// An image and its mip levels, down from the first with no side longer than `largest`. No GL; the image must
/// live as long.
TextureData texture_data(const scene::Image& image, int largest);

/// A panorama of six squares of one size, px nx py ny pz nz, each what a camera with 90° at the world's
/// origin sees: px nx pz nz with +y up, py with +z up, ny with -z up. GL's cubes are left-handed: a world
/// direction (x, y, z) is looked up as (x, y, -z). Otherwise as texture_data().
TextureData cube_map_data(const std::array<const scene::Image*, 6>& images, int largest);

/// For such data, a texture or a cube map without contents. Throws OutOfMemory.
GlTexture make_texture_for(const TextureData& data);

}  // namespace vrut::gl
