#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "io/read_scene.hpp"

namespace vrut::io {

/// The largest number of pixels of all textures of a scene: 1 GiB.
inline constexpr std::uint64_t kMaxTexturePixels = std::uint64_t{1} << 28;

/// Returns true if a pixel's alpha is below 255.
bool has_transparent_pixel(const scene::Image& image);

/// Reads the image files that the parts' materials and cube maps name into textures, each file once. Names
/// are relative to the folder of `scene_file`. A file that is not there is looked for in `folders`, by its
/// name without folders. A file outside of all these (symbolic links resolved), an unreadable one, and a cube
/// map without six squares of one size are omitted with a notice.
void read_textures(scene::SceneParts& parts, const std::filesystem::path& scene_file,
                   const ReadProgress& progress = {}, const std::vector<std::filesystem::path>& folders = {},
                   std::uint64_t max_pixels = kMaxTexturePixels);

/// Decodes an image that lies inside the scene's file, by its name, of at most so many pixels.
using EmbeddedDecoder =
    std::function<tl::expected<scene::Image, std::string>(const std::string& name, std::uint64_t max_pixels)>;

/// Decodes the images of materials whose names begin with `*`, each once, and empties these names. One that
/// cannot be decoded is omitted with a notice.
void decode_embedded_textures(scene::SceneParts& parts, const std::filesystem::path& scene_file,
                              const EmbeddedDecoder& decode);

/// Gives each texture the sampler of the materials that see it. Where they differ, each has a copy. Returns
/// false if all textures would have more than `max_pixels`: then some have another sampler than their
/// materials.
bool set_samplers(scene::SceneParts& parts, std::uint64_t max_pixels = kMaxTexturePixels);

/// How a material sees the image of its texture.
struct TextureChange {
    bool opaque = false;   ///< without its alpha
    glm::dvec3 factor{1};  ///< by which its colours are multiplied as light, 0 to 1
    // Of an image for occlusion, roughness and metal:
    double occlusion = 1;            ///< how much of its red counts; 0: as if it were 1
    bool roughness_metallic = true;  ///< false: its green and blue are as if they were 1
};

/// Changes the texture of each material as told by the element of `changes` at the same index. Materials that
/// see one texture differently get copies of it. Returns false if all textures would have more than
/// `max_pixels`: then some materials see theirs unchanged.
bool change_textures(std::vector<scene::Material>& materials, const std::vector<TextureChange>& changes,
                     std::vector<scene::Texture>& textures,
                     scene::Index scene::Material::*texture = &scene::Material::texture,
                     std::uint64_t max_pixels = kMaxTexturePixels);
inline constexpr const char* kUnchangedTextures =
    "some textures are drawn without the colour, opacity or wrapping of their materials: there is no room "
    "for "
    "copies";

}  // namespace vrut::io
