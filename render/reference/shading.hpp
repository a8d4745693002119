#pragma once

#include <array>
#include <glm/glm.hpp>

#include "reference/traced_scene.hpp"

namespace vrut::reference {

/// What a ray sees where it meets a triangle, relative to the eye, and how it changes from a pixel to the
/// next, to the right and upwards, on the triangle's plane.
struct SurfaceInteraction {
    glm::dvec3 point{0};
    glm::dvec3 normal{0, 0, 1};  ///< unit
    glm::dvec2 texcoord{0};
    glm::dvec3 color{1};  ///< of the vertices; multiplies what is reflected of ambient and diffuse light
    std::array<glm::dvec3, 2> dn_dxy{};
    std::array<glm::dvec2, 2> duv_dxy{};
};
SurfaceInteraction interaction_of(const TracedInstance& part, const TriangleHit& hit,
                                  const RayDifferential& ray);

/// The light's equations (Macků 2016, eq. 6.4 to 6.9), each component clamped to 0…1. `diffuse` stands for
/// the material's, `to_viewer` (unit) is the way back along the ray; `light` is in world space, and so is
/// `eye`, which the spot is relative to.
glm::dvec3 phong(const scene::Material& material, const glm::dvec3& diffuse, const scene::Light& light,
                 const glm::dvec3& eye, const SurfaceInteraction& interaction, const glm::dvec3& to_viewer);

}  // namespace vrut::reference
