#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/output_files.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// A PNG: RGB, or RGBA `with_alpha`. Throws std::runtime_error.
std::vector<std::uint8_t> encode_png(const scene::Image& image, bool with_alpha = false);

/// Writes the scene's textures as PNG files in the folder STEM.textures beside the scene's file, and gives
/// their names, relative to it, by their index. Throws WriteError.
std::vector<std::string> write_textures(const scene::Scene& scene, const std::filesystem::path& scene_file,
                                        base::OutputFiles& files);

}  // namespace vrut::io
