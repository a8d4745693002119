#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/output_files.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// Encodes a PNG: RGB, or RGBA if `with_alpha`. Throws std::runtime_error.
std::vector<std::uint8_t> encode_png(const scene::Image& image, bool with_alpha = false);

/// Writes the scene's textures as PNG files into the folder STEM.textures beside the scene's file. Returns
/// their names relative to the scene's file, by texture index. Throws WriteError.
std::vector<std::string> write_textures(const scene::Scene& scene, const std::filesystem::path& scene_file,
                                        base::OutputFiles& files);

}  // namespace vrut::io
