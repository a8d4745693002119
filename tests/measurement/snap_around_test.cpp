#include "measurement/snap_around.hpp"

#include <doctest/doctest.h>

#include "solids.hpp"

using namespace vrut;
using measurement::Snap;

namespace {

std::optional<measurement::Snapped> clicked(const scene::PlacedScene& placed, const glm::dvec3& at,
                                            const measurement::SnapOptions& options) {
    measurement::MeshEdgesMemo memo;
    const glm::dvec3 eye(0.4, 0.3, 5);
    return measurement::snap_around(
        placed, {eye, glm::normalize(at - eye)},
        [&](const mesh::Ray& ray) { return mesh::pick(placed, ray); }, options, memo);
}

}  // namespace

TEST_CASE("snap around: a rim gives its circle, from beside the part as well") {
    const auto placed = scene_of({{1, with_bounds(prism(circle_outline(1, 128), 0.5)), {}}});
    for (const double beside : {0.99, 0.999, 1.01, 1.02}) {
        INFO(beside);
        const auto found = clicked(*placed, {beside, 0.01, 0}, {.radius = 0.005});
        REQUIRE(found);
        CHECK(found->feature.snap == Snap::center);
        CHECK(glm::length(glm::dvec2(found->feature.points[0])) < 1e-12);
    }
    CHECK_FALSE(clicked(*placed, {1.2, 0, 0}, {.radius = 0.005}));
}

TEST_CASE("snap around: points and planes count only where they are pointed at") {
    const auto placed = scene_of({{1, box({1, 1, 1}), {}}});
    const auto face = clicked(*placed, {0.2, 0.3, 1}, {.radius = 0.005});
    REQUIRE(face);
    CHECK(face->feature.snap == Snap::plane);
    CHECK_FALSE(clicked(*placed, {1.01, 0.2, 1}, {.radius = 0.005, .to = {Snap::plane, Snap::point}}));
    const auto edge = clicked(*placed, {1.01, 0.2, 1}, {.radius = 0.005});
    REQUIRE(edge);
    CHECK(edge->feature.snap == Snap::edge);
    CHECK_FALSE(clicked(*placed, {1.01, 0.2, 1}, {.radius = 0}));
}
