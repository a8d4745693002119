#include "scene/fitted_plane.hpp"

#include <algorithm>
#include <cmath>

#include "scene/scene.hpp"

namespace vrut::scene {

namespace {

/// The edges from one corner of a few triangles to three others, which span as much as is easily found.
glm::dmat3 wide_edges(const Geometry& geometry) {
    const std::size_t step = geometry.triangles.size() / 64 + 1;
    glm::dmat3 edges(0);
    const auto widen = [&](glm::dvec3& edge, const auto& measure) {
        for (std::size_t i = 0; i < geometry.triangles.size(); i += step) {
            const glm::dvec3 other =
                geometry.positions[geometry.triangles[i].x] - geometry.positions[geometry.triangles[0].x];
            if (measure(other) > measure(edge)) edge = other;
        }
    };
    widen(edges[0], [](const glm::dvec3& e) { return glm::length(e); });
    widen(edges[1], [&](const glm::dvec3& e) { return glm::length(glm::cross(edges[0], e)); });
    const glm::dvec3 normal = glm::cross(edges[0], edges[1]);
    widen(edges[2], [&](const glm::dvec3& e) { return std::abs(glm::dot(normal, e)); });
    return edges;
}

/// Returns true if four corners alone lie in no plane, however it is fitted. Between two planes that are 2
/// `limit` apart, edges a, b and c span a volume of at most 2 `limit` (|a| |b| + |b| |c| + |c| |a|).
bool is_solid(const Geometry& geometry, double limit) {
    if (geometry.triangles.empty()) return false;
    const glm::dmat3 edges = wide_edges(geometry);
    const double a = glm::length(edges[0]), b = glm::length(edges[1]), c = glm::length(edges[2]);
    return std::abs(glm::determinant(edges)) > 4 * limit * (a * b + b * c + c * a);  // twice, for rounding
}

}  // namespace

std::optional<math::Plane> fitted_plane(const Geometry& geometry) {
    const double limit = 1e-4 * geometry.bounds.radius();
    if (is_solid(geometry, limit)) return std::nullopt;
    const glm::dvec3 center = geometry.bounds.empty() ? glm::dvec3(0) : geometry.bounds.center();
    const auto corner = [&](const glm::uvec3& triangle, int k) {
        return geometry.positions[triangle[k]] - center;
    };
    const auto doubled_area = [&](const glm::uvec3& triangle) {
        const glm::dvec3 a = corner(triangle, 0);
        return glm::cross(corner(triangle, 1) - a, corner(triangle, 2) - a);
    };
    // All turned like the largest, so that a sheet with two faces has a plane too.
    glm::dvec3 largest(0);
    for (const glm::uvec3& triangle : geometry.triangles)
        if (const glm::dvec3 area = doubled_area(triangle); glm::length(area) > glm::length(largest))
            largest = area;
    glm::dvec3 normal(0), weighted(0);
    double total = 0;
    for (const glm::uvec3& triangle : geometry.triangles) {
        const glm::dvec3 area = doubled_area(triangle);
        normal += glm::dot(area, largest) < 0 ? -area : area;
        const double weight = glm::length(area);
        weighted += weight / 3 * (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2));
        total += weight;
    }
    const double length = glm::length(normal);
    if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
    const math::Plane plane{normal / length, center + weighted / total};
    for (const glm::uvec3& triangle : geometry.triangles)
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(plane.distance(geometry.positions[triangle[k]])) <= limit)) return std::nullopt;
    return plane;
}

}  // namespace vrut::scene
