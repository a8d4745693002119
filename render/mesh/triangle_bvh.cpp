#include "mesh/triangle_bvh.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace vrut::mesh {

namespace {

constexpr std::uint32_t kLeaf = 8;

float squared(const glm::vec3& v) { return glm::dot(v, v); }

}  // namespace

/// Ericson 2004, "Real-Time Collision Detection", 5.1.5.
float squared_distance(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 ab = b - a, ac = c - a, ap = p - a;
    const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return squared(ap);
    const glm::vec3 bp = p - b;
    const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return squared(bp);
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return squared(ap - ab * (d1 > d3 ? d1 / (d1 - d3) : 0));
    const glm::vec3 cp = p - c;
    const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return squared(cp);
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return squared(ap - ac * (d2 > d6 ? d2 / (d2 - d6) : 0));
    const float va = d3 * d6 - d5 * d4, along_b = d4 - d3, along_c = d5 - d6;
    if (va <= 0 && along_b >= 0 && along_c >= 0)
        return squared(bp - (c - b) * (along_b + along_c > 0 ? along_b / (along_b + along_c) : 0));
    const float sum = va + vb + vc;
    if (!(sum > 0)) return std::min({squared(ap), squared(bp), squared(cp)});
    return squared(ap - ab * (vb / sum) - ac * (vc / sum));
}

ClosestTriangleBvh::ClosestTriangleBvh(std::span<const glm::vec3> positions,
                                       std::span<const glm::uvec3> triangles)
    : positions_(positions), triangles_(triangles), order_(triangles.size()) {
    std::vector<TriangleBox> boxes;
    boxes.reserve(triangles.size());
    for (const glm::uvec3& t : triangles) {
        const glm::vec3 &a = positions[t.x], &b = positions[t.y], &c = positions[t.z];
        boxes.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
    }
    std::iota(order_.begin(), order_.end(), 0U);
    nodes_.push_back(leaf(0, static_cast<std::uint32_t>(triangles.size()), boxes));
    // A node's children come after it.
    for (std::uint32_t node = 0; node < nodes_.size(); ++node)
        if (nodes_[node].count > kLeaf) split(node, boxes);
}

ClosestTriangleBvh::ClosestTriangleBvhNode ClosestTriangleBvh::leaf(
    std::uint32_t first, std::uint32_t count, std::span<const TriangleBox> boxes) const {
    ClosestTriangleBvhNode node{boxes[order_[first]].low, boxes[order_[first]].high, first, count};
    for (std::uint32_t i = first; i < first + count; ++i) {
        node.low = glm::min(node.low, boxes[order_[i]].low);
        node.high = glm::max(node.high, boxes[order_[i]].high);
    }
    return node;
}

/// In halves, across the longest side of its box.
void ClosestTriangleBvh::split(std::uint32_t node, std::span<const TriangleBox> boxes) {
    const std::uint32_t first = nodes_[node].first, count = nodes_[node].count, half = count / 2;
    const glm::vec3 size = nodes_[node].high - nodes_[node].low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
        return boxes[a].low[axis] + boxes[a].high[axis] < boxes[b].low[axis] + boxes[b].high[axis];
    });
    nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].count = 0;
    nodes_.push_back(leaf(first, half, boxes));
    nodes_.push_back(leaf(first + half, count - half, boxes));
}

ClosestTriangle ClosestTriangleBvh::nearest(const glm::vec3& point, ClosestTriangle known,
                                            float enough) const {
    struct QueuedNode {
        std::uint32_t node = 0;
        float squared = 0;
    };
    const auto waiting_for = [&](std::uint32_t node) {
        const glm::vec3 inside = glm::clamp(point, nodes_[node].low, nodes_[node].high);
        return QueuedNode{node, squared(point - inside)};
    };
    // One entry waits for each level of the tree, which halves its triangles at each: 2^32 at most.
    std::array<QueuedNode, 64> waiting{};
    std::size_t count = 0;
    waiting[count++] = waiting_for(0);
    while (count > 0 && known.squared > enough) {
        const QueuedNode next = waiting[--count];
        if (next.squared >= known.squared) continue;
        const ClosestTriangleBvhNode& node = nodes_[next.node];
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const glm::uvec3& t = triangles_[order_[i]];
            const float here = squared_distance(point, positions_[t.x], positions_[t.y], positions_[t.z]);
            if (here < known.squared) known = {order_[i], here};
        }
        if (node.count > 0) continue;
        const QueuedNode a = waiting_for(node.first), b = waiting_for(node.first + 1);
        waiting[count++] = a.squared < b.squared ? b : a;
        waiting[count++] = a.squared < b.squared ? a : b;
    }
    return known;
}

}  // namespace vrut::mesh
