#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/gltf/json.hpp"

namespace vrut::io {

/// The size of the data that an EXT_meshopt_compression object describes, in bytes. Throws ImportError where
/// its count or stride is invalid.
std::uint64_t decompressed_size(const GltfJson& compression);

/// Returns the decompressed data. Indices in it may be out of range. Throws ImportError.
std::string decompress_meshopt(const GltfJson& compression, std::string_view bytes);

}  // namespace vrut::io
