#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "level_table.hpp"

namespace vrut::server::scenes {

/// Where the levels of a scene on a machine are kept, once they are measured: in the state folder, the folder
/// levels. Empty where there is no state folder.
std::filesystem::path levels_file(const std::string& scene_sha256, const std::string& renderer);

/// Writes the file of the table's scene and renderer, whole or not at all, and returns it. Throws
/// std::runtime_error, also for a table that could not be read again.
std::filesystem::path store_levels(const protocol::LevelTable& table);

/// None where none are kept; of a file that cannot be used the log says why.
std::optional<protocol::LevelTable> stored_levels(const std::string& scene_sha256,
                                                  const std::string& renderer);

/// What holds where nothing was measured: levels of the car, drawn by the processor.
const protocol::LevelTable& built_in_levels();

/// Those that are kept, else the built-in ones; these with their errors for the car only.
protocol::LevelTable levels_of(const std::string& scene_sha256, const std::string& renderer);

}  // namespace vrut::server::scenes
