#include "measurement/edge_loop.hpp"

#include <algorithm>

namespace vrut::measurement {

namespace {

constexpr std::size_t kMostPoints = 64;

unsigned neighbour(unsigned half_edge, unsigned steps) {
    return half_edge / 3 * 3 + (half_edge % 3 + steps) % 3;
}

}  // namespace

/// The other edge of the triangle at the vertex to which the step leads.
LoopWalk::Step LoopWalk::turned(const Step& step) {
    return {neighbour(step.half_edge, step.against ? 2 : 1), step.against};
}

/// Turns back along the edge, in the same triangle.
LoopWalk::Step LoopWalk::reversed(const Step& step) { return {step.half_edge, !step.against}; }

/// Across a smooth edge: the same way along it, seen in the triangle beyond.
LoopWalk::Step LoopWalk::crossed(const Step& step) const {
    const bool agrees = edges_.mesh().agrees_with_twin(step.half_edge);
    return {edges_.mesh().twin(step.half_edge), agrees ? !step.against : step.against};
}

unsigned LoopWalk::vertex() const {
    const WeldedMesh& mesh = edges_.mesh();
    return step_.against ? mesh.end_of(step_.half_edge) : mesh.start_of(step_.half_edge);
}

bool LoopWalk::advance() {
    step_ = turned(step_);
    while (!edges_.is_feature(step_.half_edge)) {
        if (steps_left_-- == 0) return false;
        step_ = turned(reversed(crossed(step_)));
    }
    return steps_left_-- != 0;
}

std::vector<unsigned> edge_loop(const MeshEdges& edges, unsigned half_edge) {
    std::vector<unsigned> loop;
    if (!edges.is_feature(half_edge)) return loop;
    LoopWalk walk(edges, half_edge, 4 * edges.mesh().half_edge_count());
    do {
        loop.push_back(walk.vertex());
        if (!walk.advance()) return {};
    } while (!walk.is_back());
    return loop;
}

std::vector<glm::dvec3> thinned_loop(const std::vector<glm::dvec3>& points) {
    std::vector<glm::dvec3> thinned;
    if (points.empty()) return thinned;
    const std::size_t count = std::min(points.size(), kMostPoints - 1);
    thinned.reserve(count + 1);
    for (std::size_t i = 0; i < count; ++i) thinned.push_back(points[i * points.size() / count]);
    thinned.push_back(points[0]);
    return thinned;
}

}  // namespace vrut::measurement
