#include "reference/traced_scene.hpp"

#include <doctest/doctest.h>

#include <random>

#include "shapes.hpp"

using namespace vrut;

namespace {

/// Distance to a triangle by Möller and Trumbore; infinite where it is missed.
double distance_to(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& origin,
                   const glm::dvec3& direction) {
    const glm::dvec3 ab = b - a, ac = c - a, p = glm::cross(direction, ac);
    const double determinant = glm::dot(ab, p);
    const glm::dvec3 from = origin - a, q = glm::cross(from, ab);
    const double u = glm::dot(from, p) / determinant, v = glm::dot(direction, q) / determinant;
    const double t = glm::dot(ac, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : std::numeric_limits<double>::infinity();
}

scene::Geometry soup(std::mt19937& random, int triangles) {
    std::uniform_real_distribution<double> far(-10, 10), near(-2, 2);
    scene::Geometry geometry;
    for (int i = 0; i < triangles; ++i) {
        const glm::dvec3 center(far(random), far(random), far(random));
        const auto at = static_cast<unsigned>(geometry.positions.size());
        geometry.triangles.emplace_back(at, at + 1, at + 2);
        for (int k = 0; k < 3; ++k) {
            geometry.positions.push_back(center + glm::dvec3(near(random), near(random), near(random)));
            geometry.bounds.add(geometry.positions.back());
        }
    }
    return geometry;
}

}  // namespace

TEST_CASE("the tree finds what trying each triangle finds") {
    std::mt19937 random(11);
    std::normal_distribution<double> any(0, 1);
    int hits = 0;
    for (const int count : {1, 2, 5, 40, 3000}) {
        scene::Geometry geometry = soup(random, count);
        scene::Material material = material_of({1, 1, 1});
        material.two_sided = true;
        scene::Material glass = material;
        glass.diffuse.a = 0.5;
        plan::View view;
        view.camera.eye = {1, 2, 3};
        view.scene =
            scene_of({{1, geometry, material, glm::dmat4(1)}, {2, geometry, glass, moved_by({0, 9, 0})}});
        const reference::TracedScene surfaces(view);
        for (int i = 0; i < 400; ++i) {
            const reference::RayDifferential ray{
                glm::dvec3(any(random), any(random), any(random)) * 5.0,
                glm::normalize(i % 10 == 0 ? glm::dvec3(0, 0, i % 20 ? 1 : -1)
                                           : glm::dvec3(any(random), any(random), any(random))),
                {},
                {}};
            const auto nearest_of = [&](const reference::TracedInstance& part, std::vector<double>* all) {
                double nearest = std::numeric_limits<double>::infinity();
                for (const glm::uvec3& t : geometry.triangles) {
                    const double d = distance_to(part.positions[t.x], part.positions[t.y],
                                                 part.positions[t.z], ray.origin, ray.direction);
                    nearest = std::min(nearest, d);
                    if (all && std::isfinite(d)) all->push_back(d);
                }
                return nearest;
            };
            const double nearest = nearest_of(surfaces.parts()[0], nullptr);
            const auto found = surfaces.closest_opaque_hit(ray);
            REQUIRE(found.has_value() == std::isfinite(nearest));
            if (found) CHECK(found->distance == doctest::Approx(nearest).epsilon(1e-9));
            hits += found.has_value();

            std::vector<double> layers;
            nearest_of(surfaces.parts()[1], &layers);
            std::erase_if(layers, [&](double d) { return d > nearest; });
            std::sort(layers.begin(), layers.end());
            const auto between = surfaces.transparent_hits_before(ray, found);
            REQUIRE(between.size() == layers.size());
            for (std::size_t k = 0; k < layers.size(); ++k)
                CHECK(between[k].distance == doctest::Approx(layers[k]).epsilon(1e-9));
        }
    }
    CHECK(hits > 300);
}
