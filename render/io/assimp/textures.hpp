#pragma once

#include <assimp/material.h>
#include <assimp/scene.h>

#include <filesystem>
#include <string>
#include <vector>

#include "io/assimp/format.hpp"
#include "io/conversion_warnings.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

bool has_texture(const aiMaterial& material, aiTextureType type);

/// The number of the texture coordinates, counted from 0, that the colour's texture lies on.
unsigned texcoord_set_of(const aiMaterial& material);
/// Sets the name of the material's base colour or diffuse texture, if it has one: a file in `folder`, or `*`
/// and a number for a texture embedded in the scene's file.
void set_texture_name(const aiMaterial& from, const aiScene& scene, const std::filesystem::path& folder,
                      AssimpFormat format, scene::Material& material, ConversionWarnings& warnings);
void report_unsupported_textures(const aiMaterial& from, ConversionWarnings& warnings);

/// Returns glTF's alphaMode.
std::string alpha_mode(const aiMaterial& material);
/// Returns true if the alpha of the material's texture has no effect.
bool ignores_alpha(const aiMaterial& material, AssimpFormat format);

/// Decodes the embedded textures that `materials` name into `textures`, and frees their bytes.
void decode_embedded_textures(aiScene& scene, std::vector<scene::Material>& materials,
                              std::vector<scene::Texture>& textures, const std::string& file,
                              std::vector<std::string>& notices);

/// Gives opaque copies of their textures to the materials that ignore alpha.
void make_textures_opaque(std::vector<scene::Material>& materials, const std::vector<bool>& ignore_alpha,
                          std::vector<scene::Texture>& textures);

}  // namespace vrut::io
