#pragma once

#include <filesystem>

#include "scene/scene.hpp"

namespace vrut::io {

/// Returns true if an OBJ, STL or PLY file very likely has z for up, though it was read with y for up: a
/// comment or the program that wrote it tells so, its wheels stand on a plane of one z, or all of it stands
/// on z = 0, in the middle of x and y.
bool seems_z_up(const scene::SceneParts& parts, const std::filesystem::path& path);

}  // namespace vrut::io
