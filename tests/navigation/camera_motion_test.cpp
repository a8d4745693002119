#include "navigation/camera_motion.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "navigation/camera_moves.hpp"
#include "near.hpp"

using namespace vrut;
using navigation::CameraMotion;

namespace {

constexpr double kRefresh = 16;

scene::Camera turned(double degrees, double above = 0) {
    return navigation::rotated({{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, {0, 0, 0}, 40}, degrees, above, true);
}

double degrees_between(const scene::Camera& a, const scene::Camera& b) {
    return 2 * std::asin(glm::distance(scene::view_direction(a), scene::view_direction(b)) / 2) * 180 /
           std::numbers::pi;
}

/// A turn by these degrees, one refresh after the other.
CameraMotion motion_of(std::initializer_list<double> degrees) {
    CameraMotion motion;
    double ms = 0;
    for (const double each : degrees) motion.add(ms += kRefresh, turned(each));
    return motion;
}

}  // namespace

TEST_CASE("an even turn goes on as fast") {
    const CameraMotion motion = motion_of({0, 1, 2, 3});
    const std::optional<scene::Camera> ahead = motion.ahead(4 * kRefresh, 10 * kRefresh);
    REQUIRE(ahead);
    CHECK(near(ahead->eye, turned(13).eye, 1e-3));
    CHECK(near(ahead->up, turned(13).up, 1e-3));
    CHECK(ahead->focus == glm::dvec3(0));
    SUBCASE("from when its last step was made") {
        CHECK(near(motion.ahead(5 * kRefresh, 9 * kRefresh)->eye, ahead->eye));
    }
}

TEST_CASE("a move and a zoom go on as fast") {
    CameraMotion move, zoom;
    for (int i = 0; i < 4; ++i) {
        scene::Camera camera = turned(0);
        const glm::dvec3 by(0.01 * i, 0.02 * i, 0);
        camera.eye += by;
        camera.focus += by;
        move.add(i * kRefresh, camera);
        camera = turned(0);
        camera.eye.z = 5 * std::pow(0.98, i);
        zoom.add(i * kRefresh, camera);
    }
    CHECK(near(move.ahead(3 * kRefresh, 2 * kRefresh)->eye, {0.05, 0.1, 5}, 1e-9));
    CHECK(near(zoom.ahead(3 * kRefresh, 2 * kRefresh)->eye, {0, 0, 5 * std::pow(0.98, 5)}, 1e-9));
}

TEST_CASE("what stands still or has just begun is where it is") {
    CHECK_FALSE(CameraMotion().ahead(0, 100));
    CHECK_FALSE(motion_of({0}).ahead(kRefresh, 100));
    CHECK_FALSE(motion_of({0, 1}).ahead(2 * kRefresh, 100));
    CHECK_FALSE(motion_of({0, 1, 2}).ahead(6 * kRefresh, 100));
    CameraMotion motion = motion_of({0, 1, 2});
    for (int i = 4; i < 8; ++i) motion.add(i * kRefresh, turned(2));
    CHECK_FALSE(motion.ahead(7 * kRefresh, 100));
}

TEST_CASE("a jump is no motion") {
    CHECK_FALSE(motion_of({0, 0.001, 90}).ahead(3 * kRefresh, 10));
    CameraMotion rest;
    rest.add(0, turned(0));
    rest.add(1, turned(90));
    rest.add(60'000, turned(0));
    CHECK_FALSE(rest.ahead(60'000, 10));
    // In a drag it goes on twice as fast as the drag.
    const scene::Camera jumped = *motion_of({0, 1, 90}).ahead(3 * kRefresh, kRefresh);
    CHECK(degrees_between(jumped, turned(90)) == doctest::Approx(2).epsilon(0.01));
}

TEST_CASE("nothing turns by more than 45 degrees ahead, or over the top") {
    const CameraMotion fast = motion_of({0, 20, 40});
    CHECK(degrees_between(*fast.ahead(3 * kRefresh, 1e6), turned(40)) <= 45.1);
    CameraMotion up;
    for (int i = 0; i < 3; ++i) up.add(i * kRefresh, turned(0, -80 - i));
    const scene::Camera ahead = *up.ahead(2 * kRefresh, 20 * kRefresh);
    CHECK(ahead.up.y >= -1e-9);
    CHECK(scene::is_valid_pose(ahead, 1));
}

TEST_CASE("messages that come together are one step") {
    // Every second refresh two of them come.
    CameraMotion motion;
    double degrees = 0;
    for (double ms = 0; ms < 200; ms += 2 * kRefresh)
        for (const double later : {0.0, 0.2}) motion.add(ms + later, turned(++degrees));
    const double last = 192;
    CHECK(degrees_between(*motion.ahead(last + 0.2, 100), turned(degrees)) ==
          doctest::Approx(2 * 100 / (2 * kRefresh)).epsilon(0.02));
}

TEST_CASE("whatever the camera does, what is ahead is a camera") {
    CameraMotion motion;
    scene::Camera camera = turned(0);
    for (int i = 0; i < 2000; ++i) {
        const double a = std::sin(i * 12.9898) * 90, b = std::sin(i * 78.233) * 60;
        camera = navigation::rotated(camera, a, b, i % 3 != 0);
        if (i % 7 == 0) camera.eye = camera.focus + (camera.eye - camera.focus) * std::exp(b / 3);
        if (!scene::is_valid_pose(camera, 1e-12)) camera = turned(a);
        camera.fov = i % 11 == 0 ? 170 : 1;
        motion.add(i * 9, camera);
        const auto ahead = motion.ahead(i * 9, 300);
        if (!ahead) continue;
        CAPTURE(i);
        CHECK(scene::is_valid_pose(*ahead, 0));
        CHECK((ahead->fov >= 1 && ahead->fov <= 170));
        CHECK(std::abs(glm::dot(ahead->up, scene::view_direction(*ahead))) < 1e-6);
    }
}
