#pragma once

#include <algorithm>
#include <vector>

#include "math/bounds.hpp"

namespace vrut::measurement {

inline bool overlap(const math::Bounds& a, const math::Bounds& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
}

/// Boxes around items, 64 to a box in their order: neighbours in a file are mostly neighbours in space.
class BlockBounds {
public:
    /// `add(item, bounds)` adds an item to a box.
    template <typename Add>
    void build(std::size_t count, const Add& add) {
        count_ = count;
        boxes_.assign((count + kBlock - 1) / kBlock, {});
        for (std::size_t item = 0; item < count; ++item) add(item, boxes_[item / kBlock]);
    }
    /// Visits the items of all boxes that overlap with this one.
    template <typename Visit>
    void visit(const math::Bounds& box, const Visit& visit_item) const {
        for (std::size_t block = 0; block < boxes_.size(); ++block) {
            if (!overlap(boxes_[block], box)) continue;
            const std::size_t end = std::min(count_, (block + 1) * kBlock);
            for (std::size_t item = block * kBlock; item < end; ++item) visit_item(item);
        }
    }

private:
    static constexpr std::size_t kBlock = 64;

    std::size_t count_ = 0;
    std::vector<math::Bounds> boxes_;
};

}  // namespace vrut::measurement
