#pragma once

#include <cstdint>
#include <optional>

#include "io/conversion_warnings.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// How a reflectance of 4 %, what most surfaces reflect, displays.
inline constexpr double kGltfDielectric = 0.22;

/// A sampler's modes beyond the edges of an image, those of OpenGL.
inline constexpr std::uint64_t kGltfRepeat = 10497, kGltfMirror = 33648, kGltfClamp = 33071;
/// How it magnifies.
inline constexpr std::uint64_t kGltfNearest = 9728, kGltfLinear = 9729;

/// The factors of a glTF material; colours are linear, 0 to 1.
struct GltfMaterial {
    glm::dvec3 base{1}, emissive{0};
    double emissive_strength = 1;  ///< multiplies `emissive`; at least 1
    double alpha = 1;
    bool blend = false;  ///< alphaMode BLEND, else OPAQUE
    double metallic = 0, roughness = 1;
    double clear_coat = 0;  ///< the clearcoatFactor of KHR_materials_clearcoat
    /// KHR_materials_pbrSpecularGlossiness. Set if the highlight by Phong's equation is not the one that the
    /// reader gives to that metal and roughness.
    struct Glossiness {
        glm::dvec3 specular{0};
        double glossiness = 0;
    };
    std::optional<Glossiness> glossiness;
};

/// Returns a material by metal and roughness as it is. Of Phong's, returns the glTF material that the
/// reader's rule (reader.hpp) turns into `material`, or the nearest one; what differs is added to `warnings`.
/// With a texture the base colour factor is white.
GltfMaterial gltf_material(const scene::Scene& scene, const scene::Material& material,
                           ConversionWarnings& warnings);

}  // namespace vrut::io
