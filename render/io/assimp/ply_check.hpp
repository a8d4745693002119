#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace vrut::io {

/// Why assimp must not read a PLY file, which takes the counts in the header on trust and looks for ever for
/// the end of one that has none: that, a kind of element that comes twice, or more elements than the rest of
/// the file can hold. Nothing where the header is fine, or the file is no PLY at all.
std::optional<std::string> ply_error(const std::filesystem::path& path);

}  // namespace vrut::io
