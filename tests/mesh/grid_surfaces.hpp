#pragma once

#include <cmath>
#include <numbers>

#include "shapes.hpp"

namespace vrut {

/// cos and sin of a part of a full turn, the same at 0 and 1.
inline glm::dvec2 turn(double part) {
    const double angle = 2 * std::numbers::pi * (part < 1 ? part : 0);
    return {std::cos(angle), std::sin(angle)};
}

inline scene::Geometry ball(unsigned columns, unsigned rows) {
    return surface(columns, rows, [](double u, double v) {
        const double up = std::numbers::pi * v, ring = v > 0 && v < 1 ? std::sin(up) : 0;
        return glm::dvec3(ring * turn(u), v < 1 ? std::cos(up) : -1);
    });
}

inline scene::Geometry torus(unsigned columns, unsigned rows) {
    return surface(columns, rows, [](double u, double v) {
        const glm::dvec2 across = turn(v);
        return glm::dvec3((1 + 0.3 * across.x) * turn(u), 0.3 * across.y);
    });
}

/// Bends in one direction only, with creases.
inline scene::Geometry corrugated(unsigned columns, unsigned rows) {
    return surface(columns, rows, [](double u, double v) {
        return glm::dvec3(u, 0.02 * std::abs(std::sin(20 * u)) + 0.001 * std::sin(90 * v), v);
    });
}

}  // namespace vrut
