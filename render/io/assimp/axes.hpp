#pragma once

#include <assimp/scene.h>

#include <glm/glm.hpp>

#include "io/assimp/format.hpp"
#include "io/conversion_warnings.hpp"

namespace vrut::io {

/// Returns the rotation that makes y the up axis, if the file declares another one and assimp 5.2 does not
/// convert it, or if `z_up`; else identity.
glm::dmat4 upright_from_file(const aiScene& scene, AssimpFormat format, bool z_up,
                             ConversionWarnings& warnings);

/// Returns metres per unit, if the file declares them and assimp 5.2 has not scaled by them; else 1.
double metres_per_unit(const aiScene& scene, AssimpFormat format);

}  // namespace vrut::io
