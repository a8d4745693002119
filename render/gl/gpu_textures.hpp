#pragma once

#include <array>

#include "gl/handles.hpp"
#include "scene/image.hpp"

namespace vrut::gl {

/// An image with all its mip levels, repeated in both directions. One that is larger than the driver takes
/// starts at the first level that is not. Throws OutOfMemory.
GlTexture upload_texture(const scene::Image& image);

/// A panorama of six squares of one size, px nx py ny pz nz, each what a camera with 90° at the world's
/// origin sees: px nx pz nz with +y up, py with +z up, ny with -z up. GL's cubes are left-handed: a world
/// direction (x, y, z) is looked up as (x, y, -z). Throws as upload_texture().
GlTexture upload_cube_map(const std::array<const scene::Image*, 6>& images);

}  // namespace vrut::gl
