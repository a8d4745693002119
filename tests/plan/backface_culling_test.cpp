#include "plan/backface_culling.hpp"

#include <doctest/doctest.h>

using namespace vrut;

namespace {

/// A plate at the origin, whose front is seen from +z, or from -z.
mesh::TriangleCluster plate(bool turned) { return {glm::dvec3(0), 1, glm::vec3(0, 0, turned ? -1 : 1), 0}; }

std::vector<plan::TriangleRange> facing(const std::vector<bool>& turned, std::size_t triangles) {
    std::vector<mesh::TriangleCluster> clusters;
    for (const bool turned_away : turned) clusters.push_back(plate(turned_away));
    std::vector<plan::TriangleRange> ranges{{7, 7}};  // of another geometry
    plan::find_facing(clusters, triangles, {0, 0, 10}, ranges);
    return ranges;
}

}  // namespace

TEST_CASE("ranges of triangles that may show their front") {
    constexpr std::size_t kCluster = mesh::kClusterTriangles;
    using Ranges = std::vector<plan::TriangleRange>;
    CHECK(facing({false, false}, kCluster + 5) == Ranges{{0, kCluster + 5}});
    CHECK(facing({true, true}, 2 * kCluster).empty());
    CHECK(facing({false, true, true, false, false}, 4 * kCluster + 1) ==
          Ranges{{0, kCluster}, {3 * kCluster, kCluster + 1}});
    CHECK(facing({true, false, true}, 3 * kCluster) == Ranges{{kCluster, kCluster}});
}
