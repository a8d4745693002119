#include <doctest/doctest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/srgb.hpp"
#include "math/cube_faces.hpp"
#include "noise.hpp"
#include "reference/shading.hpp"
#include "scene/environment_light.hpp"

using namespace vrut;

namespace {

constexpr double kPi = glm::pi<double>();

std::array<scene::Image, 6> cube_of(int side, const auto& displayed) {
    std::array<scene::Image, 6> images;
    for (std::size_t face = 0; face < 6; ++face) {
        images[face].resize(side, side);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const glm::dvec2 uv = (glm::dvec2(x, y) + 0.5) / static_cast<double>(side);
                const glm::dvec3 direction = glm::normalize(math::direction_at(math::kCubeFaces[face], uv));
                auto* rgba = &images[face].rgba[4 * static_cast<std::size_t>(y * side + x)];
                std::fill(rgba, rgba + 3, static_cast<std::uint8_t>(std::lround(255 * displayed(direction))));
                rgba[3] = 255;
            }
    }
    return images;
}

scene::EnvironmentLight light_of(const std::array<scene::Image, 6>& images) {
    return scene::prefilter({&images[0], &images[1], &images[2], &images[3], &images[4], &images[5]});
}

/// The mean of GGX around a unit direction, seen from there, by a fine grid instead of samples.
double mean_of_lobe(double roughness, const glm::dvec3& around, const auto& light) {
    constexpr int kRings = 200, kSectors = 400;
    const double squared = std::pow(roughness, 4);
    const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0.3, 0.5, 0.8), around));
    const glm::dvec3 y = glm::cross(around, x);
    double sum = 0, weights = 0;
    for (int i = 0; i < kRings; ++i) {
        const double theta = (i + 0.5) / kRings * kPi / 2, half = theta / 2;
        const double spread = std::pow(std::cos(half), 2) * (squared - 1) + 1;
        // D / 4 is the density of directions, cos θ their weight, sin θ the width of the ring.
        const double weight = squared / (spread * spread) * std::cos(theta) * std::sin(theta);
        for (int k = 0; k < kSectors; ++k) {
            const double phi = 2 * kPi * (k + 0.5) / kSectors;
            sum += weight * light(std::cos(theta) * around +
                                  std::sin(theta) * (std::cos(phi) * x + std::sin(phi) * y));
            weights += weight;
        }
    }
    return sum / weights;
}

constexpr glm::dvec3 kAhead{0, 0, 1};

/// Seen from ahead.
reference::SurfaceInteraction facing() {
    reference::SurfaceInteraction interaction;
    interaction.point = {0, 0, -5};
    return interaction;
}

scene::Light dark() {
    scene::Light light;
    light.color = glm::dvec4(0);
    return light;
}

/// In linear light.
glm::dvec3 lit(const reference::MetallicSurface& surface, const scene::Light& light,
               const reference::SurroundingLight& surroundings, const glm::dvec3& to_viewer = kAhead) {
    return base::linear_from_srgb(
        reference::metallic_roughness(surface, light, glm::dvec3(0), facing(), to_viewer, surroundings));
}

}  // namespace

TEST_CASE("surroundings of one light are that light, on matte surfaces and on rough ones") {
    const scene::EnvironmentLight light = light_of(cube_of(3, [](const glm::dvec3&) { return 0.6; }));
    const double linear = base::linear_from_srgb(std::round(0.6 * 255) / 255);
    for (const glm::dvec3& normal : {glm::dvec3(0, 1, 0), glm::normalize(glm::dvec3(1, -2, 3))})
        CHECK(glm::distance(scene::irradiance(light, normal), glm::dvec3(linear)) < 2e-3);
    REQUIRE(light.prefiltered.size() == scene::EnvironmentLight::kLevels);
    for (std::size_t level = 0; level < light.prefiltered.size(); ++level)
        for (const scene::Image& face : light.prefiltered[level]) {
            REQUIRE(face.width == scene::EnvironmentLight::kSide >> level);
            for (std::size_t i = 0; i < face.rgba.size(); ++i)
                REQUIRE(face.rgba[i] == (i % 4 == 3 ? 255 : std::lround(255 * std::sqrt(linear))));
        }
}

TEST_CASE("a matte surface receives of surroundings what the integral over them says") {
    // Of light a + b y, whose cosine-weighted mean around n is a + 2/3 b n.y, the harmonics keep all.
    const auto displayed = [](const glm::dvec3& d) { return base::srgb_from_linear(0.5 + 0.4 * d.y); };
    const scene::EnvironmentLight light = light_of(cube_of(64, displayed));
    for (const glm::dvec3& normal : {glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0), glm::dvec3(1, 0, 0),
                                     glm::normalize(glm::dvec3(1, 2, -2))})
        CHECK(scene::irradiance(light, normal).g ==
              doctest::Approx(0.5 + 0.4 * 2 / 3 * normal.y).epsilon(2e-3));
    // Half of the sphere alight: what is beyond the second order is missed.
    const scene::EnvironmentLight sky =
        light_of(cube_of(64, [](const glm::dvec3& d) { return d.y > 0 ? 1.0 : 0.0; }));
    CHECK(std::abs(scene::irradiance(sky, {0, 1, 0}).g - 1) < 0.09);
    CHECK(std::abs(scene::irradiance(sky, {1, 0, 0}).g - 0.5) < 0.01);
    CHECK(scene::irradiance(sky, {0, -1, 0}).g < 0.09);
}

TEST_CASE("a rough surface reflects the mean of its lobe") {
    const auto linear = [](const glm::dvec3& d) {
        return 0.45 + 0.4 * std::sin(3 * d.x) * std::cos(2 * d.y + d.z);
    };
    const auto displayed = [&](const glm::dvec3& d) { return base::srgb_from_linear(linear(d)); };
    const scene::EnvironmentLight light = light_of(cube_of(128, displayed));
    for (std::size_t level = 0; level < light.prefiltered.size(); ++level)
        for (const std::size_t face : {std::size_t{0}, std::size_t{3}, std::size_t{5}}) {
            const scene::Image& image = light.prefiltered[level][face];
            const int x = image.width / 3, y = image.width / 2;
            const glm::dvec2 uv = (glm::dvec2(x, y) + 0.5) / static_cast<double>(image.width);
            const glm::dvec3 around = glm::normalize(math::direction_at(math::kCubeFaces[face], uv));
            const double roughness = static_cast<double>(level) / (scene::EnvironmentLight::kLevels - 1);
            const double expected = level == 0 ? linear(around) : mean_of_lobe(roughness, around, linear);
            CAPTURE(level);
            CAPTURE(face);
            CHECK(std::abs(image.rgba[4 * static_cast<std::size_t>(y * image.width + x)] -
                           255 * std::sqrt(expected)) < 2);
        }
}

TEST_CASE("metal reflects its colour, plastic four per cent and the rest matte") {
    reference::SurroundingLight white{glm::dvec3(1), glm::dvec3(1), glm::dvec3(1)};
    const glm::dvec3 gold(0.9, 0.6, 0.2);
    const glm::dvec3 metal = lit({gold, 1, 0.2, 0, 1}, dark(), white);
    CHECK(glm::distance(metal, gold) < 0.05);
    const glm::dvec3 plastic = lit({gold, 0, 0.2, 0, 1}, dark(), white);
    CHECK(glm::distance(plastic, 0.04 + 0.96 * gold) < 0.02);
    // As much as arrives leaves, at most.
    for (const double roughness : {0.0, 0.3, 0.6, 1.0})
        for (const double metallic : {0.0, 0.5, 1.0})
            for (const double cosine : {1.0, 0.5, 0.05})
                CHECK(lit({glm::dvec3(1), metallic, roughness, 0, 1}, dark(), white,
                          {std::sqrt(1 - cosine * cosine), 0, cosine})
                          .g <= 1);
}

TEST_CASE("occlusion takes the light of the surroundings away, and no other") {
    reference::SurroundingLight white{glm::dvec3(0.5), glm::dvec3(0.5), glm::dvec3(0.5)};
    const reference::MetallicSurface open{glm::dvec3(0.5), 0, 0.5, 0, 1},
        closed{glm::dvec3(0.5), 0, 0.5, 0, 0};
    CHECK(lit(closed, dark(), white) == glm::dvec3(0));
    scene::Light lamp;
    lamp.headlight = false;
    lamp.color = {0.5, 0.5, 0.5, 1};
    const glm::dvec3 both = lit(open, lamp, white), alone = lit(closed, lamp, white);
    CHECK(glm::distance(both - alone, lit(open, dark(), white)) < 1e-9);
    CHECK(alone.g > 0.1);
}

TEST_CASE("a rough surface reflects a light by GGX, and the headlight in part") {
    scene::Light light;
    light.color = glm::dvec4(0.5);
    // Head on: n·h = n·l = n·v = 1. π D V F = 1/(4 α²) 0.04, and the matte part 0.96 c.
    const double roughness = 0.8, alpha = roughness * roughness, c = 0.5;
    const double expected = 0.5 * scene::kHeadlightInEnvironment * (0.96 * c + 0.04 / (4 * alpha * alpha));
    CHECK(lit({glm::dvec3(c), 0, roughness, 0, 1}, light, {}).g == doctest::Approx(expected).epsilon(1e-6));
    light.headlight = false;
    CHECK(lit({glm::dvec3(c), 0, roughness, 0, 1}, light, {}).g ==
          doctest::Approx(expected / scene::kHeadlightInEnvironment).epsilon(1e-6));
}

TEST_CASE("a clear coat mirrors little from ahead and all along the surface") {
    reference::SurroundingLight mirrored;
    mirrored.sharp = glm::dvec3(1);
    const reference::MetallicSurface coated{glm::dvec3(0), 0, 1, 1, 0};
    CHECK(lit(coated, dark(), mirrored).g == doctest::Approx(0.04));
    CHECK(lit(coated, dark(), mirrored, {std::sqrt(1 - 1e-4), 0, 1e-2}).g > 0.9);
    CHECK(lit({glm::dvec3(0), 0, 1, 0.5, 0}, dark(), mirrored).g == doctest::Approx(0.02));
}

TEST_CASE("a normal map leans along growing u and v, on the side that is seen") {
    reference::SurfaceInteraction interaction = facing();
    CHECK(reference::mapped_normal(interaction, {0.6, 0, 0.8}) == kAhead);  // without tangents
    interaction.tangents = {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0)};
    CHECK(glm::distance(reference::mapped_normal(interaction, {0.6, 0, 0.8}), {0.6, 0, 0.8}) < 1e-12);
    CHECK(glm::distance(reference::mapped_normal(interaction, {0, 0.6, 0.8}), {0, -0.6, 0.8}) < 1e-12);
    interaction.side = -1;  // its back: the normal was turned to the viewer
    CHECK(glm::distance(reference::mapped_normal(interaction, {0.6, 0, 0.8}), {-0.6, 0, 0.8}) < 1e-12);
}
