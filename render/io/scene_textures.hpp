#pragma once

#include <cstdint>
#include <filesystem>

#include "io/read_scene.hpp"

namespace vrut::io {

/// Pixels of all pictures of a scene together: 1 GiB.
inline constexpr std::uint64_t kMaxTexturePixels = std::uint64_t{1} << 28;

/// Whether some alpha is below 255.
bool has_transparent_pixel(const scene::Image& image);

/// Reads the pictures that the parts' materials and cube maps name, each file once, into their textures.
/// Names are relative to the folder of `scene_file`; what lies outside of it, after links are followed, is
/// not read. What cannot be read, or is no cube map of six squares of one size, is left out with a notice.
void read_textures(scene::SceneParts& parts, const std::filesystem::path& scene_file,
                   const ReadProgress& progress = {}, std::uint64_t max_pixels = kMaxTexturePixels);

}  // namespace vrut::io
