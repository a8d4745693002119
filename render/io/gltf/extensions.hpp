#pragma once

#include "io/conversion_warnings.hpp"
#include "io/gltf/json.hpp"

namespace vrut::io {

/// Tells of the extensions that a glTF file uses and that are not supported. Throws an ImportError if it
/// requires one that decides on more than looks.
void check_extensions(const GltfJson& document, ConversionWarnings& warnings);

}  // namespace vrut::io
