#include "mesh/triangle_clusters.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "math/bounds.hpp"

namespace vrut::mesh {

namespace {

constexpr double kLeastTurn = 1e-3;  ///< radians by which a triangle that is culled faces away

/// In coordinates of about 1, so that float neither overflows nor underflows where areas are squared.
TriangleCluster cluster_of(std::span<const glm::uvec3> triangles, const scene::Geometry& geometry) {
    math::Bounds bounds;
    for (const glm::uvec3& triangle : triangles)
        for (int corner = 0; corner < 3; ++corner) bounds.add(geometry.positions[triangle[corner]]);
    TriangleCluster cluster;
    cluster.center = bounds.center();
    const double size = bounds.radius();
    if (!(size > 0)) return cluster;
    std::vector<glm::vec3> positions;
    positions.reserve(3 * triangles.size());
    for (const glm::uvec3& triangle : triangles)
        for (int corner = 0; corner < 3; ++corner)
            positions.emplace_back((geometry.positions[triangle[corner]] - bounds.center()) / size);
    std::vector<unsigned> indices(positions.size());
    std::iota(indices.begin(), indices.end(), 0U);
    const meshopt_Bounds found = meshopt_computeClusterBounds(indices.data(), indices.size(), &positions[0].x,
                                                              positions.size(), sizeof(glm::vec3));
    if (!(found.radius > 0)) return cluster;  // no triangle has an area
    cluster.center += size * glm::dvec3(found.center[0], found.center[1], found.center[2]);
    cluster.radius = size * double{found.radius};
    cluster.axis = {found.cone_axis[0], found.cone_axis[1], found.cone_axis[2]};
    cluster.sine = found.cone_cutoff;
    return cluster;
}

}  // namespace

std::vector<TriangleCluster> triangle_clusters(const scene::Geometry& geometry) {
    std::vector<TriangleCluster> clusters;
    const std::span<const glm::uvec3> triangles(geometry.triangles);
    clusters.reserve((triangles.size() + kClusterTriangles - 1) / kClusterTriangles);
    for (std::size_t first = 0; first < triangles.size(); first += kClusterTriangles)
        clusters.push_back(cluster_of(
            triangles.subspan(first, std::min(kClusterTriangles, triangles.size() - first)), geometry));
    const auto faces_all_around = [](const TriangleCluster& cluster) { return cluster.sine >= 1; };
    if (std::ranges::all_of(clusters, faces_all_around)) clusters.clear();
    return clusters;
}

bool shows_backs(const TriangleCluster& cluster, const glm::dvec3& eye) {
    const glm::dvec3 away = cluster.center - eye;
    const double least = double{cluster.sine} + kLeastTurn;
    return glm::dot(away, glm::dvec3(cluster.axis)) > least * glm::length(away) + cluster.radius;
}

}  // namespace vrut::mesh
