#include "measurement/feature_graph.hpp"

#include <algorithm>

#include "measurement/vectors.hpp"

namespace vrut::measurement {

FeatureGraph::FeatureGraph(std::span<const glm::dvec3> positions,
                           std::span<const std::pair<unsigned, unsigned>> edges)
    : positions_(positions),
      edge_count_(edges.size()),
      first_(positions.size() + 2),
      links_(2 * edges.size()) {
    for (const auto& [a, b] : edges) {
        ++first_[a + 2];
        ++first_[b + 2];
    }
    for (std::size_t i = 2; i < first_.size(); ++i) first_[i] += first_[i - 1];
    for (unsigned edge = 0; edge < edges.size(); ++edge) {
        const auto [a, b] = edges[edge];
        links_[first_[a + 1]++] = {b, edge};
        links_[first_[b + 1]++] = {a, edge};
    }
}

double FeatureGraph::cosine_of_turn(unsigned from, unsigned at, unsigned to) const {
    return glm::dot(unit(positions_[at] - positions_[from]), unit(positions_[to] - positions_[at]));
}

std::vector<bool> FeatureGraph::corners() const {
    std::vector<bool> corners(positions_.size());
    for (unsigned vertex = 0; vertex < positions_.size(); ++vertex) {
        const std::span<const Link> links = links_of(vertex);
        if (links.size() == 2)
            corners[vertex] = cosine_of_turn(links[0].end, vertex, links[1].end) < kCornerCosine;
        else
            corners[vertex] = !links.empty();
    }
    return corners;
}

FeatureGraph::Chains FeatureGraph::chains(const std::vector<bool>& is_corner) const {
    Chains chains;
    std::vector<bool> is_used(edge_count_);
    for (const bool from_corners : {true, false})
        for (unsigned vertex = 0; vertex < positions_.size(); ++vertex)
            if (is_corner[vertex] == from_corners)
                for (const Link& link : links_of(vertex))
                    if (!is_used[link.edge]) follow(vertex, link, is_corner, is_used, chains);
    return chains;
}

void FeatureGraph::follow(unsigned from, Link link, const std::vector<bool>& is_corner,
                          std::vector<bool>& is_used, Chains& chains) const {
    chains.vertices.push_back(from);
    for (;;) {
        is_used[link.edge] = true;
        chains.vertices.push_back(link.end);
        if (is_corner[link.end] || link.end == from) break;
        const std::span<const Link> links = links_of(link.end);
        link = links[links[0].edge == link.edge ? 1 : 0];
    }
    if (!is_corner[from]) start_where_it_turns_most(std::span(chains.vertices).subspan(chains.first.back()));
    chains.first.push_back(chains.vertices.size());
}

void FeatureGraph::start_where_it_turns_most(std::span<unsigned> closed) const {
    const std::size_t count = closed.size() - 1;
    std::size_t sharpest = 0;
    double least = 2;
    for (std::size_t i = 0; i < count; ++i) {
        const double cosine = cosine_of_turn(closed[(i + count - 1) % count], closed[i], closed[i + 1]);
        if (cosine >= least) continue;
        least = cosine;
        sharpest = i;
    }
    std::rotate(closed.begin(), closed.begin() + static_cast<std::ptrdiff_t>(sharpest), closed.end() - 1);
    closed.back() = closed.front();
}

}  // namespace vrut::measurement
