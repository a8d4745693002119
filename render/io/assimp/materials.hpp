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

}  // namespace vrut::io
