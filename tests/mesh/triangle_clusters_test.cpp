#include "mesh/triangle_clusters.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "shapes.hpp"

using namespace vrut;

namespace {

scene::Geometry moved(scene::Geometry geometry, double scale, const glm::dvec3& by) {
    for (glm::dvec3& position : geometry.positions) position = scale * position + by;
    return geometry;
}

/// Small triangles that face everywhere.
scene::Geometry scattered(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const auto any = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
    scene::Geometry geometry;
    for (unsigned i = 0; i < 200; ++i) {
        const glm::dvec3 at = any();
        for (int corner = 0; corner < 3; ++corner) geometry.positions.push_back(at + 0.1 * any());
        geometry.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return geometry;
}

bool shows_front(const scene::Geometry& geometry, const glm::uvec3& triangle, const glm::dvec3& eye) {
    const glm::dvec3 &a = geometry.positions[triangle.x], &b = geometry.positions[triangle.y],
                     &c = geometry.positions[triangle.z];
    return glm::dot(glm::cross(b - a, c - a), eye - a) > 0;
}

/// The number of triangles in clusters that show their backs. None of these may show its front.
std::size_t culled(const scene::Geometry& geometry, const glm::dvec3& eye) {
    const std::vector<mesh::TriangleCluster> clusters = mesh::triangle_clusters(geometry);
    std::size_t count = 0, fronts = 0;
    for (std::size_t i = 0; i < clusters.size(); ++i) {
        if (!mesh::shows_backs(clusters[i], eye)) continue;
        const std::size_t first = i * mesh::kClusterTriangles;
        const std::size_t end = std::min(first + mesh::kClusterTriangles, geometry.triangles.size());
        count += end - first;
        for (std::size_t k = first; k < end; ++k) fronts += shows_front(geometry, geometry.triangles[k], eye);
    }
    CHECK(fronts == 0);
    return count;
}

}  // namespace

TEST_CASE("no triangle that shows its front is culled") {
    std::mt19937 random(17);
    std::normal_distribution<double> normal;
    const std::vector<scene::Geometry> shapes{sphere(1, 24), sphere(1, 24, false), scattered(random),
                                              box(glm::dvec3(0.5))};
    std::size_t count = 0;
    for (const double scale : {1e-12, 1.0, 1e9})
        for (const glm::dvec3& place : {glm::dvec3(0), glm::dvec3(1e7, -3e6, 2e7)})
            for (const scene::Geometry& shape : shapes) {
                CAPTURE(scale);
                const glm::dvec3 center = scale * place;
                const scene::Geometry geometry = moved(shape, scale, center);
                for (int i = 0; i < 20; ++i) {
                    const double distance = scale * std::exp(2 * normal(random));  // inside, too
                    const glm::dvec3 towards(normal(random), normal(random), normal(random));
                    count += culled(geometry, center + distance * glm::normalize(towards));
                }
            }
    CHECK(count > 10'000);
}

TEST_CASE("what faces away is culled") {
    const scene::Geometry plate = quad(1);  // its front is seen from +z
    CHECK(culled(plate, {0.3, 0.2, -5}) == 2);
    CHECK(culled(plate, {0.3, 0.2, 5}) == 0);
    const scene::Geometry ball = sphere(1, 100);
    const std::size_t from_far = culled(ball, {0, 0, 50});
    CHECK(from_far > ball.triangles.size() / 3);
    CHECK(from_far < ball.triangles.size() / 2);
}

TEST_CASE("a geometry that cannot be culled has no clusters") {
    CHECK(mesh::triangle_clusters(box(glm::dvec3(1))).empty());
    CHECK(mesh::triangle_clusters({}).empty());
    scene::Geometry points;  // without an area
    points.positions.assign(3, glm::dvec3(2, 3, 4));
    points.triangles = {{0, 1, 2}, {0, 0, 0}};
    CHECK(mesh::triangle_clusters(points).empty());
    points.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    CHECK(mesh::triangle_clusters(points).empty());
}
