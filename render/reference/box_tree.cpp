#include "reference/box_tree.hpp"

#include <numeric>

namespace vrut::reference {

namespace {

constexpr std::uint32_t kLeaf = 4;

double largest_of(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

RayBvh::SlabRay::SlabRay(const glm::dvec3& origin, const glm::dvec3& direction) {
    const double slack = kSlack * largest_of(origin);
    before_ = origin - slack;
    after_ = origin + slack;
    // Never infinite, so that nothing is 0 times infinity.
    for (int axis = 0; axis < 3; ++axis)
        inverse_[axis] = 1 / (std::abs(direction[axis]) < 1e-300 ? std::copysign(1e-300, direction[axis])
                                                                 : direction[axis]);
}

RayBvh::RayBvh(std::span<const math::Bounds> boxes) : order_(boxes.size()) {
    if (boxes.empty()) return;
    std::iota(order_.begin(), order_.end(), 0U);
    const auto count = static_cast<std::uint32_t>(boxes.size());
    nodes_.push_back({bounds_of(0, count, boxes), 0, count});
    // A node's children come after it.
    for (std::uint32_t node = 0; node < nodes_.size(); ++node)
        if (nodes_[node].count > kLeaf) split(node, boxes);
}

math::Bounds RayBvh::bounds_of(std::uint32_t first, std::uint32_t count,
                               std::span<const math::Bounds> boxes) const {
    math::Bounds box;
    for (std::uint32_t i = first; i < first + count; ++i) box.add(boxes[order_[i]]);
    const double slack = kSlack * std::max(largest_of(box.min), largest_of(box.max));
    return {box.min - slack, box.max + slack};
}

/// In halves, across the axis along which the boxes' centres are spread most.
void RayBvh::split(std::uint32_t node, std::span<const math::Bounds> boxes) {
    const std::uint32_t first = nodes_[node].first, count = nodes_[node].count, half = count / 2;
    math::Bounds centers;
    for (std::uint32_t i = first; i < first + count; ++i) centers.add(boxes[order_[i]].center());
    const glm::dvec3 spread = centers.max - centers.min;
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
        return boxes[a].min[axis] + boxes[a].max[axis] < boxes[b].min[axis] + boxes[b].max[axis];
    });
    nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].count = 0;
    nodes_.push_back({bounds_of(first, half, boxes), first, half});
    nodes_.push_back({bounds_of(first + half, count - half, boxes), first + half, count - half});
}

}  // namespace vrut::reference
