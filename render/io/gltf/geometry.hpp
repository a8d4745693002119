#pragma once

#include <cstdint>
#include <string>
#include <tuple>

#include "io/conversion_warnings.hpp"
#include "io/gltf/buffers.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// How a texture lies on texture coordinates: which set it takes, and its KHR_texture_transform.
struct GltfTextureMapping {
    std::uint32_t set = 0;
    glm::dvec2 offset{0}, scale{1};
    double rotation = 0;  ///< radians

    bool is_identity() const { return offset == glm::dvec2(0) && scale == glm::dvec2(1) && rotation == 0; }
    auto key() const { return std::tuple(set, offset.x, offset.y, scale.x, scale.y, rotation); }
};

/// Returns true if a primitive consists of triangles; throws ImportError if its mode is invalid.
bool has_triangles(const GltfJson& primitive);

/// Reads the triangles of such a primitive. Texture coordinates are those of `mapping`, or the first where
/// the mesh lacks them; their v goes upwards. `name` is that of the mesh. Throws ImportError.
scene::Geometry read_gltf_geometry(const GltfJson& document, const GltfJson& primitive,
                                   const GltfTextureMapping& mapping, const std::string& name,
                                   GltfBuffers& buffers, ConversionWarnings& warnings);

}  // namespace vrut::io
