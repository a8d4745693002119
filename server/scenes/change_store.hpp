#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "messages.hpp"

namespace vrut::server::scenes {

/// Where it is kept what clients have changed of a scene, which is named by LoadedScene::changes_key():
/// views, markers and parts. In the state folder, the folder scenes. Empty where there is no state folder.
std::filesystem::path changes_file(const std::string& scene);

/// Keeps a patch of the state, which leads from what the scene's file says to what stands now, whole or not
/// at all. An empty patch leaves no file. Throws std::runtime_error with a sentence. From any thread.
void store_changes(const std::string& scene, const std::string& patch);

/// Returns the patch that is kept, or an empty text. Files that were not read or written for 30 days are
/// removed first. A file that cannot be used is logged. From any thread.
std::string stored_changes(const std::string& scene);

/// Keeps which axis was chosen for up in a file of this hash, which does not tell. A fault is logged. From
/// any thread.
void store_up_axis(const std::string& sha256, protocol::UpAxis axis);

/// Returns the axis that is kept; none: nobody has chosen one, or the file cannot be used, which is logged.
std::optional<protocol::UpAxis> stored_up_axis(const std::string& sha256);

}  // namespace vrut::server::scenes
