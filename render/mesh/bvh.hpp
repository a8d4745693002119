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

    /// No box may be empty or infinite. At most 2^32 - 1 boxes.
    explicit Bvh(std::span<const Box> boxes);

    /// Calls `meet(i)` for each box i with `lower_bound(box)` <= `farthest`; a bound of NaN excludes a box.
    /// `lower_bound` must be monotone: a box that contains another has no higher bound. Of two children the
    /// one of the lower bound is visited first. `meet` may lower `farthest`, which prunes the boxes beyond.
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

    /// Returns the memory of the hierarchy in bytes.
    std::size_t size_bytes() const {
        return nodes_.size() * sizeof(Node) + order_.size() * sizeof(order_[0]);
    }

private:
    struct Node {
        Box box;
        std::uint32_t first = 0;  ///< a leaf's first box in `order_`; else the first of its two children
        std::uint32_t count = 0;  ///< boxes of a leaf; 0 for an inner node
    };
    static constexpr std::size_t kMaxDepth = 32;  ///< the build halves counts below 2^32

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

extern template class Bvh<float>;
extern template class Bvh<double>;

/// The slab test of a ray and an axis-aligned box, in double. Source: Kay, Kajiya, "Ray Tracing Complex
/// Scenes", SIGGRAPH 1986.
class SlabRay {
public:
    /// The test widens boxes by `slack` along each axis. A slack of at least 1e-15 of the largest coordinate
    /// of boxes and origin makes the test conservative: rounding excludes no box.
    SlabRay(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& slack)
        : before_(origin - slack), after_(origin + slack) {
        // A finite reciprocal avoids 0 times infinity, which is NaN.
        for (int axis = 0; axis < 3; ++axis)
            inverse_[axis] = 1 / (std::abs(direction[axis]) < 1e-300 ? std::copysign(1e-300, direction[axis])
                                                                     : direction[axis]);
    }

    /// Returns the ray parameter at which the ray enters the box, in lengths of the direction: 0 if the
    /// origin lies inside. Returns NaN if the ray misses the box.
    double entry(const auto& box) const {
        const glm::dvec3 a = (glm::dvec3(box.min) - after_) * inverse_,
                         b = (glm::dvec3(box.max) - before_) * inverse_;
        const glm::dvec3 in = glm::min(a, b), out = glm::max(a, b);
        const double enters = std::max(std::max(in.x, in.y), std::max(in.z, 0.0));
        const double leaves = std::min(std::min(out.x, out.y), out.z);
        return enters <= leaves ? enters : std::numeric_limits<double>::quiet_NaN();
    }

private:
    glm::dvec3 before_, after_, inverse_{0};  ///< the origin minus and plus the slack
};

}  // namespace vrut::mesh
