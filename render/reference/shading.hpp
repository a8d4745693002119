#pragma once

#include <array>
#include <glm/glm.hpp>

#include "reference/traced_scene.hpp"
#include "scene/environment_light.hpp"

namespace vrut::reference {

/// What a ray sees where it meets a triangle or a cap, relative to the eye, and how it changes from a pixel
/// to the next, to the right and upwards, on the triangle's plane.
struct SurfaceInteraction {
    glm::dvec3 point{0};
    glm::dvec3 normal{0, 0, 1};         ///< unit
    glm::dvec3 smooth_normal{0, 0, 1};  ///< unit: without a normal map
    /// Unit, across the smooth normal, the first in the direction of growing u and the second on the side of
    /// growing v; 0 where a triangle's texture coordinates leave no direction.
    std::array<glm::dvec3, 2> tangents{};
    double side = 1;  ///< -1 where the smooth normal was turned to the viewer
    glm::dvec2 texcoord{0};
    glm::dvec3 color{1};  ///< of the vertices; multiplies what is reflected of ambient and diffuse light
    std::array<glm::dvec3, 2> dn_dxy{};  ///< of the smooth normal
    std::array<glm::dvec2, 2> duv_dxy{};
};
/// A cap has its plane's normal, and neither texture coordinates nor colours.
SurfaceInteraction interaction_of(const TracedInstance& part, const TriangleHit& hit,
                                  const RayDifferential& ray);

/// The light's equations (Macků 2016, eq. 6.4 to 6.9), each component clamped to 0…1. `diffuse` stands for
/// the material's, `to_viewer` (unit) is the way back along the ray; `light` is in world space, and so is
/// `eye`, which the spot is relative to.
glm::dvec3 phong(const scene::Material& material, const glm::dvec3& diffuse, const scene::Light& light,
                 const glm::dvec3& eye, const SurfaceInteraction& interaction, const glm::dvec3& to_viewer);

/// The normal at an interaction where a normal map has these components, -1 to 1, along the tangents and the
/// smooth normal. Unit; the smooth one where there are no tangents.
glm::dvec3 mapped_normal(const SurfaceInteraction& interaction, const glm::dvec3& components);

/// A surface by metal and roughness at a point; colours are linear.
struct MetallicSurface {
    glm::dvec3 base{0};
    double metallic = 0, roughness = 1, clear_coat = 0;
    double occlusion = 1;  ///< of the surroundings' light
};

/// Linear light that the surroundings send: in the mean on a matte, white surface with the interaction's
/// normal, in the lobe around the reflected ray, and along the ray reflected at the smooth normal.
struct SurroundingLight {
    glm::dvec3 irradiance{0}, glossy{0}, sharp{0};
};

/// glTF 2.0, appendix B: Fresnel's reflectance by Schlick, GGX with Smith's height-correlated masking (Heitz
/// 2014) for the light. For the surroundings Karis's fit of its integral (2014, "Physically Based Shading on
/// Mobile"), and what is reflected more than once (Fdez-Agüera 2019, "A Multiple-Scattering Microfacet Model
/// for Real-Time Image-Based Lighting"). Above it a clear coat of 4 % and roughness 0.1, which mirrors the
/// surroundings. As displayed, each component clamped to 0…1.
glm::dvec3 metallic_roughness(const MetallicSurface& surface, const scene::Light& light,
                              const glm::dvec3& eye, const SurfaceInteraction& interaction,
                              const glm::dvec3& to_viewer, const SurroundingLight& surroundings);

}  // namespace vrut::reference
