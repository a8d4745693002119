#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "math/bounds.hpp"

namespace vrut::reference {

/// A bounding volume hierarchy in double: which of many boxes a ray may meet. Own, for the libraries at hand
/// (Embree) work in single precision.
class RayBvh {
public:
    /// None of the boxes is empty or infinite.
    explicit RayBvh(std::span<const math::Bounds> boxes);

    /// Calls `meet` with the number of each box that the ray may enter up to `farthest`, which `meet` may
    /// lower to pass over what lies behind; roughly nearest first. Never misses a box for rounding.
    template <typename Meet>
    void visit(const glm::dvec3& origin, const glm::dvec3& direction, const double& farthest,
               const Meet& meet) const {
        if (nodes_.empty()) return;
        const SlabRay line(origin, direction);
        // One entry waits for each level of the tree, which halves its boxes at each: 2^32 at most.
        std::array<TraversalEntry, 64> waiting{};
        std::size_t count = 0;
        waiting[count++] = {0, line.entry(nodes_[0].box)};
        while (count > 0) {
            const TraversalEntry next = waiting[--count];
            if (!(next.entry <= farthest)) continue;
            const RayBvhNode& node = nodes_[next.node];
            for (std::uint32_t i = 0; i < node.count; ++i) meet(order_[node.first + i]);
            if (node.count > 0) continue;
            TraversalEntry near{node.first, line.entry(nodes_[node.first].box)};
            TraversalEntry far{node.first + 1, line.entry(nodes_[node.first + 1].box)};
            if (far.entry < near.entry) std::swap(near, far);
            if (far.entry <= farthest) waiting[count++] = far;
            if (near.entry <= farthest) waiting[count++] = near;
        }
    }

private:
    struct RayBvhNode {
        math::Bounds box;
        std::uint32_t first = 0;  ///< of a leaf: in `order_`; else of its two children
        std::uint32_t count = 0;  ///< 0: not a leaf
    };
    struct TraversalEntry {
        std::uint32_t node = 0;
        double entry = 0;
    };
    /// A part of a coordinate, far above what the test of a triangle rounds off.
    static constexpr double kSlack = 1e-14;

    class SlabRay {
    public:
        SlabRay(const glm::dvec3& origin, const glm::dvec3& direction);
        /// Distance at which a box is entered, not below 0; NaN, which no comparison holds for, where
        /// it is passed by.
        double entry(const math::Bounds& box) const {
            const glm::dvec3 a = (box.min - after_) * inverse_, b = (box.max - before_) * inverse_;
            const glm::dvec3 in = glm::min(a, b), out = glm::max(a, b);
            const double enters = std::max(std::max(in.x, in.y), std::max(in.z, 0.0));
            const double leaves = std::min(std::min(out.x, out.y), out.z);
            return enters <= leaves ? enters : std::numeric_limits<double>::quiet_NaN();
        }

    private:
        glm::dvec3 before_{0}, after_{0}, inverse_{0};  ///< the origin, less and plus its slack
    };

    void split(std::uint32_t node, std::span<const math::Bounds> boxes);
    math::Bounds bounds_of(std::uint32_t first, std::uint32_t count,
                           std::span<const math::Bounds> boxes) const;

    std::vector<RayBvhNode> nodes_;
    std::vector<std::uint32_t> order_;
};

}  // namespace vrut::reference
