#include "scene/environment_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/srgb.hpp"
#include "math/cube_faces.hpp"

namespace vrut::scene {

namespace {

constexpr double kPi = glm::pi<double>();

/// A square of linear light, rows from the bottom up.
struct LightSquare {
    int side = 0;
    std::vector<glm::dvec3> texels;

    glm::dvec3& at(int x, int y) { return texels[index(x, y)]; }
    const glm::dvec3& at(int x, int y) const { return texels[index(x, y)]; }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
    }
};
using LightCube = std::array<LightSquare, 6>;

/// The mean of a square's texels under each of `side` columns or rows, by area.
template <class Get, class Set>
void resample(int from, int side, const Get& get, const Set& set) {
    const double ratio = static_cast<double>(from) / side;
    for (int i = 0; i < side; ++i) {
        const double begin = i * ratio, end = (i + 1) * ratio;
        glm::dvec3 sum(0);
        for (int k = static_cast<int>(begin); k < from && k < end; ++k)
            sum += (std::min<double>(k + 1, end) - std::max<double>(k, begin)) * get(k);
        set(i, sum / ratio);
    }
}

LightSquare resampled(const Image& image, int side) {
    std::array<double, 256> linear{};
    for (std::size_t i = 0; i < linear.size(); ++i)
        linear[i] = base::linear_from_srgb(static_cast<double>(i) / 255);
    const auto texel = [&](int x, int y) {
        const std::uint8_t* rgba =
            &image.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                             static_cast<std::size_t>(x))];
        return glm::dvec3(linear[rgba[0]], linear[rgba[1]], linear[rgba[2]]);
    };
    const auto height = static_cast<std::size_t>(image.height);
    std::vector<glm::dvec3> rows(static_cast<std::size_t>(side) * height);
    const auto row_at = [&](int x, int y) -> glm::dvec3& {
        return rows[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                    static_cast<std::size_t>(x)];
    };
    for (int y = 0; y < image.height; ++y)
        resample(
            image.width, side, [&](int x) { return texel(x, y); },
            [&](int x, const glm::dvec3& mean) { row_at(x, y) = mean; });
    const auto length = static_cast<std::size_t>(side);
    LightSquare square;
    square.side = side;
    square.texels.resize(length * length);
    for (int x = 0; x < side; ++x)
        resample(
            image.height, side, [&](int y) { return row_at(x, y); },
            [&](int y, const glm::dvec3& mean) { square.at(x, y) = mean; });
    return square;
}

LightSquare half_of(const LightSquare& square) {
    LightSquare half;
    half.side = square.side / 2;
    for (int y = 0; y < half.side; ++y)
        for (int x = 0; x < half.side; ++x)
            half.texels.push_back((square.at(2 * x, 2 * y) + square.at(2 * x + 1, 2 * y) +
                                   square.at(2 * x, 2 * y + 1) + square.at(2 * x + 1, 2 * y + 1)) /
                                  4.0);
    return half;
}

/// The cube in squares of kSide and its halves, down to a single texel.
std::vector<LightCube> pyramid_of(const std::array<const Image*, 6>& images) {
    std::vector<LightCube> levels(1);
    for (std::size_t i = 0; i < 6; ++i) levels[0][i] = resampled(*images[i], EnvironmentLight::kSide);
    while (levels.back()[0].side > 1) {
        LightCube half;
        for (std::size_t i = 0; i < 6; ++i) half[i] = half_of(levels.back()[i]);
        levels.push_back(std::move(half));
    }
    return levels;
}

glm::dvec3 bilinear(const LightSquare& square, const glm::dvec2& uv) {
    const glm::dvec2 at = glm::clamp(uv * static_cast<double>(square.side) - 0.5, 0.0, square.side - 1.0);
    const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
    const int right = std::min(x + 1, square.side - 1), above = std::min(y + 1, square.side - 1);
    return glm::mix(glm::mix(square.at(x, y), square.at(right, y), at.x - x),
                    glm::mix(square.at(x, above), square.at(right, above), at.x - x), at.y - y);
}

glm::dvec3 sample(const std::vector<LightCube>& levels, const glm::dvec3& direction, double level) {
    const std::size_t face = math::cube_face_of(direction);
    const glm::dvec2 uv = math::uv_on(math::kCubeFaces[face], direction);
    level = std::clamp(level, 0.0, static_cast<double>(levels.size() - 1));
    const auto finer = static_cast<std::size_t>(level), coarser = std::min(finer + 1, levels.size() - 1);
    return glm::mix(bilinear(levels[finer][face], uv), bilinear(levels[coarser][face], uv),
                    level - static_cast<double>(finer));
}

/// A direction that rough surfaces send light to, about the z axis, its share of the light, and the level
/// that holds what lies about it.
struct LobeSample {
    glm::dvec3 direction{0, 0, 1};
    double weight = 1, level = 0;
};

/// Samples of GGX, seen along the normal (Křivánek and Colbert 2008, "Real-time Shading with Filtered
/// Importance Sampling").
std::vector<LobeSample> lobe_samples(double roughness) {
    constexpr int kSamples = 128;
    constexpr double kTexel = 4 * kPi / (6.0 * EnvironmentLight::kSide * EnvironmentLight::kSide);
    const double alpha = roughness * roughness, squared = alpha * alpha;
    std::vector<LobeSample> samples;
    for (unsigned i = 0; i < kSamples; ++i) {
        double reversed = 0, place = 0.5;  // the radical inverse (Hammersley)
        for (unsigned bits = i; bits != 0; bits >>= 1, place /= 2) reversed += (bits & 1U) != 0 ? place : 0;
        const double xi = (i + 0.5) / kSamples, angle = 2 * kPi * reversed;
        const double cosine = std::sqrt((1 - xi) / (1 + (squared - 1) * xi));
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        const glm::dvec3 half(sine * std::cos(angle), sine * std::sin(angle), cosine);
        const glm::dvec3 direction = 2 * cosine * half - glm::dvec3(0, 0, 1);
        if (!(direction.z > 0)) continue;
        const double denominator = cosine * cosine * (squared - 1) + 1;
        const double density = squared / (kPi * denominator * denominator) / 4;
        samples.push_back({direction, direction.z, 0.5 * std::log2(1 / (kSamples * density) / kTexel)});
    }
    return samples;
}

/// Three unit axes, the last one along `direction`.
glm::dmat3 frame_of(const glm::dvec3& direction) {
    const glm::dvec3 n = glm::normalize(direction);
    const glm::dvec3 helper = std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(helper, n));
    return {x, glm::cross(n, x), n};
}

std::uint8_t root_byte(double light) {
    return static_cast<std::uint8_t>(std::lround(255 * std::sqrt(std::clamp(light, 0.0, 1.0))));
}

/// The images of `side` pixels whose pixels are the roots of what `light` returns for their directions.
template <class Light>
std::array<Image, 6> images_of(int side, const Light& light) {
    std::array<Image, 6> images;
    for (std::size_t face = 0; face < 6; ++face) {
        images[face].resize(side, side);
        std::uint8_t* to = images[face].rgba.data();
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const glm::dvec2 uv = (glm::dvec2(x, y) + 0.5) / static_cast<double>(side);
                const glm::dvec3 color = light(math::direction_at(math::kCubeFaces[face], uv));
                for (int i = 0; i < 3; ++i) *to++ = root_byte(color[i]);
                *to++ = 255;
            }
    }
    return images;
}

/// Real spherical harmonics but for their constants, in the order of EnvironmentLight::harmonics.
std::array<double, 9> polynomials(const glm::dvec3& n) {
    return {1, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3 * n.z * n.z - 1, n.x * n.z, n.x * n.x - n.y * n.y};
}

/// By what a cosine lobe keeps of each, π taken out: 1, 2/3, 1/4, times the square of its constant.
std::array<glm::dvec3, 9> project(const LightCube& cube) {
    constexpr double kFirst = 2.0 / 3 * 3 / (4 * kPi), kSecond = 1.0 / 4 * 15 / (4 * kPi);
    constexpr std::array<double, 9> kFactors{1 / (4 * kPi), kFirst,       kFirst,  kFirst,     kSecond,
                                             kSecond,       kSecond / 12, kSecond, kSecond / 4};
    std::array<glm::dvec3, 9> harmonics{};
    for (std::size_t face = 0; face < 6; ++face) {
        const LightSquare& square = cube[face];
        for (int y = 0; y < square.side; ++y)
            for (int x = 0; x < square.side; ++x) {
                const glm::dvec2 uv = (glm::dvec2(x, y) + 0.5) / static_cast<double>(square.side);
                const glm::dvec3 direction = math::direction_at(math::kCubeFaces[face], uv);
                const double length = glm::length(direction);
                const double solid_angle = 4 / (square.side * square.side * length * length * length);
                const std::array<double, 9> values = polynomials(direction / length);
                for (std::size_t i = 0; i < 9; ++i)
                    harmonics[i] += square.at(x, y) * (values[i] * solid_angle * kFactors[i]);
            }
    }
    return harmonics;
}

}  // namespace

EnvironmentLight prefilter(const std::array<const Image*, 6>& cube_map) {
    constexpr std::size_t kQuarter = 2;  // is fine enough for what varies so slowly
    const std::vector<LightCube> levels = pyramid_of(cube_map);
    EnvironmentLight light;
    light.harmonics = project(levels[kQuarter]);
    light.prefiltered.push_back(images_of(
        EnvironmentLight::kSide, [&](const glm::dvec3& direction) { return sample(levels, direction, 0); }));
    for (int k = 1; k < EnvironmentLight::kLevels; ++k) {
        const std::vector<LobeSample> lobe =
            lobe_samples(static_cast<double>(k) / (EnvironmentLight::kLevels - 1));
        light.prefiltered.push_back(images_of(EnvironmentLight::kSide >> k, [&](const glm::dvec3& around) {
            const glm::dmat3 frame = frame_of(around);
            glm::dvec3 sum(0);
            double weights = 0;
            for (const LobeSample& one : lobe) {
                sum += one.weight * sample(levels, frame * one.direction, one.level);
                weights += one.weight;
            }
            return sum / weights;
        }));
    }
    return light;
}

glm::dvec3 irradiance(const EnvironmentLight& light, const glm::dvec3& normal) {
    const std::array<double, 9> values = polynomials(normal);
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < 9; ++i) sum += light.harmonics[i] * values[i];
    return glm::max(sum, 0.0);
}

}  // namespace vrut::scene
