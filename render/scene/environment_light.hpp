#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "scene/image.hpp"

namespace vrut::scene {

/// What a cube map sends to surfaces that are not smooth: RGB, linear, 0 to 1.
struct EnvironmentLight {
    /// Coefficients of irradiance(): spherical harmonics up to the second order, which miss at most 9 % of
    /// what a matte surface receives (Ramamoorthi and Hanrahan 2001, "An Efficient Representation for
    /// Irradiance Environment Maps").
    std::array<glm::dvec3, 9> harmonics{};
    /// The light that a rough surface reflects, as its square roots, which are quickly undone: level k is
    /// that of roughness k / (kLevels - 1), in six squares of kSide / 2^k pixels, in the order and from the
    /// sides of the cube map. Mean of GGX around a direction seen from there (Karis 2013, "Real Shading in
    /// Unreal Engine 4").
    std::vector<std::array<Image, 6>> prefiltered;

    static constexpr int kSide = 128, kLevels = 6;
};

/// Of six squares of one size in the order px nx py ny pz nz, as displayed.
EnvironmentLight prefilter(const std::array<const Image*, 6>& cube_map);

/// Returns what a white, matte surface reflects whose unit normal this is; 0 to 1 where the surroundings are.
glm::dvec3 irradiance(const EnvironmentLight& light, const glm::dvec3& normal);

/// The part of the headlight that is left where a cube map lights surfaces.
inline constexpr double kHeadlightInEnvironment = 0.3;

}  // namespace vrut::scene
