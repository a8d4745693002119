#pragma once

#include <optional>

#include "io/conversion_warnings.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// Factors of a glTF material, linear.
struct GltfMaterial {
    glm::dvec3 base{1}, emission{0};
    double alpha = 1;
    bool blend = false;  ///< alphaMode BLEND, else OPAQUE
    double metallic = 0, roughness = 1;
    /// The specular factor of KHR_materials_pbrSpecularGlossiness, with 1 - roughness as its glossiness:
    /// where no metal has such a highlight.
    std::optional<glm::dvec3> specular;
};

/// Light that a display is sent this colour for, each from 0 to 1 (IEC 61966-2-1).
glm::dvec3 linear_from_srgb(const glm::dvec3& displayed);

/// The material that the reader's rule (assimp_scene.hpp) turns into this one, or the nearest to it; what
/// differs is told. Under a picture the base colour is white.
GltfMaterial gltf_material(const scene::Scene& scene, const scene::Material& material,
                           ConversionWarnings& warnings);

}  // namespace vrut::io
