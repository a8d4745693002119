#pragma once

#include <atomic>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "mesh/bvh.hpp"
#include "mesh/vertex_adjacency.hpp"

namespace vrut::mesh {

/// Measures the distance between the original and the simplified surface after each round of edge collapses,
/// at all vertices and, where those are sparse, at edge midpoints and triangle centroids of the original, and
/// at edge midpoints of the new surface. Large meshes are subsampled.
class SurfaceDeviation {
public:
    /// All must outlive it. No two positions are equal. `least` is what does not matter.
    SurfaceDeviation(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, float least,
                     const std::atomic<bool>& stop);

    /// Measures the surface with triangles `after`, made from that of the previous call with triangles
    /// `before`. Returns the largest distance so far; none if a component has vanished or `stop` is set.
    std::optional<float> measure(std::span<const glm::uvec3> before, std::span<const glm::uvec3> after);

    /// Of the newest surface, a triangle that lies as near to a point of one of the first surface's triangles
    /// as any around where its corners are now.
    unsigned closest_triangle(const glm::vec3& point, const glm::uvec3& triangle) const;

private:
    struct SampledEdge {
        unsigned from, to;
    };
    struct MeasuredSurface {
        std::span<const glm::uvec3> triangles;
        VertexAdjacency adjacency;
        std::optional<Bvh<float>> tree{};  // made when it is first needed
    };
    static bool has_edge(const MeasuredSurface& surface, unsigned from, unsigned to);
    bool move_anchors(std::span<const glm::uvec3> before, std::span<const glm::uvec3> after);
    void include(const glm::vec3& point, unsigned& anchor, MeasuredSurface& surface);

    std::span<const glm::vec3> positions_;
    const std::atomic<bool>& stop_;
    MeasuredSurface original_;
    std::optional<MeasuredSurface> newest_;
    std::vector<SampledEdge> edges_;  // each once
    std::vector<unsigned> anchors_;   // for each position one of the newest surface, near it
    float squared_;
};

}  // namespace vrut::mesh
