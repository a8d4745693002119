#pragma once

#include <assimp/scene.h>

#include <filesystem>

#include "io/assimp/format.hpp"
#include "io/conversion_warnings.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// The scene's picture of an assimp material, by the rules that assimp_scene.hpp tells. The image is named,
/// not read: set_texture_name().
scene::Material convert_material(const aiMaterial& from, const aiScene& scene,
                                 const std::filesystem::path& folder, AssimpFormat format,
                                 ConversionWarnings& warnings);

/// From light to what a display is sent for it (IEC 61966-2-1), each from 0 to 1.
glm::dvec3 srgb_from_linear(const aiColor3D& color);

}  // namespace vrut::io
