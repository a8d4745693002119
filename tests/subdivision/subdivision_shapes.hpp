#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "cage.hpp"

/// Cages for tests, and what can be said of triangles.
namespace vrut::shapes {

/// From -1 to 1, all edges as sharp.
inline Cage cube(double sharpness = 0) {
    Cage cage;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0}) cage.points.emplace_back(x, y, z);
    cage.quads = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    if (sharpness > 0)
        for (int a = 0; a < 8; ++a)
            for (const int bit : {1, 2, 4})
                if ((a & bit) == 0) cage.creases.push_back({a, a | bit, sharpness});
    return cage;
}

/// A grid of n x n quads through place(u, v), seen from du x dv.
template <class Place>
Cage grid(int n, const Place& place) {
    Cage cage;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
            const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
            cage.points.push_back(place(u, v));
            cage.texcoords.emplace_back(u, v);
        }
    const int row = n + 1;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const int a = i * row + j;
            cage.quads.push_back({a, a + row, a + row + 1, a + 1});
        }
    return cage;
}

/// An open cylinder about y whose limit has the radius 1.
inline Cage cylinder() {
    constexpr int kSides = 16, kRings = 4;
    const double step = 2 * std::numbers::pi / kSides, radius = 6 / (4 + 2 * std::cos(step));
    Cage cage;
    for (int ring = 0; ring < kRings; ++ring)
        for (int i = 0; i < kSides; ++i)
            cage.points.emplace_back(radius * std::cos(i * step), ring, -radius * std::sin(i * step));
    for (int ring = 0; ring + 1 < kRings; ++ring)
        for (int i = 0; i < kSides; ++i) {
            const int a = ring * kSides + i, b = ring * kSides + (i + 1) % kSides;
            cage.quads.push_back({a, b, b + kSides, a + kSides});
        }
    return cage;
}

using Place = std::array<double, 3>;

/// Half-edges without exactly one opposite, by position.
inline int open_edges(const scene::Geometry& geometry) {
    std::map<std::pair<Place, Place>, int> edges;
    const auto place = [&](unsigned i) {
        const glm::dvec3& p = geometry.positions[i];
        return Place{p.x, p.y, p.z};
    };
    for (const glm::uvec3& t : geometry.triangles)
        for (int k = 0; k < 3; ++k) ++edges[{place(t[k]), place(t[(k + 1) % 3])}];
    int open = 0;
    for (const auto& [edge, count] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        if (count != 1 || back == edges.end() || back->second != 1) ++open;
    }
    return open;
}

inline double volume(const scene::Geometry& geometry) {
    double six = 0;
    for (const glm::uvec3& t : geometry.triangles)
        six +=
            glm::dot(geometry.positions[t.x], glm::cross(geometry.positions[t.y], geometry.positions[t.z]));
    return six / 6;
}

}  // namespace vrut::shapes
