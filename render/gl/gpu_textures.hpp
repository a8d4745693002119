#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "gl/handles.hpp"
#include "scene/environment_light.hpp"
#include "scene/scene.hpp"

namespace vrut::gl {

/// The image of one mip level, of a texture or of one face of a cube map.
struct TextureImage {
    const scene::Image* image = nullptr;
    GLint level = 0;
    std::optional<GLint> face = {};
};

/// A texture in memory, with all its mip levels.
struct TextureData {
    std::vector<TextureImage> images;
    std::deque<scene::Image> made;  ///< owns the images that the scene does not own
    /// Drivers may round colours that lie between texels to 8 bits, which would bend normals.
    bool is_color = true;
    scene::Sampler sampler = {};
};

/// Returns an image and its mip levels, from the first one whose sides are at most `largest`. The image must
/// outlive the result. Calls no GL.
TextureData texture_data(const scene::Image& image, int largest);

/// Returns the same of an environment map: six squares of one size in the order px nx py ny pz nz. Each is
/// what a camera with a field of view of 90° at the world's origin sees: px nx pz nz with +y up, py with +z
/// up, ny with -z up. GL's cube maps are left-handed: (x, y, -z) looks up the world direction (x, y, z).
TextureData cube_map_data(const std::array<const scene::Image*, 6>& images, int largest);

/// Returns the same of what an environment map sends to rough surfaces.
TextureData prefiltered_data(const scene::EnvironmentLight& light);

/// Returns a texture or a cube map for such data, without contents. Throws OutOfMemory.
GlTexture make_texture_for(const TextureData& data);

}  // namespace vrut::gl
