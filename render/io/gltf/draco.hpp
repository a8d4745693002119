#pragma once

#include <map>
#include <string>

#include "io/gltf/accessor.hpp"

namespace vrut::io {

/// A primitive's arrays out of KHR_draco_mesh_compression.
struct DracoPrimitive {
    std::map<std::string, GltfArray> attributes;  ///< of those asked for that are compressed
    GltfArray indices;                            ///< three for each triangle
};

/// Decompresses the attributes of a primitive that `names` names, each as its accessor describes it. Throws
/// ImportError.
DracoPrimitive read_draco_primitive(const GltfJson& document, const GltfJson& primitive,
                                    const std::vector<std::string>& names, GltfBuffers& buffers);

}  // namespace vrut::io
