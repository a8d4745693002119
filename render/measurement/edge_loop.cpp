#include "measurement/edge_loop.hpp"

#include <algorithm>

namespace vrut::measurement {

namespace {

constexpr std::size_t kMostPoints = 64;

/// A half-edge, walked along or against its direction.
struct Step {
    unsigned half_edge;
    bool against;
    bool operator==(const Step&) const = default;
};

unsigned neighbour(unsigned half_edge, unsigned steps) {
    return half_edge / 3 * 3 + (half_edge % 3 + steps) % 3;
}

/// The other edge of the triangle at the vertex to which the step leads.
Step turned(const Step& step) { return {neighbour(step.half_edge, step.against ? 2 : 1), step.against}; }

/// Across a smooth edge: the same way along it, seen in the triangle beyond.
Step crossed(const WeldedMesh& mesh, const Step& step) {
    const bool agrees = mesh.agrees_with_twin(step.half_edge);
    return {mesh.twin(step.half_edge), agrees ? !step.against : step.against};
}

/// Turns back along the edge, in the same triangle.
Step reversed(const Step& step) { return {step.half_edge, !step.against}; }

}  // namespace

std::vector<unsigned> edge_loop(const MeshEdges& edges, unsigned half_edge) {
    const WeldedMesh& mesh = edges.mesh();
    std::vector<unsigned> loop;
    if (!edges.is_feature(half_edge)) return loop;
    const Step start{half_edge, false};
    Step step = start;
    std::size_t budget = 4 * mesh.half_edge_count();
    do {
        loop.push_back(step.against ? mesh.end_of(step.half_edge) : mesh.start_of(step.half_edge));
        step = turned(step);
        while (!edges.is_feature(step.half_edge)) {
            if (budget-- == 0) return {};
            step = turned(reversed(crossed(mesh, step)));
        }
        if (budget-- == 0) return {};
    } while (!(step == start));
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
