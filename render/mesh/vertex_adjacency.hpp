#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace vrut::mesh {

/// Which triangles meet in a vertex.
class VertexAdjacency {
public:
    VertexAdjacency(std::span<const glm::uvec3> triangles, std::size_t vertex_count);
    std::span<const unsigned> of(unsigned vertex) const {
        return std::span(triangles_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }

private:
    std::vector<unsigned> first_, triangles_;
};

}  // namespace vrut::mesh
