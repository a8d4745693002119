#include "scene/clip_plane.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <vector>

using namespace vrut;

namespace {

const scene::ClipPlane kTop{{0, 1, 0}, 2};

bool is_shown(const std::vector<scene::ClipPlane>& planes, const glm::dvec3& point) {
    for (const scene::ClipPlane& plane : planes)
        if (glm::dot(plane.normal, point) > plane.distance) return false;
    return true;
}

}  // namespace

TEST_CASE("without planes all of a ray is left, and no cap") {
    const auto kept = scene::kept_interval({}, {1, 2, 3}, {0, 0, 1});
    REQUIRE(kept);
    CHECK(kept->first == 0);
    CHECK(std::isinf(kept->last));
    CHECK(!kept->cap);
}

TEST_CASE("a ray from above enters through the plane, and leaves through the other") {
    const std::vector<scene::ClipPlane> planes{kTop, {{0, -1, 0}, 3}};
    const auto kept = scene::kept_interval(planes, {0, 10, 0}, {0, -1, 0});
    REQUIRE(kept);
    CHECK(kept->first == 8);
    CHECK(kept->last == 13);
    CHECK(kept->cap == std::size_t{0});
}

TEST_CASE("a ray from within meets no cap") {
    const auto kept = scene::kept_interval(std::vector{kTop}, {0, 0, 0}, {0, 1, 0});
    REQUIRE(kept);
    CHECK(kept->first == 0);
    CHECK(kept->last == 2);
    CHECK(!kept->cap);
}

TEST_CASE("nothing is left of rays beyond a plane, along it and away from it, nor between planes that part") {
    CHECK(!scene::kept_interval(std::vector{kTop}, {0, 3, 0}, {0, 1, 0}));
    CHECK(!scene::kept_interval(std::vector{kTop}, {0, 3, 0}, {1, 0, 0}));
    const std::vector<scene::ClipPlane> apart{{{1, 0, 0}, -1}, {{-1, 0, 0}, -1}};
    CHECK(!scene::kept_interval(apart, {-5, 0, 0}, {1, 0, 0}));
}

TEST_CASE("the interval holds what lies on this side of all planes") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-3, 3);
    const auto vector = [&] { return glm::dvec3(any(random), any(random), any(random)); };
    for (int round = 0; round < 500; ++round) {
        std::vector<scene::ClipPlane> planes;
        for (int i = 0; i < round % 5; ++i) planes.push_back({glm::normalize(vector()), any(random)});
        const glm::dvec3 origin = vector(), direction = glm::normalize(vector());
        const auto kept = scene::kept_interval(planes, origin, direction);
        for (double distance = 0.01; distance < 10; distance += 0.37) {
            const bool within = kept && kept->first <= distance && distance <= kept->last;
            CHECK(within == is_shown(planes, origin + distance * direction));
        }
        if (kept && kept->cap) {
            const glm::dvec3 at = origin + kept->first * direction;
            CHECK(glm::dot(planes[*kept->cap].normal, at) == doctest::Approx(planes[*kept->cap].distance));
        }
    }
}

TEST_CASE("the equation in a node's space tells what the plane tells in the world") {
    glm::dmat4 world = glm::translate(glm::dmat4(1), glm::dvec3(1e7, -2e7, 5e6));
    world = glm::scale(glm::rotate(world, 0.7, glm::normalize(glm::dvec3(1, 2, 3))), glm::dvec3(2, -0.5, 1));
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1, -1, 0.3)), point(0.3, -0.2, 0.9);
    const scene::ClipPlane plane{normal, glm::dot(normal, glm::dvec3(world[3]))};
    const glm::dvec4 equation = scene::clip_equation(plane, world);
    const double beyond = glm::dot(normal, glm::dmat3(world) * point);
    CHECK(glm::dot(equation, glm::dvec4(point, 1)) == doctest::Approx(-beyond).epsilon(1e-7));
}

TEST_CASE("a cap has a part's colours, and nothing of what lies on its surface") {
    scene::Material glass;
    glass.diffuse = {0.1, 0.2, 0.3, 0.4};
    glass.ambient = {0.1, 0.1, 0.1, 1};
    glass.specular = {1, 1, 1, 1};
    glass.shininess = 80;
    glass.reflectivity = 0.5;
    glass.texture = 3;
    glass.two_sided = true;
    glass.metallic_roughness = scene::MetallicRoughness{};
    const scene::Material cap = scene::cap_material(glass);
    CHECK(cap.diffuse == glm::dvec4(0.1, 0.2, 0.3, 1));
    CHECK(cap.ambient == glass.ambient);
    CHECK(cap.specular == glm::dvec4(0, 0, 0, 1));
    CHECK(cap.reflectivity == 0);
    CHECK(cap.texture == scene::kNone);
    CHECK(!cap.two_sided);
    CHECK(!cap.metallic_roughness);
}
