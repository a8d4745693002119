#pragma once

#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

namespace vrut::measurement {

/// Of 40 degrees, less a little: what turns by just that much is no corner.
inline constexpr double kCornerCosine = 0.7660444431189780 - 1e-6;

/// Which vertices are joined by feature edges, and the chains that these make.
class FeatureGraph {
public:
    /// `edges`: pairs of vertices, each edge once.
    FeatureGraph(std::span<const glm::dvec3> positions, std::span<const std::pair<unsigned, unsigned>> edges);

    /// See MeshEdges.
    struct Chains {
        std::vector<unsigned> vertices;
        std::vector<std::size_t> first{0};
    };
    std::vector<bool> corners() const;
    Chains chains(const std::vector<bool>& is_corner) const;

private:
    struct Link {
        unsigned end, edge;
    };
    std::span<const Link> links_of(unsigned vertex) const {
        return std::span(links_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }
    double cosine_of_turn(unsigned from, unsigned at, unsigned to) const;
    void follow(unsigned from, Link link, const std::vector<bool>& is_corner, std::vector<bool>& is_used,
                Chains& chains) const;
    void start_where_it_turns_most(std::span<unsigned> closed) const;

    std::span<const glm::dvec3> positions_;
    std::size_t edge_count_;
    std::vector<std::size_t> first_;  // in links_, by vertex
    std::vector<Link> links_;
};

}  // namespace vrut::measurement
