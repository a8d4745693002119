#pragma once

#include <optional>

#include "io/conversion_warnings.hpp"
#include "io/gltf/geometry.hpp"
#include "io/gltf/json.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// A material of a glTF file, by the rule in reader.hpp.
struct ReadGltfMaterial {
    scene::Material material;            ///< without its texture
    std::optional<std::uint32_t> image;  ///< of its base colour
    GltfTextureMapping mapping;          ///< how that lies on the surface
    bool ignores_alpha = true;           ///< the image's alpha has no effect
};

/// Converts a material; without an index, the one of primitives that have none. Throws ImportError.
ReadGltfMaterial read_gltf_material(const GltfJson& document, std::optional<std::uint32_t> index,
                                    ConversionWarnings& warnings);

/// Linear light to sRGB (IEC 61966-2-1), each channel from 0 to 1.
glm::dvec3 srgb_from_linear(const glm::dvec3& color);

}  // namespace vrut::io
