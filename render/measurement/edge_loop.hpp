#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "measurement/mesh_edges.hpp"

namespace vrut::measurement {

/// Walks along the feature edges around a smooth region: each time around the end vertex, through the
/// triangles of the region, to the next feature edge.
class LoopWalk {
public:
    /// Starts at a feature half-edge, and passes at most `most_steps` edges, smooth ones included.
    LoopWalk(const MeshEdges& edges, unsigned half_edge, std::size_t most_steps)
        : edges_(edges), start_{half_edge, false}, step_(start_), steps_left_(most_steps) {}

    unsigned half_edge() const { return step_.half_edge; }
    /// Where the current edge starts.
    unsigned vertex() const;
    /// Goes on to the next feature edge. False if that takes too many steps.
    bool advance();
    bool is_back() const { return step_ == start_; }

private:
    /// A half-edge, walked along or against its direction.
    struct Step {
        unsigned half_edge;
        bool against;
        bool operator==(const Step&) const = default;
    };
    static Step turned(const Step& step);
    static Step reversed(const Step& step);
    Step crossed(const Step& step) const;

    const MeshEdges& edges_;
    Step start_, step_;
    std::size_t steps_left_;
};

/// Returns the vertices of the closed walk around a smooth region, from the start of a feature half-edge on.
/// Empty if the edge is no feature edge, or there is no way back.
std::vector<unsigned> edge_loop(const MeshEdges& edges, unsigned half_edge);

/// The points of a closed loop, its first one again at the end: all, or 64 that are spread evenly.
std::vector<glm::dvec3> thinned_loop(const std::vector<glm::dvec3>& points);

}  // namespace vrut::measurement
