#include "mesh/vertex_adjacency.hpp"

#include <numeric>

namespace vrut::mesh {

VertexAdjacency::VertexAdjacency(std::span<const glm::uvec3> triangles, std::size_t vertex_count)
    : first_(vertex_count + 1), triangles_(triangles.size() * 3) {
    for (const glm::uvec3& triangle : triangles)
        for (int k = 0; k < 3; ++k) ++first_[triangle[k]];
    std::inclusive_scan(first_.begin(), first_.end(), first_.begin());
    for (std::size_t i = triangles.size(); i-- > 0;)
        for (int k = 0; k < 3; ++k) triangles_[--first_[triangles[i][k]]] = static_cast<unsigned>(i);
}

}  // namespace vrut::mesh
