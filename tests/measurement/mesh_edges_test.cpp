#include "measurement/mesh_edges.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "measurement/edge_loop.hpp"
#include "random_parts.hpp"
#include "repetitions.hpp"
#include "solids.hpp"

using namespace vrut;
using measurement::MeshEdges;

namespace {

std::size_t corner_count(const MeshEdges& edges) {
    std::size_t count = 0;
    for (unsigned vertex = 0; vertex < edges.mesh().positions().size(); ++vertex)
        count += edges.is_corner(vertex);
    return count;
}

std::size_t feature_count(const MeshEdges& edges) {
    std::size_t count = 0;
    for (std::size_t chain = 0; chain < edges.chain_count(); ++chain) count += edges.chain(chain).size() - 1;
    return count;
}

/// Two triangles that share the edge from the origin to (0, 1, 0), bent by an angle.
scene::Geometry bent(double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    scene::Geometry geometry;
    geometry.positions = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {std::cos(angle), 0, std::sin(angle)}};
    geometry.triangles = {{0, 1, 2}, {1, 0, 3}};
    return with_bounds(geometry);
}

/// Two strips of triangles, side by side, whose outline turns by an angle at one vertex.
MeshEdges fan(double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    scene::Geometry geometry;
    geometry.positions = {{-1, 0, 0}, {0, 0, 0}, {std::cos(angle), std::sin(angle), 0}, {0, 3, 0}};
    geometry.triangles = {{0, 1, 3}, {1, 2, 3}};
    return MeshEdges(with_bounds(geometry));
}

}  // namespace

TEST_CASE("a box has twelve edges and eight corners") {
    const MeshEdges edges(box({1, 2, 3}));
    CHECK(edges.mesh().positions().size() == 8);
    CHECK(edges.chain_count() == 12);
    CHECK(feature_count(edges) == 12);
    CHECK(corner_count(edges) == 8);
}

TEST_CASE("corners are welded by exact position, and -0 is 0") {
    scene::Geometry geometry;
    geometry.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-0.0, 0, -0.0}, {1, 1, -0.0}, {0, 1, 0}};
    geometry.triangles = {{0, 1, 2}, {3, 4, 5}};
    const MeshEdges edges(with_bounds(geometry));
    CHECK(edges.mesh().positions().size() == 4);
    CHECK(feature_count(edges) == 4);
    geometry.positions[3].x = 1e-300;
    CHECK(MeshEdges(geometry).mesh().positions().size() == 5);
}

TEST_CASE("an edge is seen where two triangles bend by more than 20 degrees") {
    CHECK(feature_count(MeshEdges(bent(19.9))) == 4);
    CHECK(feature_count(MeshEdges(bent(-19.9))) == 4);
    CHECK(feature_count(MeshEdges(bent(20.1))) == 5);
    CHECK(feature_count(MeshEdges(bent(-20.1))) == 5);
    scene::Geometry turned = bent(10);
    std::swap(turned.triangles[1].x, turned.triangles[1].y);
    CHECK(feature_count(MeshEdges(turned)) == 4);
    scene::Geometry three = bent(10);
    three.positions.emplace_back(0, 0, 1);
    three.triangles.emplace_back(0, 1, 4);
    CHECK(feature_count(MeshEdges(three)) == 7);
}

TEST_CASE("a corner is where edges turn by more than 40 degrees") {
    CHECK(corner_count(fan(39.9)) == 3);
    CHECK(corner_count(fan(40.1)) == 4);
    CHECK(corner_count(fan(-30)) == 3);
}

TEST_CASE("triangles without area do not matter") {
    scene::Geometry whole;
    whole.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}};
    whole.triangles = {{0, 1, 4}, {1, 2, 4}, {0, 2, 3}, {0, 4, 2}};
    const MeshEdges edges(with_bounds(whole));
    CHECK(edges.mesh().triangles().size() == 4);
    CHECK(feature_count(edges) == 4);
    scene::Geometry at_outline;
    at_outline.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 0, 0}};
    at_outline.triangles = {{0, 4, 3}, {4, 2, 3}, {4, 1, 2}, {0, 1, 4}};
    CHECK(feature_count(MeshEdges(with_bounds(at_outline))) == 4);
    scene::Geometry at_fold = at_outline;
    at_fold.positions.emplace_back(1, 0, -1);
    at_fold.triangles.emplace_back(1, 0, 5);
    CHECK(feature_count(MeshEdges(with_bounds(at_fold))) == 7);
    scene::Geometry solid = box({1, 1, 1});
    solid.triangles.insert(solid.triangles.begin(), {{0, 0, 1}, {2, 1, 2}, {3, 3, 3}});
    CHECK(feature_count(MeshEdges(solid)) == 12);
    CHECK(corner_count(MeshEdges(solid)) == 8);
}

TEST_CASE("positions that are not finite are left out") {
    scene::Geometry solid = box({1, 1, 1});
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        solid.positions.emplace_back(0, bad, 0);
        solid.triangles.emplace_back(0, 1, static_cast<unsigned>(solid.positions.size() - 1));
    }
    CHECK(feature_count(MeshEdges(solid)) == 12);
    for (glm::dvec3& position : solid.positions) position *= 1e308;
    CHECK(MeshEdges(solid).mesh().triangles().size() == 12);
    CHECK(MeshEdges(scene::Geometry()).chain_count() == 0);
}

TEST_CASE("edges of a plate go from corner to corner, and around its hole") {
    const MeshEdges edges(plate());
    CHECK(corner_count(edges) == 8);
    CHECK(edges.chain_count() == 14);
    int closed = 0;
    for (std::size_t i = 0; i < edges.chain_count(); ++i) {
        const auto chain = edges.chain(i);
        if (chain.front() != chain.back()) continue;
        CHECK(chain.size() == 33);
        ++closed;
    }
    CHECK(closed == 2);
    CHECK(corner_count(MeshEdges(prism(circle_outline(1, 6), 1))) == 12);
}

TEST_CASE("chains have each edge once, and each loop comes back") {
    Dice dice(3);
    for (int round = 0; round < test::repetitions(100); ++round) {
        scene::Geometry soup;
        for (int i = 0; i < 12; ++i) soup.positions.push_back(dice.vector(1));
        const auto corner = [&] { return static_cast<unsigned>(dice.between(0, 12)); };
        for (int i = 0; i < 5 + round % 30; ++i) soup.triangles.emplace_back(corner(), corner(), corner());
        const MeshEdges edges(soup);
        std::map<std::pair<unsigned, unsigned>, int> expected, found;
        for (unsigned h = 0; h < edges.mesh().half_edge_count(); ++h)
            if (edges.is_feature(h)) {
                expected[std::minmax({edges.mesh().start_of(h), edges.mesh().end_of(h)})] = 1;
                const auto loop = measurement::edge_loop(edges, h);
                REQUIRE(loop.size() >= 2);
                CHECK(loop[0] == edges.mesh().start_of(h));
                CHECK(loop[1] == edges.mesh().end_of(h));
            }
        for (std::size_t i = 0; i < edges.chain_count(); ++i)
            for (std::size_t k = 1; k < edges.chain(i).size(); ++k)
                ++found[std::minmax({edges.chain(i)[k - 1], edges.chain(i)[k]})];
        CHECK(found == expected);
    }
}

TEST_CASE("what is near a box is found") {
    Dice dice(5);
    const MeshEdges edges(plate(2, 1, 256));
    const auto& mesh = edges.mesh();
    for (int round = 0; round < test::repetitions(50); ++round) {
        const glm::dvec3 center = dice.vector(2), half = glm::abs(dice.vector(0.5));
        const math::Bounds around{center - half, center + half};
        std::vector<unsigned> triangles;
        for (unsigned t = 0; t < mesh.triangles().size(); ++t) {
            math::Bounds bounds;
            for (int k = 0; k < 3; ++k) bounds.add(mesh.positions()[mesh.triangles()[t][k]]);
            if (measurement::overlap(bounds, around)) triangles.push_back(t);
        }
        CHECK(edges.triangles_near(around) == triangles);
        CHECK(edges.triangles_near(around, triangles.size()).has_value());
        if (!triangles.empty()) CHECK_FALSE(edges.triangles_near(around, triangles.size() - 1).has_value());
        std::vector<std::size_t> chains;
        for (std::size_t i = 0; i < edges.chain_count(); ++i)
            for (std::size_t k = 1; k < edges.chain(i).size(); ++k) {
                math::Bounds bounds;
                for (const std::size_t at : {k - 1, k}) bounds.add(mesh.positions()[edges.chain(i)[at]]);
                if (!measurement::overlap(bounds, around)) continue;
                chains.push_back(i);
                break;
            }
        CHECK(edges.chains_near(around) == chains);
    }
}

TEST_CASE("edges are found once for a scene, which is not kept alive") {
    measurement::MeshEdgesMemo memo;
    auto first = scene_of({{1, box({1, 1, 1}), {}}, {2, plate(), {}}});
    const MeshEdges* known = &memo.of(first->scene, 0);
    CHECK(&memo.of(first->scene, 0) == known);
    CHECK(memo.of(first->scene, 1).chain_count() == 14);
    CHECK(&memo.of(first->scene, 0) == known);
    const std::weak_ptr<const scene::Scene> watched = first->scene;
    first.reset();
    CHECK(watched.expired());
    const auto second = scene_of({{1, plate(), {}}});
    CHECK(memo.of(second->scene, 0).chain_count() == 14);
}
