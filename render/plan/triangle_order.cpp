#include "plan/triangle_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "plan/strong_components.hpp"

namespace vrut {

namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

struct Face {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 normal{0};  ///< unit; zero for a degenerate one

    double distance(const glm::dvec3& point) const { return glm::dot(normal, point - corners[0]); }
};

Face face_of(const std::array<glm::dvec3, 3>& corners) {
    const glm::dvec3 area = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double length = glm::length(area);
    return {corners, length > 0 ? area / length : glm::dvec3(0)};
}

std::array<glm::dvec3, 3> corners_of(const Geometry& geometry, std::size_t number) {
    const std::size_t count = geometry.triangles.size();
    glm::uvec3 triangle = geometry.triangles[number % count];
    if (number >= count) std::swap(triangle.y, triangle.z);
    return {geometry.positions[triangle.x], geometry.positions[triangle.y], geometry.positions[triangle.z]};
}

/// Whether a ray can meet `a` from its front and then `b` from its front.
bool can_hide(const Face& a, const Face& b, double tolerance) {
    const auto behind_a = [&](const glm::dvec3& corner) { return a.distance(corner) < -tolerance; };
    const auto before_b = [&](const glm::dvec3& corner) { return b.distance(corner) > tolerance; };
    return std::any_of(b.corners.begin(), b.corners.end(), behind_a) &&
           std::any_of(a.corners.begin(), a.corners.end(), before_b);
}

/// True where the plane through the origin and one of the edges of `a` has `b` on its other side.
bool parted_by_edge(const FacingTriangle& a, const FacingTriangle& b, double tolerance) {
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

bool overlap(const FacingTriangle& a, const FacingTriangle& b, double tolerance) {
    if (a.low.x >= b.high.x || b.low.x >= a.high.x || a.low.y >= b.high.y || b.low.y >= a.high.y)
        return false;
    return !parted_by_edge(a, b, tolerance) && !parted_by_edge(b, a, tolerance);
}

/// Whether the plane of `a` has `b` behind it.
bool all_behind(const FacingTriangle& a, const FacingTriangle& b, double tolerance) {
    return std::all_of(b.corners.begin(), b.corners.end(), [&](const glm::dvec3& corner) {
        return glm::dot(a.normal, corner - a.corners[0]) <= tolerance;
    });
}

bool all_before(const FacingTriangle& a, const FacingTriangle& b, double tolerance) {
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
Order order_where_both_are(const FacingTriangle& a, const FacingTriangle& b, double tolerance) {
    std::array<glm::dvec2, 3> edges{on_screen(b.corners[0]), on_screen(b.corners[1]),
                                    on_screen(b.corners[2])};
    const glm::dvec2 u = edges[1] - edges[0], v = edges[2] - edges[0];
    if (u.x * v.y - u.y * v.x < 0) std::swap(edges[1], edges[2]);
    std::vector<glm::dvec2> both{on_screen(a.corners[0]), on_screen(a.corners[1]), on_screen(a.corners[2])};
    for (std::size_t k = 0; k < 3; ++k) both = clipped(both, edges[k], edges[(k + 1) % 3]);
    const auto depth = [](const FacingTriangle& triangle, const glm::dvec2& at) {
        return glm::dot(triangle.normal, triangle.corners[0]) / glm::dot(triangle.normal, glm::dvec3(at, -1));
    };
    bool a_in_front = false, b_in_front = false;
    for (const glm::dvec2& at : both) {
        const double gap = depth(b, at) - depth(a, at);
        a_in_front = a_in_front || gap > tolerance;
        b_in_front = b_in_front || gap < -tolerance;
    }
    if (a_in_front && b_in_front) return Order::unknown;
    return a_in_front ? Order::first_in_front : b_in_front ? Order::second_in_front : Order::apart;
}

Order order_of(const FacingTriangle& a, const FacingTriangle& b, double tolerance) {
    if (!overlap(a, b, tolerance)) return Order::apart;
    const bool a_in_front = all_behind(a, b, tolerance) || all_before(b, a, tolerance);
    const bool b_in_front = all_behind(b, a, tolerance) || all_before(a, b, tolerance);
    if (a_in_front && b_in_front) return Order::apart;  // in one plane
    if (a_in_front) return Order::first_in_front;
    if (b_in_front) return Order::second_in_front;
    const bool before_eye = std::isfinite(a.low.x) && std::isfinite(b.low.x);
    return before_eye ? order_where_both_are(a, b, tolerance) : Order::unknown;
}

}  // namespace

TriangleOrder order_triangles(const Geometry& geometry, Sides sides) {
    const std::size_t count = geometry.triangles.size() * (sides == Sides::both ? 2 : 1);
    TriangleOrder result;
    if (count > kMostOrdered) {
        std::vector<unsigned>& ring = result.rings.emplace_back(count);
        std::iota(ring.begin(), ring.end(), 0U);
        return result;
    }
    const double tolerance = kNegligible * geometry.bounds.radius();
    std::vector<Face> faces;
    for (std::size_t k = 0; k < count; ++k) faces.push_back(face_of(corners_of(geometry, k)));
    std::vector<std::vector<unsigned>> behind(count);
    for (unsigned a = 0; a < count; ++a)
        for (unsigned b = 0; b < count; ++b)
            if (can_hide(faces[a], faces[b], tolerance)) behind[a].push_back(b);
    std::vector<unsigned> order;
    for (std::vector<unsigned>& component : strong_components(behind)) {
        order.insert(order.end(), component.begin(), component.end());
        if (component.size() > 1) result.rings.push_back(std::move(component));
    }
    if (!std::is_sorted(order.begin(), order.end()))
        result.far_to_near = std::make_shared<const std::vector<unsigned>>(std::move(order));
    return result;
}

std::vector<FacingTriangle> facing_triangles(const DrawItem& item, const Geometry& geometry) {
    std::vector<unsigned> all(geometry.triangles.size() * (item.sides == Sides::both ? 2 : 1));
    std::iota(all.begin(), all.end(), 0U);
    return facing_triangles(item, geometry, all);
}

std::vector<FacingTriangle> facing_triangles(const DrawItem& item, const Geometry& geometry,
                                             std::span<const unsigned> numbers) {
    std::vector<FacingTriangle> result;
    for (const unsigned number : numbers) {
        std::array<glm::dvec3, 3> corners = corners_of(geometry, number);
        for (glm::dvec3& corner : corners) corner = glm::dvec3(item.view_from_node * glm::dvec4(corner, 1));
        glm::dvec3 normal = face_of(corners).normal;
        if (item.mirrored) normal = -normal;
        if (!(glm::dot(normal, corners[0]) < 0)) continue;
        FacingTriangle triangle{corners, normal, number, glm::dvec2(kEverywhere), glm::dvec2(-kEverywhere)};
        for (const glm::dvec3& corner : corners) {
            triangle.low = glm::min(triangle.low, glm::dvec2(corner) / -corner.z);
            triangle.high = glm::max(triangle.high, glm::dvec2(corner) / -corner.z);
        }
        const auto behind_eye = [](const glm::dvec3& corner) { return !(corner.z < 0); };
        if (std::all_of(corners.begin(), corners.end(), behind_eye)) continue;
        if (std::any_of(corners.begin(), corners.end(), behind_eye)) {
            triangle.low = glm::dvec2(-kEverywhere);
            triangle.high = glm::dvec2(kEverywhere);
        }
        result.push_back(triangle);
    }
    return result;
}

Order order_of(std::span<const FacingTriangle> first, std::span<const FacingTriangle> second,
               double tolerance) {
    if (first.size() * second.size() > kMostCompared) return Order::unknown;
    Order result = Order::apart;
    for (const FacingTriangle& a : first)
        for (const FacingTriangle& b : second) {
            const Order order = order_of(a, b, tolerance);
            if (order == Order::apart || order == result) continue;
            if (result != Order::apart) return Order::unknown;
            result = order;
        }
    return result;
}

std::optional<std::vector<unsigned>> far_to_near(std::vector<FacingTriangle> triangles, double tolerance) {
    std::sort(triangles.begin(), triangles.end(), [](const FacingTriangle& a, const FacingTriangle& b) {
        return std::tie(a.low.x, a.number) < std::tie(b.low.x, b.number);
    });
    std::vector<std::vector<unsigned>> behind(triangles.size());
    std::size_t looked_at = 0;
    for (unsigned i = 0; i < triangles.size(); ++i)
        for (unsigned k = i + 1; k < triangles.size() && triangles[k].low.x < triangles[i].high.x; ++k) {
            if (++looked_at > 4 * kMostCompared) return std::nullopt;
            switch (order_of(triangles[i], triangles[k], tolerance)) {
                case Order::first_in_front:
                    behind[i].push_back(k);
                    break;
                case Order::second_in_front:
                    behind[k].push_back(i);
                    break;
                case Order::unknown:
                    return std::nullopt;
                case Order::apart:
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

}  // namespace vrut
