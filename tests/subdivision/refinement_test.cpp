#include "refinement.hpp"

#include <doctest/doctest.h>

#include "near.hpp"
#include "sheet.hpp"
#include "subdivision_shapes.hpp"

using namespace vrut;

namespace {

/// The cage's mesh with about so many triangles.
AdaptiveMesh refined(const Cage& cage, double count) {
    AdaptiveMesh mesh(cage);
    std::array<RefinedPart, 1> parts = {RefinedPart{&mesh, 1, 1}};
    Refinement(parts).refine_to(count);
    return mesh;
}

scene::Geometry refined_geometry(const Cage& cage, double count) {
    return geometry_of(refined(cage, count), !cage.texcoords.empty());
}

/// Of the triangles' longest edges to their shortest, the median.
double slenderness(const scene::Geometry& geometry) {
    std::vector<double> ratios;
    for (const glm::uvec3& t : geometry.triangles) {
        std::array<double, 3> lengths{};
        for (int k = 0; k < 3; ++k)
            lengths[static_cast<std::size_t>(k)] =
                glm::distance(geometry.positions[t[k]], geometry.positions[t[(k + 1) % 3]]);
        const auto [shortest, longest] = std::minmax_element(lengths.begin(), lengths.end());
        ratios.push_back(*longest / *shortest);
    }
    std::nth_element(ratios.begin(), ratios.begin() + static_cast<long>(ratios.size() / 2), ratios.end());
    return ratios[ratios.size() / 2];
}

/// How far the middles of triangles' edges are off the cylinder of radius 1, at most.
double off_cylinder(const scene::Geometry& geometry) {
    double most = 0;
    for (const glm::uvec3& t : geometry.triangles)
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 middle = (geometry.positions[t[k]] + geometry.positions[t[(k + 1) % 3]]) / 2.0;
            most = std::max(most, std::abs(1 - std::hypot(middle.x, middle.z)));
        }
    return most;
}

}  // namespace

TEST_CASE("the limit of a cube") {
    const LimitSurface surface(shapes::cube());
    // The mask of a corner of three quads: nine times itself, four times its neighbours, once those across.
    const LimitSurface::Point corner = surface.at(1, 1, 1);  // quad 4 6 7 5: its third corner is 7
    CHECK(near(corner.position, glm::dvec3(0.5), 1e-9));
    CHECK(near(corner.normal, glm::dvec3(1 / std::sqrt(3.0)), 1e-3));
    const LimitSurface::Point middle = surface.at(1, 0.5, 0.5);
    CHECK(std::abs(middle.position.y) < 1e-9);
    CHECK(std::abs(middle.position.z) < 1e-9);
    CHECK(near(middle.normal, {1, 0, 0}, 1e-9));
}

TEST_CASE("a smooth cage stays smooth and closed at every level") {
    for (const double count : {12.0, 50.0, 700.0, 20000.0}) {
        const AdaptiveMesh mesh = refined(shapes::cube(), count);
        CHECK(static_cast<double>(mesh.triangles().size()) == doctest::Approx(count).epsilon(0.05));
        const scene::Geometry geometry = geometry_of(mesh, false);
        CHECK(geometry.positions.size() == mesh.vertices().size());  // no split normals
        CHECK(shapes::open_edges(geometry) == 0);
        CHECK(shapes::volume(geometry) > 0);
        for (std::size_t i = 0; i < geometry.positions.size(); ++i)
            CHECK(glm::dot(geometry.positions[i], glm::dvec3(geometry.normals[i])) > 0);
    }
}

TEST_CASE("hard edges split normals, rounded ones do not") {
    const scene::Geometry hard = refined_geometry(shapes::cube(10), 1000);
    CHECK(hard.triangles.size() == 12);
    CHECK(hard.positions.size() == 24);
    CHECK(shapes::volume(hard) == doctest::Approx(8));
    CHECK(shapes::open_edges(hard) == 0);
    const AdaptiveMesh mesh = refined(shapes::cube(2.5), 3000);
    const scene::Geometry rounded = geometry_of(mesh, false);
    CHECK(rounded.positions.size() == mesh.vertices().size());
    CHECK(shapes::volume(rounded) > 7.4);
    CHECK(shapes::volume(rounded) < 7.95);
    Cage cube = shapes::cube();
    cube.smooth = false;
    CHECK(shapes::volume(refined_geometry(cube, 1000)) == doctest::Approx(8));
}

TEST_CASE("a plane stays plane, its texture coordinates even, and needs no more triangles") {
    const glm::dvec3 across = glm::normalize(glm::dvec3(1, 2, 3)), along(2, -1, 0);
    const Cage plane =
        shapes::grid(5, [&](double u, double v) { return u * along + v * glm::cross(across, along); });
    const scene::Geometry geometry = refined_geometry(plane, 1e5);
    CHECK(geometry.triangles.size() == 50);
    for (std::size_t i = 0; i < geometry.positions.size(); ++i) {
        CHECK(std::abs(glm::dot(geometry.positions[i], across)) < 1e-6);
        CHECK(glm::dot(glm::dvec3(geometry.normals[i]), across) > 0.99999);
        const double u = glm::dot(geometry.positions[i], along) / 5;
        CHECK(geometry.texcoords[i].x == doctest::Approx(u).epsilon(0.1));
    }
}

TEST_CASE("a cylinder's triangles come closer to its radius the more there are") {
    double before = 1;
    for (const double count : {100.0, 1000.0, 10000.0}) {
        const scene::Geometry geometry = refined_geometry(shapes::cylinder(), count);
        const double off = off_cylinder(geometry);
        CHECK(off < before / 3);
        before = off;
    }
    CHECK(before < 4e-4);
}

TEST_CASE("triangles are long along a cylinder, and even on a ball") {
    const scene::Geometry tube = refined_geometry(shapes::cylinder(), 2000);
    CHECK(slenderness(tube) > 8);
    CHECK(off_cylinder(tube) < 2e-4);  // halved evenly, it would take four times as many
    std::size_t across = 0;            // of the edges that bend, few lie askew
    for (const glm::uvec3& t : tube.triangles)
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 edge = tube.positions[t[k]] - tube.positions[t[(k + 1) % 3]];
            if (std::abs(edge.y) < 1e-6) ++across;
        }
    CHECK(across > tube.triangles.size() / 2);
    CHECK(slenderness(refined_geometry(shapes::cube(), 5000)) < 2);
}

TEST_CASE("the coarser of two parts has fewer triangles, and the same asked for gives the same") {
    AdaptiveMesh fine(shapes::cube()), coarse(shapes::cube());
    std::vector<RefinedPart> parts = {{&fine, 1, 1}, {&coarse, 4, 2}};
    Refinement refinement(parts);
    refinement.refine_to(10000);
    CHECK(refinement.count() == doctest::Approx(10000).epsilon(0.01));
    CHECK(refinement.reached() > 0);
    CHECK(fine.triangles().size() > 3 * coarse.triangles().size());
    const scene::Geometry once = refined_geometry(shapes::cube(), 777),
                          again = refined_geometry(shapes::cube(), 777);
    CHECK(once.positions == again.positions);
    CHECK(once.triangles == again.triangles);
}
