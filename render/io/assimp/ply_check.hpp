#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace vrut::io {

/// Returns why assimp must not read this PLY file, since it trusts the header's counts and loops for ever
/// without `end_header`, and loses most of a triangle strip: a missing end, a duplicate element, more
/// elements than the file can hold, or strips. None if the header is valid or the file is not PLY.
std::optional<std::string> ply_error(const std::filesystem::path& path);

}  // namespace vrut::io
