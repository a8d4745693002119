#include "plan/backface_culling.hpp"

#include <algorithm>

namespace vrut::plan {

void find_facing(std::span<const mesh::TriangleCluster> clusters, std::size_t triangles,
                 const glm::dvec3& eye, std::vector<TriangleRange>& ranges) {
    ranges.clear();
    for (std::size_t i = 0; i < clusters.size(); ++i) {
        if (mesh::shows_backs(clusters[i], eye)) continue;
        const std::size_t first = i * mesh::kClusterTriangles;
        const std::size_t count = std::min(mesh::kClusterTriangles, triangles - first);
        if (!ranges.empty() && ranges.back().first + ranges.back().count == first)
            ranges.back().count += count;
        else
            ranges.push_back({first, count});
    }
}

}  // namespace vrut::plan
