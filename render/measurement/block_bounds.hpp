#pragma once

#include <span>
#include <vector>

#include "math/bounds.hpp"

namespace vrut::measurement {

inline bool overlap(const math::Bounds& a, const math::Bounds& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
}

/// Finds boxes that overlap with another, by the boxes around each 64 that lie side by side.
class BlockBounds {
public:
    BlockBounds() = default;
    explicit BlockBounds(std::span<const math::Bounds> boxes);

    /// Visits all items whose boxes may overlap with this one, in no order.
    template <typename Visit>
    void visit(const math::Bounds& box, const Visit& visit_item) const {
        for (std::size_t block = 0; block < blocks_.size(); ++block)
            if (overlap(blocks_[block], box))
                for (const unsigned item : items_of(block)) visit_item(item);
    }

private:
    static constexpr std::size_t kBlock = 64;

    std::span<const unsigned> items_of(std::size_t block) const;

    std::vector<unsigned> order_;  // items by the cell of a grid, along a space-filling curve
    std::vector<math::Bounds> blocks_;
};

}  // namespace vrut::measurement
