#include "measurement/block_bounds.hpp"

#include <algorithm>

namespace vrut::measurement {

namespace {

constexpr unsigned kBits = 5;
constexpr unsigned kCells = 1U << (3 * kBits);

glm::dvec3 center_of(const math::Bounds& box) { return box.min * 0.5 + box.max * 0.5; }

/// Morton's order of the cells of a grid (1966).
unsigned cell_of(const glm::dvec3& center, const math::Bounds& all) {
    constexpr double kSteps = 1U << kBits;
    unsigned cell = 0;
    for (int k = 0; k < 3; ++k) {
        const double half = all.max[k] * 0.5 - all.min[k] * 0.5;
        const double part = half > 0 ? (center[k] * 0.5 - all.min[k] * 0.5) / half : 0;
        const auto step = static_cast<unsigned>(std::clamp(part * kSteps, 0.0, kSteps - 1));
        for (unsigned bit = 0; bit < kBits; ++bit)
            cell |= (step >> bit & 1U) << (3 * bit + static_cast<unsigned>(k));
    }
    return cell;
}

}  // namespace

BlockBounds::BlockBounds(std::span<const math::Bounds> boxes)
    : order_(boxes.size()), blocks_((boxes.size() + kBlock - 1) / kBlock) {
    math::Bounds all;
    for (const math::Bounds& box : boxes) all.add(box);
    std::vector<unsigned> cells;
    cells.reserve(boxes.size());
    std::vector<std::size_t> first(kCells + 1);
    for (const math::Bounds& box : boxes) {
        cells.push_back(cell_of(center_of(box), all));
        ++first[cells.back() + 1];
    }
    for (std::size_t cell = 1; cell <= kCells; ++cell) first[cell] += first[cell - 1];
    for (unsigned item = 0; item < boxes.size(); ++item) {
        const std::size_t place = first[cells[item]]++;
        order_[place] = item;
        blocks_[place / kBlock].add(boxes[item]);
    }
}

std::span<const unsigned> BlockBounds::items_of(std::size_t block) const {
    const std::size_t first = block * kBlock;
    return std::span(order_).subspan(first, std::min(kBlock, order_.size() - first));
}

}  // namespace vrut::measurement
