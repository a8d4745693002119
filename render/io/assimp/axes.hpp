#pragma once

#include <assimp/scene.h>

#include <glm/glm.hpp>

#include "io/assimp/format.hpp"
#include "io/conversion_warnings.hpp"

namespace vrut::io {

/// Turns the file's axes so that y is up, where it says that another is and assimp 5.2 leaves them as they
/// are.
glm::dmat4 upright_from_file(const aiScene& scene, AssimpFormat format, ConversionWarnings& warnings);

/// Metres per unit, where the file tells and assimp 5.2 has not scaled by it; else 1.
double metres_per_unit(const aiScene& scene, AssimpFormat format);

}  // namespace vrut::io
