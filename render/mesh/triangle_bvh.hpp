#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace vrut::mesh {

/// A triangle and its squared distance from a point.
struct ClosestTriangle {
    unsigned number = 0;
    float squared = 0;
};

/// Squared distance of a point from a triangle.
float squared_distance(const glm::vec3& point, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// A bounding volume hierarchy that finds the triangle nearest to a point.
class ClosestTriangleBvh {
public:
    /// Both must outlive it; there is at least one triangle.
    ClosestTriangleBvh(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);

    /// The nearest triangle to a point, or the first found that is no further than `enough` (squared);
    /// `known` is one to start from.
    ClosestTriangle nearest(const glm::vec3& point, ClosestTriangle known, float enough) const;

private:
    struct ClosestTriangleBvhNode {
        glm::vec3 low{0}, high{0};
        std::uint32_t first = 0;  ///< of a leaf: in `order_`; else of its two children
        std::uint32_t count = 0;  ///< 0: not a leaf
    };
    struct TriangleBox {
        glm::vec3 low, high;
    };
    ClosestTriangleBvhNode leaf(std::uint32_t first, std::uint32_t count,
                                std::span<const TriangleBox> boxes) const;
    void split(std::uint32_t node, std::span<const TriangleBox> boxes);

    std::span<const glm::vec3> positions_;
    std::span<const glm::uvec3> triangles_;
    std::vector<ClosestTriangleBvhNode> nodes_;
    std::vector<std::uint32_t> order_;
};

}  // namespace vrut::mesh
