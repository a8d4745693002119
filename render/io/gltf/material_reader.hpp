#pragma once

#include <optional>

#include "io/conversion_warnings.hpp"
#include "io/gltf/geometry.hpp"
#include "io/gltf/json.hpp"
#include "io/scene_textures.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// A material of a glTF file, by the rule in reader.hpp.
struct ReadGltfMaterial {
    scene::Material material;            ///< without its textures
    std::optional<std::uint32_t> image;  ///< of its base colour
    std::optional<std::uint32_t> emissive_image, occlusion_roughness_metallic_image, normal_image;
    GltfTextureMapping mapping;    ///< how these lie on the surface
    TextureChange change;          ///< of the image of its base colour
    TextureChange surface_change;  ///< of its image for occlusion, roughness and metal
};

/// Converts a material; without an index, the one of primitives that have none. Throws ImportError.
ReadGltfMaterial read_gltf_material(const GltfJson& document, std::optional<std::uint32_t> index,
                                    ConversionWarnings& warnings);

}  // namespace vrut::io
