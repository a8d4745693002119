#pragma once

#include <iosfwd>
#include <string>

#include "scene/scene.hpp"

namespace vrut::io {

/// Writes a scene as text, `vrut-text 1`, from which read_vrut_text() makes the same scene: every number in
/// the fewest digits that give it back. Pictures stay files of their own, and notices are left out. A line
/// break in a name, which the text cannot hold and no reading of it gives, becomes a space. `comment`, when
/// given, is put at the top, line by line; `pictures`, when given, are named instead of the scene's textures,
/// by their index.
void write_vrut_text(const scene::Scene& scene, std::ostream& out, const std::string& comment = {},
                     const std::vector<std::string>& pictures = {});

}  // namespace vrut::io
