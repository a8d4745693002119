#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// Of a part's radius: what lies closer together counts as touching.
inline constexpr double kNegligible = 1e-6;

/// An order in which the triangles can be drawn back to front from any eye, provided that back faces are
/// culled (Chen et al. 2012, "Depth-Presorted Triangle Lists"). With n triangles, number k is triangle k and
/// n + k its back face, if back faces are drawn too.
struct TriangleOrder {
    std::shared_ptr<const std::vector<unsigned>> back_to_front;  ///< null: as in the file
    /// Those among which no such order exists: which is in front depends on the eye.
    std::vector<std::vector<unsigned>> cycles;  ///< each one after the other in that order
};

/// Takes the square of the number of triangles; above kMaxOrderedTriangles they are one ring.
TriangleOrder order_triangles(const scene::Geometry& geometry, CullMode cull_mode);
inline constexpr std::size_t kMaxOrderedTriangles = 2048;

/// A triangle that faces the eye, in view space.
struct FrontFacingTriangle {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 normal;  ///< unit, to the eye
    unsigned number = 0;
    glm::dvec2 low{0}, high{0};  ///< around it on the plane z = -1; everywhere if it reaches behind the eye
};

/// Of an item's triangles those that face the eye and are not degenerate: of all, or of some numbers of a
/// TriangleOrder.
std::vector<FrontFacingTriangle> front_facing_triangles(const DrawItem& item,
                                                        const scene::Geometry& geometry);
std::vector<FrontFacingTriangle> front_facing_triangles(const DrawItem& item, const scene::Geometry& geometry,
                                                        std::span<const unsigned> numbers);

/// Which of two lies before the other, seen from the origin.
enum class DepthRelation { apart, first_in_front, second_in_front, unknown };

/// Returns which of two triangle sets is in front, seen from the origin. `unknown` if the sets interpenetrate
/// or are interleaved, or above kMaxComparedPairs pairs. `tolerance` is a distance.
DepthRelation depth_relation(std::span<const FrontFacingTriangle> first,
                             std::span<const FrontFacingTriangle> second, double tolerance);
inline constexpr std::size_t kMaxComparedPairs = std::size_t{1} << 18;

/// Numbers of triangles from far to near, seen from the origin; none where some cross or lie in a ring, or
/// where more than 4 kMaxComparedPairs pairs come into question.
std::optional<std::vector<unsigned>> back_to_front(std::vector<FrontFacingTriangle> triangles,
                                                   double tolerance);

}  // namespace vrut::plan
