#include "plan/mirror_plan.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "mirror_scenes.hpp"
#include "shapes.hpp"
#include "views.hpp"

using namespace vrut;
using namespace vrut::mirror_scenes;

TEST_CASE("curved reflective parts are no mirrors, nor is anything in a stylized picture") {
    plan::View view = view_from({1, 1, 5});
    const auto ball = [](double reflectivity) {
        return std::vector<Part>{{1, sphere(1, 8), mirror_of(reflectivity), glm::dmat4(1)},
                                 floor_mirror(2, 0.5)};
    };
    CHECK(plan_of(ball(1), view).scene.mirrors.size() == 1);
    scene::Geometry bent = quad(1);
    bent.positions[0].z += 0.01;
    CHECK(plan_of({{1, bent, mirror_of(1), glm::dmat4(1)}}, view).scene.mirrors.empty());
    // Planarity is the geometry's own, whatever its matrix does: what is pressed flat is no mirror.
    CHECK(plan_of({{1, bent, mirror_of(1), scaled_by({1, 1, 0})}}, view).scene.mirrors.empty());
    CHECK(plan_of({{1, sphere(1, 8), mirror_of(1), scaled_by({1, 1, 0})}}, view).scene.mirrors.empty());
    view.mode = plan::DrawMode::stylized;
    CHECK(plan_of(ball(1), view).scene.mirrors.empty());
    view.mode = plan::DrawMode::realistic;
    view.wireframe = true;
    CHECK(plan_of(ball(1), view).scene.mirrors.empty());
}

TEST_CASE("what a mirror cannot show is not drawn for it") {
    const plan::View view = view_from({0, 2, 5});
    const auto reflected = [&](const glm::dvec3& at) {
        const plan::FramePlan plan =
            plan_of({floor_mirror(1, 1), {2, sphere(0.3, 6), kRed, moved_by(at)}}, view);
        CHECK(plan.scene.mirrors.size() == 1);
        return plan.scene.mirrors[0].reflected.opaque;
    };
    CHECK(reflected({0, 0.5, 0}).size() == 1);
    CHECK(reflected({0, 0.5, 0})[0].clip_planes.empty());
    CHECK(reflected({0, 0.1, 0})[0].clip_planes.size() == 1);
    CHECK(reflected({0, -0.5, 0}).empty());
    CHECK(reflected({0, 0.5, 9}).empty());  // behind the eye, where the floor does not show it
    CHECK(reflected({9, 0.5, 0}).empty());
    // Above the picture, but the floor shows it.
    CHECK(reflected({0, 3.5, -6}).size() == 1);
}

TEST_CASE("of a hundred mirrors the largest in the picture show a reflection") {
    const plan::View view = view_from({0, 0, 12});
    const std::vector<Part> parts = hundred_mirrors();
    const plan::FramePlan plan = plan_of(parts, view);
    REQUIRE(plan.scene.mirrors.size() == plan::kMaxMirrors);
    CHECK(plan.scene.opaque.size() == parts.size() - plan::kMaxMirrors);
    // Nodes stand by rising id behind the root. A plate's area shrinks with the sine of the angle between it
    // and the ray.
    const auto area = [&](const plan::DrawItem& item) {
        if (item.node > 100) return 0.0;
        const Part& part = parts[static_cast<std::size_t>(item.node)];
        const glm::dvec3 to_eye = view.camera.eye - glm::dvec3(part.matrix[3]);
        const double half = part.geometry.bounds.max.x;
        return half * half * std::abs(glm::dot(to_eye, glm::dvec3(part.matrix[2])));
    };
    double smallest = 1e9, largest_left = 0;
    for (const plan::MirrorItem& mirror : plan.scene.mirrors)
        smallest = std::min(smallest, area(mirror.surface));
    for (const plan::DrawItem& item : plan.scene.opaque) largest_left = std::max(largest_left, area(item));
    CHECK(smallest > 0.98 * largest_left);

    // The others reflect the panorama, where there is one; in a mirror no mirror does.
    const auto reflecting = [](const std::vector<plan::DrawItem>& items) {
        return std::count_if(items.begin(), items.end(),
                             [](const plan::DrawItem& item) { return item.environment; });
    };
    CHECK(reflecting(plan.scene.opaque) == 0);
    plan::View around = view;
    around.background.cube_map.emplace();
    const plan::FramePlan panoramic = plan_of(parts, around);
    CHECK(reflecting(panoramic.scene.opaque) == static_cast<std::ptrdiff_t>(101 - plan::kMaxMirrors));
    for (const plan::MirrorItem& mirror : panoramic.scene.mirrors) {
        CHECK_FALSE(mirror.surface.environment);
        CHECK(reflecting(mirror.reflected.opaque) == 0);
    }
}
