#pragma once

#include <atomic>
#include <vector>

#include "scene/scene.hpp"

namespace vrut::mesh {

/// A geometry's surface with fewer triangles, between some of its vertices; or with its own in another order.
struct DetailLevel {
    int number = 0;  ///< from 1; 0 is the geometry itself, reordered
    /// How far the two surfaces lie apart at most, and their normals make them look apart but for a
    /// twentieth of their area; in the geometry's unit.
    double error = 0;
    std::vector<glm::uvec3> triangles;  ///< of the geometry's positions
};

/// Returns levels of detail, each with about half the triangles of the one before; none where simplification
/// gains nothing. Edges are collapsed by quadric error (Garland and Heckbert 1997, meshoptimizer); the error
/// of positions and normals is then measured (SurfaceDeviation, NormalDeviation). Vertices of equal position
/// stay together, whatever their normals and texture coordinates. Returns what it has soon after `stop` is
/// set.
std::vector<DetailLevel> simplify(const scene::Geometry& geometry, const std::atomic<bool>& stop);

/// The level as a geometry of its own, with the same bounds, without the vertices that it does not use.
scene::Geometry geometry_of(const scene::Geometry& geometry, const DetailLevel& level);

}  // namespace vrut::mesh
