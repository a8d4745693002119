#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/image.hpp"

namespace vrut::io {

/// The brightness of a photo studio for cars towards a unit direction, grey from 0 to 1 as displayed: a white
/// soft box overhead, softer strips of light along both sides (±x), a grey wall and a grey floor that run
/// into each other. Light of 1/π of its irradiance on a white surface is 0.75 on one that faces up, 0.4 on a
/// side and 0.2 on one that faces down.
double studio_brightness(const glm::dvec3& direction);

/// The studio as a cube map: px nx py ny pz nz, squares of one size.
std::array<scene::Image, 6> studio_cube_map();

}  // namespace vrut::io
