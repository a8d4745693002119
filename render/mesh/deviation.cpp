#include "mesh/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace vrut::mesh {

namespace {

/// Up to so many their middles count: where there are more, vertices lie close together.
constexpr std::size_t kFewTriangles = 10000;
/// Where there are more, and so many for each new one, the vertices tell enough, and edges do not count.
constexpr std::size_t kDense = 8;

/// Of a surface with more edges only about so many are asked, spread evenly.
constexpr std::size_t kEdges = 20000;

constexpr unsigned kNowhere = std::numeric_limits<unsigned>::max();

float squared_length(const glm::vec3& v) { return glm::dot(v, v); }

/// Squared distance of a point from a triangle. Ericson 2004, "Real-Time Collision Detection", 5.1.5.
float squared_distance(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 ab = b - a, ac = c - a, ap = p - a;
    const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return squared_length(ap);
    const glm::vec3 bp = p - b;
    const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return squared_length(bp);
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return squared_length(ap - ab * (d1 > d3 ? d1 / (d1 - d3) : 0));
    const glm::vec3 cp = p - c;
    const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return squared_length(cp);
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return squared_length(ap - ac * (d2 > d6 ? d2 / (d2 - d6) : 0));
    const float va = d3 * d6 - d5 * d4, along_b = d4 - d3, along_c = d5 - d6;
    if (va <= 0 && along_b >= 0 && along_c >= 0)
        return squared_length(bp - (c - b) * (along_b + along_c > 0 ? along_b / (along_b + along_c) : 0));
    const float sum = va + vb + vc;
    if (!(sum > 0)) return std::min({squared_length(ap), squared_length(bp), squared_length(cp)});
    return squared_length(ap - ab * (vb / sum) - ac * (vc / sum));
}

/// A triangle and its squared distance from a point.
struct ClosestTriangle {
    unsigned number = 0;
    float squared = std::numeric_limits<float>::infinity();
};

Bvh<float> tree_of(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
    std::vector<Bvh<float>::Box> boxes;
    boxes.reserve(triangles.size());
    for (const glm::uvec3& t : triangles) {
        const glm::vec3 &a = positions[t.x], &b = positions[t.y], &c = positions[t.z];
        boxes.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
    }
    return Bvh<float>(boxes);
}

}  // namespace

SurfaceDeviation::SurfaceDeviation(std::span<const glm::vec3> positions,
                                   std::span<const glm::uvec3> triangles, float least,
                                   const std::atomic<bool>& stop)
    : positions_(positions),
      stop_(stop),
      original_{triangles, {triangles, positions.size()}},
      anchors_(positions.size()),
      squared_(least * least) {
    std::iota(anchors_.begin(), anchors_.end(), 0U);
    const std::size_t step = 1 + triangles.size() * 3 / 2 / kEdges;
    for (std::size_t i = 0; i < triangles.size(); i += step)
        for (int k = 0; k < 3; ++k) {
            const unsigned from = triangles[i][k], to = triangles[i][(k + 1) % 3];
            if (from < to || !has_edge(original_, to, from)) edges_.push_back({from, to});
        }
}

/// Returns true if a triangle runs from one vertex to the other.
bool SurfaceDeviation::has_edge(const MeasuredSurface& surface, unsigned from, unsigned to) {
    return std::ranges::any_of(surface.adjacency.of(from), [&](unsigned number) {
        const glm::uvec3& t = surface.triangles[number];
        return (t.x == from && t.y == to) || (t.y == from && t.z == to) || (t.z == from && t.x == to);
    });
}

/// Vertices that are gone hand on those that they stood for to the nearest neighbour that is left; false
/// where one has no such neighbour, however far.
bool SurfaceDeviation::move_anchors(std::span<const glm::uvec3> before, std::span<const glm::uvec3> after) {
    std::vector<unsigned> next(positions_.size(), kNowhere);
    for (const glm::uvec3& triangle : after)
        for (int k = 0; k < 3; ++k) next[triangle[k]] = triangle[k];
    struct Reassignment {
        unsigned vertex, anchor;
    };
    const auto is_missing = [&](const glm::uvec3& t) {
        return next[t.x] == kNowhere || next[t.y] == kNowhere || next[t.z] == kNowhere;
    };
    std::vector<glm::uvec3> missing;
    std::ranges::copy_if(before, std::back_inserter(missing), is_missing);
    while (!missing.empty()) {
        std::vector<Reassignment> reassignments;
        for (const glm::uvec3& triangle : missing)
            for (int k = 0; k < 3; ++k)
                for (const int other : {(k + 1) % 3, (k + 2) % 3})
                    if (next[triangle[k]] == kNowhere && next[triangle[other]] != kNowhere)
                        reassignments.push_back({triangle[k], next[triangle[other]]});
        if (reassignments.empty()) return false;
        for (const auto& [vertex, anchor] : reassignments)
            if (next[vertex] == kNowhere || squared_length(positions_[anchor] - positions_[vertex]) <
                                                squared_length(positions_[next[vertex]] - positions_[vertex]))
                next[vertex] = anchor;
        std::erase_if(missing, [&](const glm::uvec3& t) { return !is_missing(t); });
    }
    for (unsigned& anchor : anchors_)
        if (next[anchor] != kNowhere) anchor = next[anchor];
    return true;
}

/// Around the anchor first, where most points find what is near enough; `anchor` moves to where they found
/// it.
void SurfaceDeviation::include(const glm::vec3& point, unsigned& anchor, MeasuredSurface& surface) {
    if (stop_.load(std::memory_order_relaxed)) return;
    ClosestTriangle found;
    for (const unsigned number : surface.adjacency.of(anchor)) {
        const glm::uvec3& t = surface.triangles[number];
        const float here = squared_distance(point, positions_[t.x], positions_[t.y], positions_[t.z]);
        if (here < found.squared) found = {number, here};
        if (here <= squared_) return;
    }
    if (!surface.tree) surface.tree = tree_of(positions_, surface.triangles);
    float farthest = found.squared;
    surface.tree->visit(
        [&](const Bvh<float>::Box& box) {
            return squared_length(point - glm::clamp(point, box.min, box.max));
        },
        farthest,
        [&](std::uint32_t number) {
            const glm::uvec3& t = surface.triangles[number];
            const float here = squared_distance(point, positions_[t.x], positions_[t.y], positions_[t.z]);
            if (here < found.squared) found = {number, here};
            farthest = found.squared <= squared_ ? -1 : found.squared;  // near enough: the search ends
        });
    squared_ = std::max(squared_, found.squared);
    const glm::uvec3& t = surface.triangles[found.number];
    anchor = t.x;
    for (const unsigned corner : {t.y, t.z})
        if (squared_length(positions_[corner] - point) < squared_length(positions_[anchor] - point))
            anchor = corner;
}

unsigned SurfaceDeviation::closest_triangle(const glm::vec3& point, const glm::uvec3& triangle) const {
    ClosestTriangle found;
    const glm::uvec3 now(anchors_[triangle.x], anchors_[triangle.y], anchors_[triangle.z]);
    for (int k = 0; k < 3; ++k) {
        if (k > 0 && (now[k] == now[0] || now[k] == now[k - 1])) continue;
        for (const unsigned number : newest_->adjacency.of(now[k])) {
            const glm::uvec3& t = newest_->triangles[number];
            const float here = squared_distance(point, positions_[t.x], positions_[t.y], positions_[t.z]);
            if (here < found.squared) found = {number, here};
        }
    }
    return found.number;
}

std::optional<float> SurfaceDeviation::measure(std::span<const glm::uvec3> before,
                                               std::span<const glm::uvec3> after) {
    if (!move_anchors(before, after)) return {};
    MeasuredSurface& surface = newest_.emplace(MeasuredSurface{after, {after, positions_.size()}});
    // Some from everywhere come first: the further one has been found, the sooner the others are done.
    for (const std::size_t step : {std::size_t{61}, std::size_t{1}})
        for (std::size_t vertex = 0; vertex < positions_.size(); vertex += step)
            if (anchors_[vertex] != vertex) include(positions_[vertex], anchors_[vertex], surface);
    const bool few = original_.triangles.size() <= kFewTriangles;
    if (few || kDense * after.size() > original_.triangles.size())
        for (const SampledEdge& edge : edges_) {
            unsigned anchor = anchors_[edge.from];
            include((positions_[edge.from] + positions_[edge.to]) * 0.5F, anchor, surface);
        }
    if (few)
        for (const glm::uvec3& t : original_.triangles) {
            unsigned anchor = anchors_[t.x];
            include((positions_[t.x] + positions_[t.y] + positions_[t.z]) / 3.0F, anchor, surface);
        }
    const std::size_t step = 1 + after.size() * 3 / 2 / kEdges;
    for (std::size_t i = 0; i < after.size(); i += step)
        for (int k = 0; k < 3; ++k) {
            unsigned anchor = after[i][k];
            const unsigned to = after[i][(k + 1) % 3];
            if (anchor < to || !has_edge(surface, to, anchor))
                include((positions_[anchor] + positions_[to]) * 0.5F, anchor, original_);
        }
    if (stop_) return {};
    return std::sqrt(squared_);
}

}  // namespace vrut::mesh
