#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace vrut::mesh {

/// A bounding volume hierarchy over boxes of scalar T. The build is O(n log n): each node is split in two
/// halves of equal counts, at the median of the centres along the longest side of its box (Pharr, Jakob,
/// Humphreys, "Physically Based Rendering", 4th ed., 7.3.1).
template <typename T>
class Bvh {
public:
    struct Box {
        glm::vec<3, T> min{std::numeric_limits<T>::infinity()}, max{-std::numeric_limits<T>::infinity()};

        void add(const Box& other) {
            min = glm::min(min, other.min);
            max = glm::max(max, other.max);
        }
    };

    /// No box is empty or infinite; at most 2^32 - 1.
    explicit Bvh(std::span<const Box> boxes);

    /// Calls `meet(i)` for each box i of which `lower_bound(box)` is at most `farthest`; a NaN excludes a
    /// box. Of a box that contains another the bound is not above the other's. Boxes of low bounds come
    /// first, roughly. `meet` may lower `farthest`, which excludes what lies behind it.
    template <typename LowerBound, typename Meet>
    void visit(const LowerBound& lower_bound, const auto& farthest, const Meet& meet) const {
        if (nodes_.empty()) return;
        using Bound = decltype(lower_bound(nodes_[0].box));
        struct Entry {
            std::uint32_t node = 0;
            Bound bound = 0;
        };
        std::array<Entry, kMaxDepth> waiting{};  // at most one for each level
        std::size_t count = 0;
        waiting[count++] = {0, lower_bound(nodes_[0].box)};
        while (count > 0) {
            const Entry next = waiting[--count];
            if (!(next.bound <= farthest)) continue;
            const Node& node = nodes_[next.node];
            for (std::uint32_t i = 0; i < node.count; ++i) meet(order_[node.first + i]);
            if (node.count > 0) continue;
            Entry near{node.first, lower_bound(nodes_[node.first].box)};
            Entry far{node.first + 1, lower_bound(nodes_[node.first + 1].box)};
            if (far.bound <= near.bound) std::swap(near, far);
            if (far.bound <= farthest) waiting[count++] = far;
            if (near.bound <= farthest) waiting[count++] = near;
        }
    }

    /// Memory, in bytes.
    std::size_t size_bytes() const {
        return nodes_.size() * sizeof(Node) + order_.size() * sizeof(order_[0]);
    }

private:
    struct Node {
        Box box;
        std::uint32_t first = 0;  ///< of a leaf: in `order_`; else of its two children, which come after it
        std::uint32_t count = 0;  ///< 0: not a leaf
    };
    static constexpr std::size_t kMaxDepth = 32;  ///< each level halves the counts

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

extern template class Bvh<float>;
extern template class Bvh<double>;

/// The slab test of a ray and axis-aligned boxes, in double (Kay, Kajiya, "Ray Tracing Complex Scenes",
/// SIGGRAPH 1986).
class SlabRay {
public:
    /// Along each axis boxes grow by `slack`; at least 1e-15 of the coordinates of boxes and origin, it
    /// covers what the test rounds off.
    SlabRay(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& slack)
        : before_(origin - slack), after_(origin + slack) {
        // Never infinite, so that nothing is 0 times infinity.
        for (int axis = 0; axis < 3; ++axis)
            inverse_[axis] = 1 / (std::abs(direction[axis]) < 1e-300 ? std::copysign(1e-300, direction[axis])
                                                                     : direction[axis]);
    }

    /// Parameter at which the ray enters a box, in lengths of the direction, not below 0; NaN where it misses
    /// the box.
    double entry(const auto& box) const {
        const glm::dvec3 a = (glm::dvec3(box.min) - after_) * inverse_,
                         b = (glm::dvec3(box.max) - before_) * inverse_;
        const glm::dvec3 in = glm::min(a, b), out = glm::max(a, b);
        const double enters = std::max(std::max(in.x, in.y), std::max(in.z, 0.0));
        const double leaves = std::min(std::min(out.x, out.y), out.z);
        return enters <= leaves ? enters : std::numeric_limits<double>::quiet_NaN();
    }

private:
    glm::dvec3 before_, after_, inverse_{0};  ///< the origin, less and plus the slack
};

}  // namespace vrut::mesh
