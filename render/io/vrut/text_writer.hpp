#pragma once

#include <iosfwd>
#include <string>

#include "scene/scene.hpp"

namespace vrut::io {

/// Writes a scene in the format `vrut-text 1`. read_vrut_text() reads the same scene back: each number is
/// written in the fewest digits that round-trip. Images are named, not written; notices are left out. A line
/// break in a name becomes a space, since the format has none in strings. `comment` is put at the top, line
/// by line. `texture_files`, if not empty, holds file names by texture index, which are written instead of
/// those of the scene's textures.
void write_vrut_text(const scene::Scene& scene, std::ostream& out, const std::string& comment = {},
                     const std::vector<std::string>& texture_files = {});

}  // namespace vrut::io
