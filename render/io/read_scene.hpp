#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace vrut::io {

/// A scene, or one sentence that names the file, where it can the line, and what was expected.
using ReadResult = tl::expected<scene::Scene, std::string>;

/// Called now and then with the fraction that has been read, 0 to 1.
using ReadProgress = std::function<void(double)>;

/// Whether a scene is shown in a studio (add_studio()). Automatic: if its format is not scene text, and it
/// has no light of its own.
enum class Studio { automatic, on, off };

/// What files do not tell of themselves.
struct ReadOptions {
    std::vector<std::filesystem::path> texture_folders{};  ///< where else textures lie, see read_textures()
    bool z_up = false;                                     ///< z is up in OBJ, STL and PLY, not y
    Studio studio = Studio::off;
};

/// What the reader of a format hands over, or the same kind of sentence.
using PartsResult = tl::expected<scene::SceneParts, std::string>;

/// Scene::build with its error as a reader's, of the scene in `file`.
ReadResult build_scene(scene::SceneParts parts, const std::string& file);

/// The file's ending with its dot, a to z in lower case.
std::string lower_extension(const std::filesystem::path& path);

/// Returns true if the file's ending is that of a known format.
bool has_reader(const std::filesystem::path& path);
/// The endings of the known formats: ".vrut, …".
std::string read_extensions();

/// Returns true if the format of this ending does not define which axis is up.
bool lacks_up_axis(const std::filesystem::path& path);

/// Returns true if a foreign library reads this ending: one that may crash, or take whatever memory there is.
bool has_foreign_reader(const std::filesystem::path& path);

/// What read_scene() reads, before Scene::build, with its studio.
PartsResult read_scene_parts(const std::filesystem::path& path, const ReadProgress& progress = {},
                             const ReadOptions& options = {});

/// Reads a scene file in any known format, chosen by the file's ending, and the images that it names
/// (read_textures()).
ReadResult read_scene(const std::filesystem::path& path, const ReadProgress& progress = {},
                      const ReadOptions& options = {});

}  // namespace vrut::io
