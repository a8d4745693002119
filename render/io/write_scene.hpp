#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace vrut::io {

/// Called now and then with the fraction that has been written, 0 to 1.
using WriteProgress = std::function<void(double)>;

/// What of the scene the file does not hold, each in one sentence with the file's name; or one sentence why
/// nothing was written.
using WriteResult = tl::expected<std::vector<std::string>, std::string>;

/// Returns true if the file's ending is that of a format that can be written.
bool has_writer(const std::filesystem::path& path);
/// These endings: ".vrut, …".
std::string written_extensions();

/// Writes a scene in the format that the file's ending names, and its images: inside a GLB file, elsewhere
/// as PNG files in the folder STEM.textures beside it. Files get their names when all are whole: a failure
/// leaves what was there before; so does one of `kept` in the place of a file, such as what the scene is read
/// from.
WriteResult write_scene(const scene::Scene& scene, const std::filesystem::path& path,
                        const WriteProgress& progress = {},
                        std::vector<std::filesystem::path> protected_files = {});

}  // namespace vrut::io
