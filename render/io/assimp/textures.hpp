#pragma once

#include <assimp/material.h>
#include <assimp/scene.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "io/conversion_warnings.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

bool has_texture(const aiMaterial& material, aiTextureType type);

/// The number of the texture coordinates, counted from 0, that the colour's texture lies on, or the normal
/// map where there is none.
unsigned texcoord_set_of(const aiMaterial& material);
/// Sets the name of the material's base colour or diffuse texture, if it has one: a file in `folder`, or `*`
/// and a number for a texture embedded in the scene's file.
void set_texture_name(const aiMaterial& from, const aiScene& scene, const std::filesystem::path& folder,
                      scene::Material& material, ConversionWarnings& warnings);
/// The same of its emissive texture, which multiplies the emission as light, or white where that is black.
void set_emissive_texture(const aiMaterial& from, const aiScene& scene, const std::filesystem::path& folder,
                          scene::Material& material, ConversionWarnings& warnings);
/// The same of its normal map.
void set_normal_texture(const aiMaterial& from, const aiScene& scene, const std::filesystem::path& folder,
                        scene::Material& material, ConversionWarnings& warnings);
inline constexpr const char* kIgnoredBumpMap = "a bump map is ignored";
void report_unsupported_textures(const aiMaterial& from, ConversionWarnings& warnings);

/// Returns true if red, green and blue differ by at most 8 of 255 at each pixel, as heights do and normals
/// don't.
bool is_grey(const scene::Image& image);

/// Returns true if the alpha of the material's texture has no effect.
bool ignores_alpha(const aiMaterial& material);

/// Decodes the embedded texture of that name, `*` and a number, and frees its bytes.
tl::expected<scene::Image, std::string> decode_embedded_texture(aiScene& scene, const std::string& name,
                                                                std::uint64_t max_pixels);

}  // namespace vrut::io
