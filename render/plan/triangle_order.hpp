#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// Fraction of an item's radius below which distances count as contact.
inline constexpr double kNegligible = 1e-6;

/// An order in which the triangles can be drawn back to front from any eye, provided that back faces are
/// culled (Chen et al. 2012, "Depth-Presorted Triangle Lists"). With n triangles, number k is triangle k and
/// n + k its back face, if back faces are drawn too.
struct TriangleOrder {
    std::shared_ptr<const std::vector<unsigned>> back_to_front;  ///< null: as in the file
    /// Groups of triangles without such an order: which one is in front depends on the eye.
    std::vector<std::vector<unsigned>> cycles;  ///< each one after the other in that order
};

/// Quadratic in the number of triangles; above kMaxOrderedTriangles they form a single cycle.
TriangleOrder order_triangles(const scene::Geometry& geometry, CullMode cull_mode);
inline constexpr std::size_t kMaxOrderedTriangles = 2048;

/// A front-facing triangle, in view space.
struct FrontFacingTriangle {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 normal;  ///< unit, to the eye
    unsigned number = 0;
    glm::dvec2 low{0}, high{0};  ///< around it on the plane z = -1; everywhere if it reaches behind the eye
};

/// Returns the front-facing, non-degenerate triangles of an item, from left to right (low.x).
std::vector<FrontFacingTriangle> front_facing_triangles(const DrawItem& item,
                                                        const scene::Geometry& geometry);

/// Which of two is in front, seen from the origin.
enum class DepthRelation { apart, first_in_front, second_in_front, unknown };

/// Returns which of two triangle sets is in front, seen from the origin. Both are sorted from left to right.
/// `unknown` if the sets interpenetrate or are interleaved, or above kMaxComparedPairs pairs. `tolerance` is
/// a distance.
DepthRelation depth_relation(std::span<const FrontFacingTriangle> first,
                             std::span<const FrontFacingTriangle> second, double tolerance);
inline constexpr std::size_t kMaxComparedPairs = std::size_t{1} << 18;

/// Returns the numbers of the triangles back to front, seen from the origin. They are sorted from left to
/// right. None if some intersect or form a cycle, or if more than 4 kMaxComparedPairs pairs would have to be
/// compared.
std::optional<std::vector<unsigned>> back_to_front(std::span<const FrontFacingTriangle> triangles,
                                                   double tolerance);

}  // namespace vrut::plan
