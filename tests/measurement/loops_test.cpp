#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "measurement/edge_loop.hpp"
#include "measurement/measure.hpp"
#include "near.hpp"
#include "snapped_rays.hpp"

using namespace vrut;
using measurement::Kind;
using measurement::Snap;

namespace {

void check_loop(const Variant& variant, const std::vector<Part>& parts, const glm::dvec3& at, double length,
                std::size_t points) {
    CAPTURE(variant.name);
    const auto scene = scene_under(variant.matrix, parts);
    const auto found = snapped(*scene, ray_in(variant, at + glm::dvec3(0, 0, 5), at), 0.02, {Snap::loop});
    REQUIRE(found);
    REQUIRE(found->feature.snap == Snap::loop);
    CHECK(found->line.size() == points);
    CHECK(found->line.front() == found->line.back());
    measurement::MeshEdgesMemo memo;
    const std::vector<measurement::Feature> picks{found->feature};
    const auto measured = measurement::measure(*scene, Kind::length, picks, memo);
    REQUIRE(measured.value);
    CHECK(std::abs(*measured.value - length * variant.scale) < 1e-9 * length * variant.scale);
    CHECK(measured.line == found->line);
}

double polygon_length(double radius, int count) {
    return count * 2 * radius * std::sin(std::numbers::pi / count);
}

}  // namespace

TEST_CASE("a plate's loops are its outline and its hole") {
    const std::vector<Part> parts{{1, plate(), {}}};
    for (const Variant& variant : variants()) {
        check_loop(variant, parts, {1.03, 0.05, 0}, polygon_length(1, 32), 33);
        check_loop(variant, parts, {1.95, 0.3, 0}, 16, 33);
        check_loop(variant, parts, {2.03, 0.3, 0}, 16, 33);
    }
}

TEST_CASE("a loop of many edges is drawn with 64 points, and measured with all") {
    check_loop({}, {{1, plate(2, 1, 512), {}}}, {1.03, 0.05, 0}, polygon_length(1, 512), 64);
}

TEST_CASE("a loop is that of the face that was hit") {
    const auto scene = scene_of({{1, box({1, 2, 3}), {}}});
    const Variant as_is;
    const std::vector<Snap> loops{Snap::loop};
    const auto above = snapped(*scene, ray_in(as_is, {3, 0, 8}, {0.99, 0.3, 3}), 0.02, loops);
    const auto beside = snapped(*scene, ray_in(as_is, {3, 0, 8}, {1, 0.3, 2.99}), 0.02, loops);
    REQUIRE(above);
    REQUIRE(beside);
    measurement::MeshEdgesMemo memo;
    const std::vector<measurement::Feature> top{above->feature}, side{beside->feature};
    CHECK(measurement::measure(*scene, Kind::length, top, memo).value == 12);
    CHECK(measurement::measure(*scene, Kind::length, side, memo).value == 20);
    CHECK(above->feature.points[1] == beside->feature.points[2]);
    CHECK(above->feature.points[2] == beside->feature.points[1]);
    CHECK(above->feature.points[1] == glm::dvec3(1, -2, 3));
}

TEST_CASE("an open surface has a loop of its boundary, and an inner edge is on it twice") {
    scene::Geometry bend;
    bend.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 2, 0}, {2, 2, 0}, {1, 1, 1}};
    bend.triangles = {{0, 1, 6}, {1, 2, 5}, {1, 5, 6}, {6, 5, 4}, {6, 4, 3}, {0, 6, 3}};
    const measurement::MeshEdges edges(with_bounds(bend));
    const auto half_edge = edges.mesh().find_half_edge({0, 0, 0}, {1, 0, 0});
    REQUIRE(half_edge);
    CHECK_FALSE(edges.mesh().find_half_edge({1, 0, 0}, {0, 0, 0}));
    CHECK(measurement::edge_loop(edges, *half_edge).size() == 3);
    CHECK(measurement::edge_loop(edges, *edges.mesh().find_half_edge({2, 0, 0}, {2, 2, 0})).size() == 3);
}

TEST_CASE("a loop goes on through triangles that do not agree on the outside") {
    scene::Geometry sheet = surface(8, 8, [](double u, double v) { return glm::dvec3(u, v, 0); });
    for (std::size_t i = 0; i < sheet.triangles.size(); i += 3)
        std::swap(sheet.triangles[i].x, sheet.triangles[i].y);
    const measurement::MeshEdges edges(sheet);
    for (unsigned h = 0; h < edges.mesh().half_edge_count(); ++h)
        if (edges.is_feature(h)) CHECK(measurement::edge_loop(edges, h).size() == 32);
}

TEST_CASE("a smooth edge has no loop") {
    const scene::Geometry solid = box({1, 2, 3});
    const auto scene = scene_of({{1, solid, {}}});
    const measurement::MeshEdges edges(solid);
    measurement::MeshEdgesMemo memo;
    int smooth = 0;
    for (unsigned h = 0; h < edges.mesh().half_edge_count(); ++h) {
        if (edges.is_feature(h)) continue;
        ++smooth;
        CHECK(measurement::edge_loop(edges, h).empty());
        const glm::dvec3 start = edges.mesh().positions()[edges.mesh().start_of(h)];
        const glm::dvec3 end = edges.mesh().positions()[edges.mesh().end_of(h)];
        const std::vector<measurement::Feature> picks{{1, Snap::loop, {start, start, end}}};
        const auto measured = measurement::measure(*scene, Kind::length, picks, memo);
        CHECK(measured.problem == "its edge is not in the part any more");
    }
    CHECK(smooth == 12);
}
