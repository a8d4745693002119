#include "measurement/placement.hpp"

#include <utility>

namespace vrut::measurement {

namespace {

/// Parents stand before their children.
scene::Index lowest_common_ancestor(const scene::Scene& scene, scene::Index a, scene::Index b) {
    while (a != b) {
        if (a < b) std::swap(a, b);
        a = scene.nodes()[static_cast<std::size_t>(a)].parent;
    }
    return a;
}

/// The point in the ancestor's space, as a sum: differences of the far parts and of the near ones are exact
/// where the sum is not.
struct SplitPoint {
    glm::dvec3 near{0}, far{0};
};

SplitPoint below(const scene::PlacedScene& placed, scene::Index node, scene::Index ancestor,
                 const glm::dvec3& point) {
    SplitPoint split{point, glm::dvec3(0)};
    for (; node != ancestor; node = placed.scene->nodes()[static_cast<std::size_t>(node)].parent) {
        const glm::dmat4& matrix = placed.nodes[static_cast<std::size_t>(node)].matrix;
        split.near = glm::dmat3(matrix) * split.near;
        split.far = glm::dmat3(matrix) * split.far + glm::dvec3(matrix[3]);
    }
    return split;
}

}  // namespace

std::vector<PlacedFeature> placed_features(const scene::PlacedScene& placed,
                                           std::span<const Feature> features) {
    std::vector<PlacedFeature> result(features.size());
    scene::Index ancestor = scene::kNone;
    for (std::size_t i = 0; i < features.size(); ++i) {
        result[i].snap = features[i].snap;
        result[i].node = placed.scene->find_node(features[i].node);
        ancestor = i == 0 ? result[i].node : lowest_common_ancestor(*placed.scene, ancestor, result[i].node);
    }
    SplitPoint origin;
    for (std::size_t i = 0; i < features.size(); ++i) {
        const std::vector<glm::dvec3>& points = features[i].points;
        const SplitPoint point = below(placed, result[i].node, ancestor, points[0]);
        if (i == 0) origin = point;
        const glm::dmat3 from_ancestor(placed.world[static_cast<std::size_t>(ancestor)]);
        result[i].at = from_ancestor * ((point.near - origin.near) + (point.far - origin.far));
        if (points.size() != 3) continue;
        const glm::dmat3 linear(placed.world[static_cast<std::size_t>(result[i].node)]);
        result[i].second = linear * (points[1] - points[0]);
        result[i].third = linear * (points[2] - points[0]);
        result[i].along = linear * (points[2] - points[1]);
    }
    return result;
}

glm::dvec3 in_world(const scene::PlacedScene& placed, scene::Index node, const glm::dvec3& point) {
    return {placed.world[static_cast<std::size_t>(node)] * glm::dvec4(point, 1)};
}

}  // namespace vrut::measurement
