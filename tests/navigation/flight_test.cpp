#include "navigation/flight.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "near.hpp"

using namespace vrut;

namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }
double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// Level and upright, `azimuth` degrees to the right of +z and `elevation` above the horizon.
scene::Camera around(double azimuth, double elevation = 0, double distance = 5,
                     const glm::dvec3& focus = {0, 0, 0}) {
    const double a = radians(azimuth), e = radians(elevation);
    scene::Camera camera;
    camera.focus = focus;
    const glm::dvec3 out(std::sin(a), 0, std::cos(a));
    camera.eye = focus + (out * std::cos(e) + glm::dvec3(0, std::sin(e), 0)) * distance;
    camera.up = -out * std::sin(e) + glm::dvec3(0, std::cos(e), 0);
    return scene::with_orthogonal_up(camera);
}

double azimuth_of(const scene::Camera& camera) {
    const glm::dvec3 out = camera.eye - camera.focus;
    return degrees(std::atan2(out.x, out.z));
}
double elevation_of(const scene::Camera& camera) {
    return degrees(std::asin(-scene::view_direction(camera).y));
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double number(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    glm::dvec3 vector(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }

private:
    std::mt19937 engine_;
};

}  // namespace

TEST_CASE("half of a quarter orbit lies at 45 degrees, at the same radius") {
    for (const navigation::Easing easing : {navigation::Easing::smooth, navigation::Easing::linear}) {
        const navigation::CameraPath flight(around(0), {{1000, around(90)}}, easing);
        CHECK(flight.duration() == 1000);
        const scene::Camera half = flight.at(500);
        CHECK(near(half.eye, {5 / std::sqrt(2.0), 0, 5 / std::sqrt(2.0)}));
        CHECK(half.focus == glm::dvec3(0));
        CHECK(half.up == glm::dvec3(0, 1, 0));
    }
}

TEST_CASE("one way is a smoothstep, or straight") {
    const navigation::CameraPath smooth(around(0), {{1000, around(64)}}, navigation::Easing::smooth);
    CHECK(azimuth_of(smooth.at(250)) == doctest::Approx(10).epsilon(1e-12));  // 3/16 - 2/64 = 10/64
    CHECK(azimuth_of(smooth.at(750)) == doctest::Approx(54).epsilon(1e-12));
    CHECK(azimuth_of(smooth.at(1)) < 64 * 3e-6);  // starts softly
    CHECK(azimuth_of(smooth.at(999)) > 64 * (1 - 3e-6));
    const navigation::CameraPath linear(around(0), {{1000, around(64)}}, navigation::Easing::linear);
    CHECK(azimuth_of(linear.at(250)) == doctest::Approx(16).epsilon(1e-12));
    CHECK(azimuth_of(linear.at(1)) == doctest::Approx(0.064).epsilon(1e-12));
}

TEST_CASE("the distance goes by equal factors, focus, centre and fov go straight") {
    scene::Camera from = around(30, 10, 1), to = around(30, 10, 4, {4, 8, -12});
    to.center = {1, 2, 3};
    from.fov = 20;
    to.fov = 60;
    const navigation::CameraPath flight(from, {{1000, to}}, navigation::Easing::linear);
    CHECK(scene::focus_distance(flight.at(500)) == doctest::Approx(2).epsilon(1e-13));
    CHECK(scene::focus_distance(flight.at(250)) == doctest::Approx(std::sqrt(2.0)).epsilon(1e-13));
    CHECK(near(flight.at(250).focus, {1, 2, -3}));
    CHECK(near(flight.at(250).center, {0.25, 0.5, 0.75}));
    CHECK(flight.at(250).fov == doctest::Approx(30).epsilon(1e-14));
    CHECK(near(scene::view_direction(flight.at(250)), scene::view_direction(from)));
}

TEST_CASE("keyframes are passed exactly, and the ends stay") {
    Random random(3);
    std::vector<navigation::CameraKeyframe> keyframes;
    for (const double at : {0.1, 7.0, 1000 / 3.0, 1e6}) {
        scene::Camera camera;
        camera.eye = random.vector(10);
        camera.focus = random.vector(10);
        camera.center = random.vector(10);
        camera.up = random.vector(1);
        camera.fov = random.number(1, 170);
        keyframes.push_back({at, scene::with_orthogonal_up(camera)});
    }
    const scene::Camera from = around(20, 30);
    for (const navigation::Easing easing : {navigation::Easing::smooth, navigation::Easing::linear}) {
        const navigation::CameraPath flight(from, keyframes, easing);
        CHECK(flight.duration() == 1e6);
        CHECK(flight.at(-1) == from);
        CHECK(flight.at(0) == from);
        for (const navigation::CameraKeyframe& key : keyframes) {
            CHECK(flight.at(key.at) == key.camera);
            // Nor does it jump there.
            CHECK(near(flight.at(key.at * (1 - 1e-13)).eye, key.camera.eye, 1e-9));
            CHECK(near(flight.at(key.at * (1 + 1e-13)).eye, key.camera.eye, 1e-9));
        }
        CHECK(flight.at(1e6 + 1e-9) == keyframes.back().camera);
        CHECK(flight.at(1e300) == keyframes.back().camera);
        const scene::Camera before = flight.at(123.456);
        flight.at(5);
        CHECK(flight.at(123.456) == before);
    }
}

TEST_CASE("a keyframe at the start is a jump; without keyframes there is no way") {
    const scene::Camera from = around(0), first = around(40), last = around(80);
    const navigation::CameraPath flight(from, {{0, first}, {100, last}}, navigation::Easing::linear);
    CHECK(flight.at(-1) == first);
    CHECK(flight.at(0) == first);
    CHECK(azimuth_of(flight.at(50)) == doctest::Approx(60).epsilon(1e-12));
    const navigation::CameraPath jump(from, {{0, first}}, navigation::Easing::smooth);
    CHECK(jump.duration() == 0);
    CHECK(jump.at(0) == first);
    CHECK(jump.at(1) == first);
    const navigation::CameraPath none(from, {}, navigation::Easing::smooth);
    CHECK(none.duration() == 0);
    CHECK(none.at(5) == from);
}

TEST_CASE("smooth passes a keyframe between without a stop") {
    SUBCASE("equal times") {
        const navigation::CameraPath flight(around(0), {{1000, around(64)}, {2000, around(128)}},
                                            navigation::Easing::smooth);
        // The slope there is one keyframe in 1000 ms: 1/2 - 1/8 and 1 + 1/2 + 1/8.
        CHECK(azimuth_of(flight.at(500)) == doctest::Approx(24).epsilon(1e-12));
        CHECK(azimuth_of(flight.at(1500)) == doctest::Approx(104).epsilon(1e-12));
        CHECK(azimuth_of(flight.at(1001)) - azimuth_of(flight.at(999)) ==
              doctest::Approx(0.128127872).epsilon(1e-9));  // 2t² - t³
    }
    SUBCASE("unequal times") {
        const navigation::CameraPath flight(around(0), {{1000, around(64)}, {4000, around(128)}},
                                            navigation::Easing::smooth);
        // The harmonic mean of 1/1000 and 1/3000 is 1/2000: 1/2 - 1/16 and 1 + 1/2 + 3/16.
        CHECK(azimuth_of(flight.at(500)) == doctest::Approx(28).epsilon(1e-12));
        CHECK(azimuth_of(flight.at(2500)) == doctest::Approx(108).epsilon(1e-12));
        CHECK(azimuth_of(flight.at(1000)) - azimuth_of(flight.at(999)) ==
              doctest::Approx(0.032).epsilon(1e-2));
        CHECK(azimuth_of(flight.at(1001)) - azimuth_of(flight.at(1000)) ==
              doctest::Approx(0.032).epsilon(1e-2));
    }
    SUBCASE("linear") {
        const navigation::CameraPath flight(around(0), {{1000, around(64)}, {4000, around(128)}},
                                            navigation::Easing::linear);
        CHECK(azimuth_of(flight.at(500)) == doctest::Approx(32).epsilon(1e-12));
        CHECK(azimuth_of(flight.at(2500)) == doctest::Approx(96).epsilon(1e-12));
    }
}

TEST_CASE("nothing turns back on the way") {
    Random random(4);
    for (int round = 0; round < 100; ++round) {
        std::vector<navigation::CameraKeyframe> keyframes;
        double at = 0, azimuth = -170;
        for (int i = 0; i < 6; ++i) {
            at += std::pow(10, random.number(0, 4));
            azimuth += random.number(1, 50);
            keyframes.push_back({at, around(azimuth)});
        }
        const navigation::CameraPath flight(
            around(-170), keyframes,
            round % 2 == 0 ? navigation::Easing::smooth : navigation::Easing::linear);
        double last = -170;
        for (int i = 1; i < 500; ++i) {
            const double now = azimuth_of(flight.at(at * i / 500));
            CHECK(now > last);
            last = now;
        }
    }
}

TEST_CASE("level cameras turn by azimuth, the shorter way, and elevation; the horizon stays level") {
    const auto half = [](const scene::Camera& from, const scene::Camera& to) {
        return navigation::CameraPath(from, {{1000, to}}, navigation::Easing::smooth).at(500);
    };
    CHECK(near(half(around(170), around(-170)).eye, {0, 0, -5}));
    CHECK(near(half(around(-10), around(10)).eye, {0, 0, 5}));
    const scene::Camera raised = half(around(0, 20), around(60, 50));
    CHECK(azimuth_of(raised) == doctest::Approx(30).epsilon(1e-12));
    CHECK(elevation_of(raised) == doctest::Approx(35).epsilon(1e-12));

    // Straight up and down are no exception: the up vector tells the azimuth there.
    CHECK(near(half(around(0), around(0, 90)).eye, {0, 5 / std::sqrt(2.0), 5 / std::sqrt(2.0)}));
    const scene::Camera to_top = half(around(20, 0), around(80, 90));
    CHECK(azimuth_of(to_top) == doctest::Approx(50).epsilon(1e-12));
    CHECK(elevation_of(to_top) == doctest::Approx(45).epsilon(1e-12));
    CHECK(near(half(around(30, 90), around(30, -90)).eye, around(30).eye));

    Random random(5);
    for (int round = 0; round < 200; ++round) {
        const scene::Camera from =
            around(random.number(-180, 180), random.number(-90, 90), random.number(1, 9));
        const scene::Camera to =
            around(random.number(-180, 180), random.number(-90, 90), random.number(1, 9));
        const navigation::CameraPath flight(from, {{1000, to}}, navigation::Easing::smooth);
        for (const double at : {1.0, 100.0, 400.0, 600.0, 999.0}) {
            const scene::Camera camera = flight.at(at);
            CHECK(std::abs(scene::right_direction(camera).y) < 1e-12);
            CHECK(camera.up.y > 0);
            CHECK(elevation_of(camera) <= std::max(elevation_of(from), elevation_of(to)) + 1e-6);
            CHECK(elevation_of(camera) >= std::min(elevation_of(from), elevation_of(to)) - 1e-6);
        }
    }
}

TEST_CASE("a camera that is not level turns as a whole") {
    const auto half = [](const scene::Camera& from, const scene::Camera& to) {
        return navigation::CameraPath(from, {{1000, to}}, navigation::Easing::smooth).at(500);
    };
    scene::Camera rolled = around(0);
    rolled.up = {1, 0, 0};
    const scene::Camera tilted = half(around(0), rolled);
    CHECK(near(tilted.eye, {0, 0, 5}));
    CHECK(near(tilted.up, {1 / std::sqrt(2.0), 1 / std::sqrt(2.0), 0}));

    // A third of a turn about the diagonal takes x to y, y to z and z to x: half of it is 60 degrees.
    scene::Camera third;
    third.eye = {5, 0, 0};
    third.up = {0, 0, 1};
    const scene::Camera sixth = half(around(0), third);
    CHECK(near(sixth.eye, glm::dvec3(2, -1, 2) * (5.0 / 3)));
    CHECK(near(sixth.up, glm::dvec3(-1, 2, 2) / 3.0));

    // On its head: half a turn about the view, one way or the other.
    scene::Camera head = around(0);
    head.up = {0, -1, 0};
    const scene::Camera side = half(around(0), head);
    CHECK(near(side.eye, {0, 0, 5}));
    CHECK(std::abs(side.up.x) == doctest::Approx(1).epsilon(1e-12));

    // Hardly turned at all.
    for (const double roll : {1e-6, 1e-8, 3e-8, 1e-12}) {
        scene::Camera almost = rolled;
        almost.up = {std::cos(roll), std::sin(roll), 0};
        CHECK(near(half(rolled, almost).up, {1, roll / 2, 0}));
    }
}

TEST_CASE("every pose on the way is valid, however extreme the ends") {
    Random random(6);
    const auto extreme = [&] {
        const double distance = std::pow(10, random.number(-6, 6));
        const double elevations[] = {-90, -89.999999, 0, 30, 90};
        const double azimuths[] = {-180, -90, 0, 90, 180, 12.3};
        scene::Camera camera = around(azimuths[static_cast<int>(random.number(0, 5.99))],
                                      elevations[static_cast<int>(random.number(0, 4.99))], distance,
                                      random.vector(std::pow(10, random.number(-6, 3))));
        if (random.number(0, 1) < 0.3) camera.up = -camera.up;
        if (random.number(0, 1) < 0.3) camera.up = random.vector(1);
        camera.fov = random.number(0, 1) < 0.5 ? 1 : 170;
        return scene::is_valid_pose(camera, 0) ? scene::with_orthogonal_up(camera) : scene::Camera{};
    };
    for (int round = 0; round < 3000; ++round) {
        const scene::Camera from = extreme(), to = extreme();
        const navigation::CameraPath flight(
            from, {{1000, to}}, round % 2 == 0 ? navigation::Easing::smooth : navigation::Easing::linear);
        for (const double at : {1e-9, 0.5, 250.0, 500.0, 700.0, 999.999999}) {
            const scene::Camera camera = flight.at(at);
            REQUIRE(scene::is_valid_pose(camera, 0));
            CHECK(std::abs(glm::length(camera.up) - 1) < 1e-12);
            CHECK(std::abs(glm::dot(camera.up, scene::view_direction(camera))) < 1e-12);
            CHECK(camera.fov >= 1);
            CHECK(camera.fov <= 170);
        }
    }
    // A hair's breadth from something here to something very far away.
    const navigation::CameraPath flight(
        around(0, 0, 1e-14), {{1000, around(90, 0, 1e-3, {1e12, 1e12, 1e12})}}, navigation::Easing::linear);
    for (int at = 0; at <= 1000; ++at) CHECK(scene::is_valid_pose(flight.at(at), 0));
}
