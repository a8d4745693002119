#include "measurement/snapping.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "measurement/edge_loop.hpp"
#include "measurement/neighborhood.hpp"
#include "measurement/placement.hpp"
#include "measurement/snap_candidates.hpp"

namespace vrut::measurement {

namespace {

constexpr int kCircleSteps = 63;
/// How many candidates are looked at whether they are visible.
constexpr std::size_t kMostTries = 256;

std::vector<glm::dvec3> circle_line(const std::vector<glm::dvec3>& circle) {
    std::vector<glm::dvec3> line;
    line.reserve(kCircleSteps + 1);
    for (int i = 0; i < kCircleSteps; ++i) {
        const double angle = 2 * std::numbers::pi * i / kCircleSteps;
        line.push_back(circle[0] + (circle[1] - circle[0]) * std::cos(angle) +
                       (circle[2] - circle[0]) * std::sin(angle));
    }
    line.push_back(line[0]);
    return line;
}

std::vector<glm::dvec3> loop_line(const MeshEdges& edges, const std::vector<glm::dvec3>& loop) {
    std::vector<glm::dvec3> line;
    const auto half_edge = edges.mesh().find_half_edge(loop[1], loop[2]);
    if (!half_edge) return line;
    const std::vector<unsigned> vertices = edge_loop(edges, *half_edge);
    line.reserve(vertices.size());
    for (const unsigned vertex : vertices) line.push_back(edges.mesh().positions()[vertex]);
    return thinned_loop(line);
}

/// In the node's space.
std::vector<glm::dvec3> line_of(const MeshEdges& edges, const Feature& feature) {
    switch (feature.snap) {
        case Snap::edge:
            return {feature.points[1], feature.points[2]};
        case Snap::center:
            return circle_line(feature.points);
        case Snap::loop:
            return loop_line(edges, feature.points);
        default:
            return {};
    }
}

void prefer_best(std::vector<Candidate>& candidates) {
    std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::tuple(a.rank, a.offset, a.depth) < std::tuple(b.rank, b.offset, b.depth);
    });
}

}  // namespace

std::optional<Snapped> snap(const scene::PlacedScene& placed, const mesh::Hit& hit, const mesh::Ray& ray,
                            const SnapOptions& options, MeshEdgesMemo& memo) {
    const auto around = Neighborhood::around(placed, hit, ray, options, memo);
    if (!around) return {};
    std::vector<Candidate> candidates = snap_candidates(*around, options.to);
    prefer_best(candidates);
    std::size_t tries = 0;
    const auto best = std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
        return candidate.rank >= Rank::plane || (tries++ < kMostTries && around->is_visible(candidate.seen));
    });
    if (best == candidates.end()) return {};
    Snapped snapped;
    snapped.feature = {placed.scene->nodes()[static_cast<std::size_t>(hit.node)].id, best->snap,
                       best->points};
    snapped.point = in_world(placed, hit.node, best->points[0]);
    snapped.line = line_of(around->edges(), snapped.feature);
    snapped.offset = best->offset;
    for (glm::dvec3& point : snapped.line) point = in_world(placed, hit.node, point);
    return snapped;
}

}  // namespace vrut::measurement
