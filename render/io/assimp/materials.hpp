#pragma once

#include <assimp/scene.h>

#include <filesystem>

#include "io/assimp/format.hpp"
#include "io/conversion_warnings.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// Converts an assimp material by the rules in assimp/scene.hpp. Only names the texture: set_texture_name().
scene::Material convert_material(const aiMaterial& from, const aiScene& scene,
                                 const std::filesystem::path& folder, AssimpFormat format,
                                 ConversionWarnings& warnings);

/// Linear light to sRGB (IEC 61966-2-1), each channel from 0 to 1.
glm::dvec3 srgb_from_linear(const aiColor3D& color);

}  // namespace vrut::io
