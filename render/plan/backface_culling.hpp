#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/triangle_clusters.hpp"

namespace vrut::plan {

struct TriangleRange {
    std::size_t first, count;

    bool operator==(const TriangleRange&) const = default;
};

/// Replaces `ranges` by those of a geometry's triangles that may show their front to an eye, which is given
/// in the geometry's space. The clusters are those of all of its triangles.
void find_facing(std::span<const mesh::TriangleCluster> clusters, std::size_t triangles,
                 const glm::dvec3& eye, std::vector<TriangleRange>& ranges);

}  // namespace vrut::plan
