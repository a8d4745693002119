#include "measurement/snap_around.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/picking.hpp"

namespace vrut::measurement {

namespace {

constexpr int kRaysAround = 8;

bool is_of_a_surface(Snap snap) { return snap == Snap::point || snap == Snap::plane; }

/// The more special one counts, and of two alike the nearer one.
bool is_better(const Snapped& a, const Snapped& b) {
    constexpr std::array kRanks{6, 0, 1, 2, 4, 3, 5};  // by Snap
    const int rank_a = kRanks[static_cast<std::size_t>(a.feature.snap)];
    const int rank_b = kRanks[static_cast<std::size_t>(b.feature.snap)];
    return rank_a != rank_b ? rank_a < rank_b : a.offset < b.offset;
}

}  // namespace

std::optional<Snapped> snap_around(const scene::PlacedScene& placed, const mesh::Ray& ray,
                                   const FindHit& find_hit, const SnapOptions& options, MeshEdgesMemo& memo) {
    std::optional<Snapped> best;
    const auto look = [&](const glm::dvec3& direction, bool is_beside) {
        const auto hit = find_hit({ray.origin, glm::normalize(direction)});
        if (!hit) return;
        const auto found = snap(placed, *hit, ray, options, memo);
        if (!found || (is_beside && is_of_a_surface(found->feature.snap))) return;
        if (!best || is_better(*found, *best)) best = found;
    };
    look(ray.direction, false);
    if (!(options.radius > 0)) return best;
    const glm::dvec3 sizes = glm::abs(ray.direction);
    const bool is_along_x = sizes.x > std::max(sizes.y, sizes.z);
    const glm::dvec3 across =
        glm::normalize(glm::cross(ray.direction, is_along_x ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
    const glm::dvec3 other = glm::cross(ray.direction, across);
    for (int i = 0; i < kRaysAround; ++i) {
        const double angle = 2 * std::numbers::pi * i / kRaysAround;
        look(ray.direction + options.radius * (std::cos(angle) * across + std::sin(angle) * other), true);
    }
    return best;
}

}  // namespace vrut::measurement
