#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "shapes.hpp"

namespace vrut {

using Outline = std::vector<glm::dvec2>;

inline scene::Geometry with_bounds(scene::Geometry geometry) {
    geometry.bounds = {};
    for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
    return geometry;
}

inline glm::dvec2 on_circle(double radius, unsigned i, unsigned count) {
    const double angle = 2 * std::numbers::pi * (i % count) / count;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

inline Outline circle_outline(double radius, unsigned count) {
    Outline outline;
    for (unsigned i = 0; i < count; ++i) outline.push_back(on_circle(radius, i, count));
    return outline;
}

/// Points of a square, in the directions of a circle's: its corners are there if `count` is a multiple of 8.
inline Outline square_outline(double half, unsigned count) {
    Outline outline;
    for (unsigned i = 0; i < count; ++i) {
        const glm::dvec2 p = on_circle(1, i, count);
        const double size = std::max(std::abs(p.x), std::abs(p.y));
        glm::dvec2 q = p * (half / size);
        for (int k = 0; k < 2; ++k)
            if (std::abs(std::abs(q[k]) - half) < 1e-9) q[k] = std::copysign(half, q[k]);
        outline.push_back(q);
    }
    return outline;
}

/// Every triangle gets its own corners, as flat parts in files have.
inline scene::Geometry unwelded(const scene::Geometry& geometry) {
    scene::Geometry soup;
    for (const glm::uvec3& t : geometry.triangles) {
        const auto first = static_cast<unsigned>(soup.positions.size());
        for (int k = 0; k < 3; ++k) soup.positions.push_back(geometry.positions[t[k]]);
        soup.triangles.emplace_back(first, first + 1, first + 2);
    }
    return with_bounds(std::move(soup));
}

/// Between two outlines of the same number of points, both counter-clockwise, from z = low to high: closed.
inline scene::Geometry ring(const Outline& inner, const Outline& outer, double low, double high) {
    scene::Geometry geometry;
    const auto count = static_cast<unsigned>(inner.size());
    for (const double z : {low, high})
        for (const Outline* outline : {&inner, &outer})
            for (const glm::dvec2& p : *outline) geometry.positions.emplace_back(p, z);
    const auto quad = [&](unsigned a, unsigned b, unsigned i, unsigned j) {
        const unsigned p = a * count + i, q = b * count + i, r = b * count + j, s = a * count + j;
        geometry.triangles.emplace_back(p, q, r);
        geometry.triangles.emplace_back(p, r, s);
    };
    for (unsigned i = 0; i < count; ++i) {
        const unsigned j = (i + 1) % count;
        quad(2, 3, i, j);  // above
        quad(1, 0, i, j);  // below
        quad(3, 1, i, j);  // outside
        quad(0, 2, i, j);  // inside
    }
    return unwelded(geometry);
}

/// A square plate with a round hole, 0.25 thick, its top at z = 0.
inline scene::Geometry plate(double half = 2, double radius = 1, unsigned count = 32) {
    return ring(circle_outline(radius, count), square_outline(half, count), -0.25, 0);
}

/// A closed prism over an outline around the origin, its top at z = 0; a cone if `top` is 0.
inline scene::Geometry prism(const Outline& outline, double height, double top = 1) {
    scene::Geometry geometry;
    const auto count = static_cast<unsigned>(outline.size());
    geometry.positions = {{0, 0, -height}, {0, 0, 0}};
    for (const glm::dvec2& p : outline) {
        geometry.positions.emplace_back(p, -height);
        geometry.positions.emplace_back(p * top, 0);
    }
    for (unsigned i = 0; i < count; ++i) {
        const unsigned a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % count);
        geometry.triangles.emplace_back(0, b, a);
        geometry.triangles.emplace_back(1, a + 1, b + 1);
        geometry.triangles.emplace_back(a, b, b + 1);
        geometry.triangles.emplace_back(a, b + 1, a + 1);
    }
    return unwelded(geometry);
}

/// How a whole scene may be placed, and by what its lengths are multiplied.
struct Variant {
    std::string name;
    glm::dmat4 matrix{1};
    double scale = 1;
};

inline std::vector<Variant> variants() {
    const glm::dvec3 far(1e7, -2e7, 1.5e7), axis = glm::normalize(glm::dvec3(1, 2, -3));
    return {{"as is", glm::dmat4(1), 1},
            {"moved", moved_by(far), 1},
            {"rotated", turned_by(77, axis), 1},
            {"small", scaled_by(glm::dvec3(1e-3)), 1e-3},
            {"large", scaled_by(glm::dvec3(1e3)), 1e3},
            {"mirrored", scaled_by({-1, 1, 1}), 1},
            {"all", moved_by(far) * turned_by(77, axis) * scaled_by({1.7, -1.7, 1.7}), 1.7}};
}

/// The parts below a root with this matrix.
inline std::shared_ptr<const scene::PlacedScene> scene_under(const glm::dmat4& root,
                                                             const std::vector<Part>& parts) {
    const auto as_is = scene_of(parts);
    std::vector<scene::NodeState> states = as_is->nodes;
    states[0].matrix = root;
    return std::make_shared<scene::PlacedScene>(scene::place(as_is->scene, std::move(states)));
}

}  // namespace vrut
