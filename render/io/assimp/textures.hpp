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

/// Gives a material the name of its colour's picture, where it has one: a file in `folder`, or `*` and a
/// number where it lies inside the scene's file.
void set_texture_name(const aiMaterial& from, const aiScene& scene, const std::filesystem::path& folder,
                      AssimpFormat format, scene::Material& material, ConversionWarnings& warnings);
void report_unsupported_textures(const aiMaterial& from, ConversionWarnings& warnings);

/// Of glTF.
std::string alpha_mode(const aiMaterial& material);
/// Whether the alpha of the material's picture means nothing.
bool ignores_alpha(const aiMaterial& material, AssimpFormat format);

/// Decodes the pictures inside the file that `materials` name into `textures`, and frees them.
void decode_embedded_textures(aiScene& scene, std::vector<scene::Material>& materials,
                              std::vector<scene::Texture>& textures, const std::string& file,
                              std::vector<std::string>& notices);

/// Gives those of the materials that ignore alpha pictures without it.
void make_textures_opaque(std::vector<scene::Material>& materials, const std::vector<bool>& ignore_alpha,
                          std::vector<scene::Texture>& textures);

}  // namespace vrut::io
