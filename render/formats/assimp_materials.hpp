#pragma once

#include <assimp/scene.h>

#include <filesystem>
#include <vector>

#include "losses.hpp"
#include "scene.hpp"

namespace vrut {

/// The scene's picture of an assimp material, by the rule that assimp_scene.hpp tells. The image is named,
/// not read: a file in `folder`, or `*` and a number where it lies inside the scene's file.
Material convert_material(const aiMaterial& from, const std::filesystem::path& folder, Losses& losses);

/// From light to what a display is sent for it (IEC 61966-2-1), each from 0 to 1.
glm::dvec3 displayed_color(const aiColor3D& color);

/// Whether the alpha of the material's picture means nothing.
bool ignores_alpha(const aiMaterial& material);

/// Decodes the pictures inside the file that `materials` name into `textures`, and frees them.
void read_embedded_pictures(aiScene& scene, std::vector<Material>& materials, std::vector<Texture>& textures,
                            const std::string& file, std::vector<std::string>& notices);

/// Gives those of the materials that ignore alpha pictures without it.
void make_pictures_opaque(std::vector<Material>& materials, const std::vector<bool>& ignore_alpha,
                          std::vector<Texture>& textures);

}  // namespace vrut
