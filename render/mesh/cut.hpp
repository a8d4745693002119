#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/clip_plane.hpp"

namespace vrut::mesh {

/// Where a plane cuts a geometry, in the geometry's space.
struct Cut {
    std::vector<glm::dvec3> points;
    /// Lines between points, where the plane crosses triangles. Seen from beyond the plane, from the side
    /// that is cut away, they lead counter-clockwise around solids.
    std::vector<glm::uvec2> contours;
    /// Of the cap, counter-clockwise seen from beyond the plane.
    std::vector<glm::uvec3> triangles;
    std::vector<glm::uvec2> hatching;  ///< lines between points
};

/// Returns the contours, and with `cap` the triangles between those that close. `equation` is the plane in
/// the geometry's space, of any length, as scene::clip_equation() returns it: points where the dot product
/// with (point, 1) is positive are kept. Corners on the plane count as cut away, and corners of equal
/// position are one: the contours of a watertight geometry (is_watertight()) close. Triangles with a corner
/// that is not finite, or beyond 10¹⁵⁰, have no lines. Empty where the equation is not a plane's. Solids that
/// overlap have caps that do; where one reaches into a hole of another, triangles may cross its contour.
Cut cut_of(const scene::Geometry& geometry, const glm::dvec4& equation, bool cap);

/// Lines that hatching may have; beyond it their spacing doubles until it has fewer.
inline constexpr int kMostHatchingLines = 4096;
/// The same for their crossings of contours, about: each contour line may have one more.
inline constexpr int kMostHatchingCrossings = 65536;

/// Adds hatching to a cut that has a cap: parallel lines within its contours, at 45 degrees to axes that
/// depend on the plane's normal only, or at -45 degrees with `other_way`. `plane` and `spacing` are in world
/// space, where the lines lie at multiples of the spacing from the origin: neighbouring parts continue each
/// other's. Adds nothing where the spacing or the matrix is not finite, or the spacing is not positive.
void add_hatching(Cut& cut, const glm::dmat4& world_from_node, const scene::ClipPlane& plane, double spacing,
                  bool other_way);

}  // namespace vrut::mesh
