#pragma once

#include <assimp/scene.h>

#include <glm/glm.hpp>
#include <optional>

#include "io/assimp/format.hpp"
#include "io/conversion_warnings.hpp"

namespace vrut::io {

/// Returns the rotation that makes y the up axis, if the file declares another one and assimp 5.2 does not
/// convert it, or if `z_up`; else identity.
glm::dmat4 upright_from_file(const aiScene& scene, AssimpFormat format, bool z_up,
                             ConversionWarnings& warnings);

/// Returns metres per unit of what assimp 5.2 has read: it scales Collada to metres. None where the file does
/// not declare them.
std::optional<double> metres_per_unit(const aiScene& scene, AssimpFormat format);

}  // namespace vrut::io
