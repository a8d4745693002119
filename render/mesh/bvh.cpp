#include "mesh/bvh.hpp"

#include <numeric>

namespace vrut::mesh {

namespace {

constexpr std::uint32_t kMaxLeaf = 8;

}  // namespace

template <typename T>
Bvh<T>::Bvh(std::span<const Box> boxes) : order_(boxes.size()) {
    if (boxes.empty()) return;
    std::iota(order_.begin(), order_.end(), 0U);
    const auto leaf = [&](std::uint32_t first, std::uint32_t count) {
        Node node{{}, first, count};
        for (std::uint32_t i = first; i < first + count; ++i) node.box.add(boxes[order_[i]]);
        return node;
    };
    nodes_.push_back(leaf(0, static_cast<std::uint32_t>(boxes.size())));
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
        const auto [box, first, count] = nodes_[node];
        if (count <= kMaxLeaf) continue;
        const glm::vec<3, T> size = box.max - box.min;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::uint32_t half = count / 2;
        const auto begin = order_.begin() + first;
        std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
            return boxes[a].min[axis] + boxes[a].max[axis] < boxes[b].min[axis] + boxes[b].max[axis];
        });
        nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
        nodes_[node].count = 0;
        nodes_.push_back(leaf(first, half));
        nodes_.push_back(leaf(first + half, count - half));
    }
    nodes_ = std::vector<Node>(nodes_.begin(), nodes_.end());  // no room to spare; reports a lack of memory
}

template class Bvh<float>;
template class Bvh<double>;

}  // namespace vrut::mesh
