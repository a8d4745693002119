#pragma once

#include <cmath>
#include <glm/glm.hpp>

// The transfer curve of sRGB (IEC 61966-2-1); all values are from 0 to 1.
namespace vrut::base {

inline double linear_from_srgb(double displayed) {
    return displayed <= 0.04045 ? displayed / 12.92 : std::pow((displayed + 0.055) / 1.055, 2.4);
}

/// Linear values beyond 0 to 1 are clamped.
inline double srgb_from_linear(double linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;  // which pow() misses
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

inline glm::dvec3 linear_from_srgb(const glm::dvec3& displayed) {
    return {linear_from_srgb(displayed.r), linear_from_srgb(displayed.g), linear_from_srgb(displayed.b)};
}

inline glm::dvec3 srgb_from_linear(const glm::dvec3& linear) {
    return {srgb_from_linear(linear.r), srgb_from_linear(linear.g), srgb_from_linear(linear.b)};
}

}  // namespace vrut::base
