#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "messages.hpp"

namespace vrut::server::scenes {

/// Where it is kept what clients have changed of a scene, which is named by LoadedScene::changes_key():
/// views, markers, measures, the unit and parts. In the state folder, the folder scenes. Empty where there is
/// no state folder.
std::filesystem::path changes_file(const std::string& scene);

/// Keeps a patch of the state, which leads from what the scene's file says to what stands now, whole or not
/// at all. An empty patch leaves no file. Throws std::runtime_error with a sentence. From any thread.
void store_changes(const std::string& scene, const std::string& patch);

/// Returns the patch that is kept, an empty text where none is, or why it cannot be read, in words that end a
/// sentence, which are logged. Files that were not read or written for 30 days are removed first. From any
/// thread.
tl::expected<std::string, std::string> stored_changes(const std::string& scene);

/// Gives the file in which a scene's changes are kept another name, with `date` in it, and 30 days from now,
/// if it cannot be read or holds the text `unusable`. Returns its new name, which no file had, or an empty
/// text if the file stays or there is none. Throws std::runtime_error with a sentence. From any thread.
std::string set_changes_aside(const std::string& scene, const std::string& unusable, std::string date);

/// Keeps the up axis that was chosen for a file of this hash. A fault is logged. From any thread.
void store_up_axis(const std::string& sha256, protocol::UpAxis axis);

/// Returns the axis that is kept, or none. A kept file that cannot be used is logged. From any thread.
std::optional<protocol::UpAxis> stored_up_axis(const std::string& sha256);

}  // namespace vrut::server::scenes
