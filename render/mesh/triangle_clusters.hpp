#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace vrut::mesh {

/// Consecutive triangles of a geometry, in its space, that are culled together.
struct TriangleCluster {
    glm::dvec3 center{0};  ///< of a sphere around them
    double radius = 0;
    glm::vec3 axis{0};  ///< unit; the middle of the directions to which their fronts face
    float sine = 1;  ///< of the largest angle between the axis and such a direction; 1: they face all around
};
inline constexpr std::size_t kClusterTriangles = 64;  ///< the last cluster of a geometry may have fewer

/// Returns the clusters in the order of the triangles; none if there is no place from which one could be
/// culled.
std::vector<TriangleCluster> triangle_clusters(const scene::Geometry& geometry);

/// Returns true if all triangles show their backs to an eye, by more than the rounding of their corners in an
/// image. The test is that of meshoptimizer's meshopt_computeClusterBounds().
bool shows_backs(const TriangleCluster& cluster, const glm::dvec3& eye);

}  // namespace vrut::mesh
