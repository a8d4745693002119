#include "plan/triangle_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "plan/strong_components.hpp"

namespace vrut::plan {

namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

struct TriangleFace {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 normal{0};  ///< unit; zero for a degenerate one

    double distance(const glm::dvec3& point) const { return glm::dot(normal, point - corners[0]); }
};

/// Twice the area, along the normal.
glm::dvec3 area_of(const std::array<glm::dvec3, 3>& corners) {
    return glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
}

TriangleFace face_of(const std::array<glm::dvec3, 3>& corners) {
    const glm::dvec3 area = area_of(corners);
    const double length = glm::length(area);
    return {corners, length > 0 ? area / length : glm::dvec3(0)};
}

/// Of the positions.
std::array<unsigned, 3> indices_of(std::span<const glm::uvec3> triangles, std::size_t number) {
    const bool back = number >= triangles.size();
    const glm::uvec3& triangle = triangles[back ? number - triangles.size() : number];
    return {triangle.x, back ? triangle.z : triangle.y, back ? triangle.y : triangle.z};
}

/// Returns true if a ray can meet `a` from its front and then `b` from its front.
bool can_occlude(const TriangleFace& a, const TriangleFace& b, double tolerance) {
    const auto behind_a = [&](const glm::dvec3& corner) { return a.distance(corner) < -tolerance; };
    const auto before_b = [&](const glm::dvec3& corner) { return b.distance(corner) > tolerance; };
    return std::any_of(b.corners.begin(), b.corners.end(), behind_a) &&
           std::any_of(a.corners.begin(), a.corners.end(), before_b);
}

/// True where the plane through the origin and one of the edges of `a` has `b` on its other side.
bool separated_by_edge(const FrontFacingTriangle& a, const FrontFacingTriangle& b, double tolerance) {
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 outward = glm::cross(a.corners[(k + 1) % 3], a.corners[k]);
        if (outward == glm::dvec3(0)) continue;  // in line with the eye
        const double limit = tolerance * glm::length(outward);
        // Of two windings the one that leaves a's third corner inside.
        const double side = glm::dot(outward, a.corners[(k + 2) % 3]) > 0 ? -1 : 1;
        const auto outside = [&](const glm::dvec3& corner) {
            return side * glm::dot(outward, corner) >= -limit;
        };
        if (std::all_of(b.corners.begin(), b.corners.end(), outside)) return true;
    }
    return false;
}

bool boxes_overlap(const FrontFacingTriangle& a, const FrontFacingTriangle& b) {
    return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

/// Returns true if the plane of `a` has `b` behind it.
bool all_behind(const FrontFacingTriangle& a, const FrontFacingTriangle& b, double tolerance) {
    return std::all_of(b.corners.begin(), b.corners.end(), [&](const glm::dvec3& corner) {
        return glm::dot(a.normal, corner - a.corners[0]) <= tolerance;
    });
}

bool all_before(const FrontFacingTriangle& a, const FrontFacingTriangle& b, double tolerance) {
    return std::all_of(b.corners.begin(), b.corners.end(), [&](const glm::dvec3& corner) {
        return glm::dot(a.normal, corner - a.corners[0]) >= -tolerance;
    });
}

/// On the plane z = -1.
glm::dvec2 on_screen(const glm::dvec3& point) { return glm::dvec2(point) / -point.z; }

/// What of a convex polygon on the screen lies left of the line from `a` to `b`.
std::vector<glm::dvec2> clipped(const std::vector<glm::dvec2>& polygon, const glm::dvec2& a,
                                const glm::dvec2& b) {
    const auto side = [&](const glm::dvec2& p) {
        return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    };
    std::vector<glm::dvec2> result;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2 &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
        const double at_from = side(from), at_to = side(to);
        if (at_from >= 0) result.push_back(from);
        if ((at_from < 0) != (at_to < 0)) result.push_back(glm::mix(from, to, at_from / (at_from - at_to)));
    }
    return result;
}

/// By what both cover on the screen, for triangles before the eye: the inverse of the depth is linear there,
/// so its corners tell.
DepthRelation relation_where_both_cover(const FrontFacingTriangle& a, const FrontFacingTriangle& b,
                                        double tolerance) {
    std::array<glm::dvec2, 3> edges{on_screen(b.corners[0]), on_screen(b.corners[1]),
                                    on_screen(b.corners[2])};
    const glm::dvec2 u = edges[1] - edges[0], v = edges[2] - edges[0];
    if (u.x * v.y - u.y * v.x < 0) std::swap(edges[1], edges[2]);
    std::vector<glm::dvec2> both{on_screen(a.corners[0]), on_screen(a.corners[1]), on_screen(a.corners[2])};
    for (std::size_t k = 0; k < 3; ++k) both = clipped(both, edges[k], edges[(k + 1) % 3]);
    const auto depth = [](const FrontFacingTriangle& triangle, const glm::dvec2& at) {
        return glm::dot(triangle.normal, triangle.corners[0]) / glm::dot(triangle.normal, glm::dvec3(at, -1));
    };
    bool a_in_front = false, b_in_front = false;
    for (const glm::dvec2& at : both) {
        const double gap = depth(b, at) - depth(a, at);
        a_in_front = a_in_front || gap > tolerance;
        b_in_front = b_in_front || gap < -tolerance;
    }
    if (a_in_front && b_in_front) return DepthRelation::unknown;
    return a_in_front   ? DepthRelation::first_in_front
           : b_in_front ? DepthRelation::second_in_front
                        : DepthRelation::apart;
}

/// By the planes of both; unknown if each has corners of the other on both sides.
DepthRelation relation_by_planes(const FrontFacingTriangle& a, const FrontFacingTriangle& b,
                                 double tolerance) {
    const bool a_in_front = all_behind(a, b, tolerance) || all_before(b, a, tolerance);
    const bool b_in_front = all_behind(b, a, tolerance) || all_before(a, b, tolerance);
    if (a_in_front && b_in_front) return DepthRelation::apart;  // in one plane
    return a_in_front   ? DepthRelation::first_in_front
           : b_in_front ? DepthRelation::second_in_front
                        : DepthRelation::unknown;
}

/// Of two whose boxes overlap. `known`: the caller need not be told whether they are apart or so.
DepthRelation depth_relation(const FrontFacingTriangle& a, const FrontFacingTriangle& b, double tolerance,
                             DepthRelation known) {
    const DepthRelation order = relation_by_planes(a, b, tolerance);
    if (order == known || order == DepthRelation::apart) return order;
    if (separated_by_edge(a, b, tolerance) || separated_by_edge(b, a, tolerance)) return DepthRelation::apart;
    const bool before_eye = std::isfinite(a.low.x) && std::isfinite(b.low.x);
    return order == DepthRelation::unknown && before_eye ? relation_where_both_cover(a, b, tolerance) : order;
}

}  // namespace

TriangleOrder order_triangles(const scene::Geometry& geometry, CullMode cull_mode) {
    const std::size_t count = geometry.triangles.size() * (cull_mode == CullMode::none ? 2 : 1);
    TriangleOrder result;
    if (count > kMaxOrderedTriangles) {
        std::vector<unsigned>& cycle = result.cycles.emplace_back(count);
        std::iota(cycle.begin(), cycle.end(), 0U);
        return result;
    }
    const double tolerance = kNegligible * geometry.bounds.radius();
    std::vector<TriangleFace> faces;
    for (std::size_t k = 0; k < count; ++k) {
        const auto [a, b, c] = indices_of(geometry.triangles, k);
        faces.push_back(face_of({geometry.positions[a], geometry.positions[b], geometry.positions[c]}));
    }
    std::vector<std::vector<unsigned>> behind(count);
    for (unsigned a = 0; a < count; ++a)
        for (unsigned b = 0; b < count; ++b)
            if (can_occlude(faces[a], faces[b], tolerance)) behind[a].push_back(b);
    std::vector<unsigned> order;
    for (std::vector<unsigned>& component : strong_components(behind)) {
        order.insert(order.end(), component.begin(), component.end());
        if (component.size() > 1) result.cycles.push_back(std::move(component));
    }
    if (!std::is_sorted(order.begin(), order.end()))
        result.back_to_front = std::make_shared<const std::vector<unsigned>>(std::move(order));
    return result;
}

std::vector<FrontFacingTriangle> front_facing_triangles(const DrawItem& item,
                                                        const scene::Geometry& geometry) {
    std::vector<glm::dvec3> positions;  // in view space
    std::vector<glm::dvec2> projections;
    positions.reserve(geometry.positions.size());
    projections.reserve(geometry.positions.size());
    for (const glm::dvec3& position : geometry.positions) {
        positions.emplace_back(item.view_from_node * glm::dvec4(position, 1));
        projections.push_back(on_screen(positions.back()));
    }
    const auto count = static_cast<unsigned>(geometry.triangles.size());
    std::vector<FrontFacingTriangle> result;
    result.reserve(count);
    for (unsigned number = 0; number < count; ++number) {
        glm::uvec3 indices = geometry.triangles[number];
        glm::dvec3 area = area_of({positions[indices.x], positions[indices.y], positions[indices.z]});
        if (item.mirrored) area = -area;
        const double away = glm::dot(area, positions[indices.x]), length = glm::length(area);
        const bool back = away > 0;
        if (!(length > 0) || !(back || away < 0) || (back && item.cull_mode != CullMode::none)) continue;
        if (back) {
            std::swap(indices.y, indices.z);
            area = -area;
        }
        const auto [i, j, k] = std::array{indices.x, indices.y, indices.z};
        const std::array<glm::dvec3, 3> corners{positions[i], positions[j], positions[k]};
        FrontFacingTriangle triangle{corners, area / length, back ? count + number : number,
                                     glm::min(glm::min(projections[i], projections[j]), projections[k]),
                                     glm::max(glm::max(projections[i], projections[j]), projections[k])};
        const auto behind_eye = [](const glm::dvec3& corner) { return !(corner.z < 0); };
        if (std::all_of(corners.begin(), corners.end(), behind_eye)) continue;
        if (std::any_of(corners.begin(), corners.end(), behind_eye)) {
            triangle.low = glm::dvec2(-kEverywhere);
            triangle.high = glm::dvec2(kEverywhere);
        }
        result.push_back(triangle);
    }
    std::sort(result.begin(), result.end(), [](const FrontFacingTriangle& a, const FrontFacingTriangle& b) {
        return std::tie(a.low.x, a.number) < std::tie(b.low.x, b.number);
    });
    return result;
}

DepthRelation depth_relation(std::span<const FrontFacingTriangle> first,
                             std::span<const FrontFacingTriangle> second, double tolerance) {
    if (first.size() * second.size() > kMaxComparedPairs) return DepthRelation::unknown;
    DepthRelation result = DepthRelation::apart;
    for (const FrontFacingTriangle& a : first)
        for (const FrontFacingTriangle& b : second) {
            if (b.low.x >= a.high.x) break;
            if (!boxes_overlap(a, b)) continue;
            const DepthRelation order = depth_relation(a, b, tolerance, result);
            if (order == DepthRelation::apart || order == result) continue;
            if (result != DepthRelation::apart || order == DepthRelation::unknown)
                return DepthRelation::unknown;
            result = order;
        }
    return result;
}

std::optional<std::vector<unsigned>> back_to_front(std::span<const FrontFacingTriangle> triangles,
                                                   double tolerance) {
    std::vector<std::vector<unsigned>> behind(triangles.size());
    std::size_t looked_at = 0;
    for (unsigned i = 0; i < triangles.size(); ++i)
        for (unsigned k = i + 1; k < triangles.size() && triangles[k].low.x < triangles[i].high.x; ++k) {
            if (++looked_at > 4 * kMaxComparedPairs) return std::nullopt;
            if (!boxes_overlap(triangles[i], triangles[k])) continue;
            switch (depth_relation(triangles[i], triangles[k], tolerance, DepthRelation::apart)) {
                case DepthRelation::first_in_front:
                    behind[i].push_back(k);
                    break;
                case DepthRelation::second_in_front:
                    behind[k].push_back(i);
                    break;
                case DepthRelation::unknown:
                    return std::nullopt;
                case DepthRelation::apart:
                    break;
            }
        }
    std::vector<unsigned> result;
    for (const std::vector<unsigned>& component : strong_components(behind)) {
        if (component.size() > 1) return std::nullopt;
        result.push_back(triangles[component[0]].number);
    }
    return result;
}

}  // namespace vrut::plan
