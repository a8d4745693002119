#pragma once

#include <string_view>

#include "io/read_scene.hpp"

namespace vrut::io {

/// Returns the scene of a text in the format `vrut-text 1`, or a sentence about the text's first error:
/// "FILE:LINE: expected …". `file` is the name in errors and notices. A word, number or string longer than
/// kMaxTokenBytes is an error. Nodes of type assembly and geometry may have a hinge: `hinge X Y Z DEGREES`,
/// see Hinge, and be marked as presentation: `presentation 1`, see Node. A camera may have `look RADIUS`, see
/// CameraData. `threads` threads tokenize the text;
/// 0 uses all of the processor's, up to a few. The result does not depend on their number. Memory: at most
/// 100 bytes for each byte of text, which empty nodes need, and 20 MB. Geometry needs hardly more than its
/// arrays.
PartsResult read_vrut_parts(std::string_view text, const std::string& file, const ReadProgress& progress = {},
                            unsigned threads = 0);

/// Returns the same of a file, with the images that it names. No more than a few megabytes of the text are in
/// memory at a time.
PartsResult read_vrut_file(const std::filesystem::path& path, const ReadProgress& progress = {},
                           const ReadOptions& options = {});

/// Returns the same as a built scene, without the images that the text names.
ReadResult read_vrut_text(std::string_view text, const std::string& file, const ReadProgress& progress = {});

}  // namespace vrut::io
