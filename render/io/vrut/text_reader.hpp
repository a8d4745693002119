#pragma once

#include <string_view>

#include "io/read_scene.hpp"

namespace vrut::io {

/// Reads scene text, `vrut-text 1`. `file` names the text in errors ("FILE:LINE: expected …") and notices.
/// The sentence is about the first fault of the text. No word, number or string may be longer than
/// kMaxTokenBytes. Memory: at most 100 bytes for each of the text, that of nodes without content, and 20 MB;
/// of geometry hardly more than its arrays. Nodes of type assembly and geometry may have a hinge: `hinge X Y
/// Z DEGREES`, see Hinge. So many threads split the text into its tokens, 0: as many as there are, up to a
/// few; what is read, and what is refused in which sentence, depends on none of this.
PartsResult read_vrut_parts(std::string_view text, const std::string& file, const ReadProgress& progress = {},
                            unsigned threads = 0);

/// The same from a file, of which no more than some megabytes are held at a time, with the pictures that it
/// names.
PartsResult read_vrut_file(const std::filesystem::path& path, const ReadProgress& progress = {});

/// The same, as a scene without the pictures that it names.
ReadResult read_vrut_text(std::string_view text, const std::string& file, const ReadProgress& progress = {});

}  // namespace vrut::io
