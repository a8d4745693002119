#include "io/studio/environment.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "math/cube_faces.hpp"

namespace vrut::io {

namespace {

constexpr int kStudioSide = 128;  // pixels

// As displayed.
constexpr double kFloor = 0.47, kHorizon = 0.55, kCeiling = 0.36, kStrip = 0.97, kOverheadBox = 1;

/// 0 at `from`, 1 at `to`, with slope 0 at both.
double soft_step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// From a point to the edge of a rounded rectangle about the origin, negative inside.
double distance_to_rectangle(const glm::dvec2& point, const glm::dvec2& half_size, double radius) {
    const glm::dvec2 beyond = glm::abs(point) - half_size + radius;
    return glm::length(glm::max(beyond, 0.0)) + std::min(std::max(beyond.x, beyond.y), 0.0) - radius;
}

/// How much of a direction the box overhead covers, 0 to 1. Sizes are those on the plane y = 1.
double overhead_box(const glm::dvec3& direction) {
    constexpr glm::dvec2 kHalfSize{0.8, 1.35};
    constexpr double kRadius = 0.45, kEdge = 0.35;
    if (!(direction.y > 0)) return 0;
    const double distance =
        distance_to_rectangle(glm::dvec2(direction.x, direction.z) / direction.y, kHalfSize, kRadius);
    return soft_step(kEdge / 2, -kEdge / 2, distance);
}

/// The same of the strips. They run along z; elevations are those at right angles to it.
double side_strips(const glm::dvec3& direction) {
    constexpr double kLow = 18, kHigh = 44, kEdge = 14;  // degrees
    constexpr double kEnd = 2, kEndEdge = 1.2;           // in distances from the strip
    const double side = std::abs(direction.x), away = std::hypot(side, direction.y);
    if (!(side > 0)) return 0;
    const double elevation = degrees(std::atan2(direction.y, side)), along = std::abs(direction.z) / away;
    return soft_step(kLow - kEdge / 2, kLow + kEdge / 2, elevation) *
           soft_step(kHigh + kEdge / 2, kHigh - kEdge / 2, elevation) *
           soft_step(kEnd + kEndEdge / 2, kEnd - kEndEdge / 2, along);
}

}  // namespace

double studio_brightness(const glm::dvec3& direction) {
    constexpr double kWallTop = 60, kFloorFront = -30;  // degrees
    const double elevation = degrees(std::asin(std::clamp(direction.y, -1.0, 1.0)));
    double brightness = elevation > 0 ? glm::mix(kHorizon, kCeiling, soft_step(0, kWallTop, elevation))
                                      : glm::mix(kHorizon, kFloor, soft_step(0, kFloorFront, elevation));
    brightness = glm::mix(brightness, kStrip, side_strips(direction));
    return glm::mix(brightness, kOverheadBox, overhead_box(direction));
}

std::array<scene::Image, 6> studio_cube_map() {
    std::array<scene::Image, 6> images;
    for (std::size_t i = 0; i < images.size(); ++i) {
        images[i].resize(kStudioSide, kStudioSide);
        std::uint8_t* texel = images[i].rgba.data();
        for (int y = 0; y < kStudioSide; ++y)
            for (int x = 0; x < kStudioSide; ++x, texel += 4) {
                const glm::dvec2 uv = (glm::dvec2(x, y) + 0.5) / double{kStudioSide};
                const double brightness =
                    studio_brightness(glm::normalize(math::direction_at(math::kCubeFaces[i], uv)));
                std::fill_n(texel, 3, static_cast<std::uint8_t>(std::lround(255 * brightness)));
                texel[3] = 255;
            }
    }
    return images;
}

}  // namespace vrut::io
