#include "scene/camera.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "navigation/camera_moves.hpp"
#include "near.hpp"

using namespace vrut;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double degrees(double value) { return value * std::numbers::pi / 180; }

/// Where the camera sees a point: right and up in halves of the view's height, and how far along the view.
glm::dvec3 seen(const scene::Camera& camera, const glm::dvec3& point) {
    const glm::dvec3 view = glm::normalize(camera.focus - camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(view, camera.up));
    const glm::dvec3 from_eye = point - camera.eye;
    const double depth = glm::dot(from_eye, view);
    const double half_height = depth * std::tan(degrees(camera.fov) / 2);
    return {glm::dot(from_eye, right) / half_height,
            glm::dot(from_eye, glm::cross(right, view)) / half_height, depth};
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double number(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    glm::dvec3 vector(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }
    scene::Camera camera() {
        scene::Camera result;
        result.eye = vector(10);
        result.focus = result.eye + vector(10);
        result.center = vector(10);
        result.up = vector(1);
        result.fov = number(10, 120);
        return scene::with_orthogonal_up(result);
    }

private:
    std::mt19937 engine_;
};

void check_frame(const scene::Camera& camera) {
    CHECK(std::abs(glm::length(camera.up) - 1) < 1e-12);
    CHECK(std::abs(glm::dot(camera.up, scene::view_direction(camera))) < 1e-12);
}

scene::PlacedScene scene_of(std::vector<scene::SceneParts::PartNode> nodes) {
    scene::SceneParts parts;
    parts.nodes = std::move(nodes);
    auto scene = scene::Scene::build(std::move(parts));
    REQUIRE(scene);
    return scene::place(*std::move(scene));
}

scene::SceneParts::PartNode camera_part(scene::Id id, scene::Id parent, const scene::CameraData& data) {
    return {scene::Node{id, {}, scene::NodeType::camera, scene::kNone, {}, true, glm::dmat4(1), data},
            parent};
}

}  // namespace

TEST_CASE("fit: the box fills 84 % of the width or the height, in the middle") {
    Random random(1);
    for (const double fov : {1.0, 20.0, 40.0, 90.0, 170.0})
        for (const double aspect : {0.01, 0.5, 1.0, 16.0 / 9, 100.0}) {
            scene::Camera before = random.camera();
            before.fov = fov;
            math::Bounds box;
            box.add(random.vector(5));
            box.add(random.vector(50));
            const scene::Camera after = navigation::fitted(before, navigation::fit_target(box), aspect);
            glm::dvec3 low(kInfinity), high(-kInfinity);
            for (const glm::dvec3& corner : math::corners(box)) {
                low = glm::min(low, seen(after, corner));
                high = glm::max(high, seen(after, corner));
            }
            low.x /= aspect;
            high.x /= aspect;
            const double wide = std::max(high.x, -low.x), tall = std::max(high.y, -low.y);
            const double nearest = low.z / (0.1 * box.radius());
            CAPTURE(fov);
            CAPTURE(aspect);
            CHECK(wide <= 0.84 * (1 + 1e-9));
            CHECK(tall <= 0.84 * (1 + 1e-9));
            CHECK(nearest >= 1 - 1e-9);
            CHECK(std::max({wide / 0.84, tall / 0.84, 1 / nearest}) == doctest::Approx(1).epsilon(1e-9));
            if (wide > 0.84 * (1 - 1e-9)) CHECK(-low.x == doctest::Approx(high.x).epsilon(1e-9));
            if (tall > 0.84 * (1 - 1e-9)) CHECK(-low.y == doctest::Approx(high.y).epsilon(1e-9));
            CHECK(near(seen(after, after.focus), {0, 0, seen(after, box.center()).z}, 1e-9 * box.radius()));
            CHECK(after.center == box.center());
            CHECK(near(scene::view_direction(after), scene::view_direction(before)));
            CHECK(after.up == before.up);
            CHECK(after.fov == fov);
        }
}

TEST_CASE("fit: the box fills 84 % of what is free of the view, in its middle") {
    Random random(6);
    for (const navigation::Cover& cover :
         {navigation::Cover{0.3, 0.1, 0, 0.25}, {0, 0.5, 0, 0}, {0, 0, 0.6, 0.1}})
        for (const double aspect : {0.5, 1.0, 16.0 / 9}) {
            math::Bounds box;
            box.add(random.vector(5));
            box.add(random.vector(50));
            const scene::Camera after =
                navigation::fitted(random.camera(), navigation::fit_target(box), aspect, cover);
            glm::dvec2 low(kInfinity), high(-kInfinity);  // from 0 to 1 over the view
            for (const glm::dvec3& corner : math::corners(box)) {
                const glm::dvec3 place = seen(after, corner);
                low = glm::min(low, glm::dvec2(place.x / aspect, place.y) * 0.5 + 0.5);
                high = glm::max(high, glm::dvec2(place.x / aspect, place.y) * 0.5 + 0.5);
            }
            const glm::dvec2 free_low(cover.left, cover.bottom), free_high(1 - cover.right, 1 - cover.top);
            const glm::dvec2 margin = 0.08 * (free_high - free_low);
            CAPTURE(aspect);
            const glm::dvec2 below = low - free_low - margin, above = free_high - margin - high;
            for (const double rest : {below.x, below.y, above.x, above.y}) CHECK(rest > -1e-9);
            const bool full_width = below.x < 1e-9 && above.x < 1e-9,
                       full_height = below.y < 1e-9 && above.y < 1e-9;
            const bool nearest =
                seen(after, box.center()).z > 0 && !full_width && !full_height;  // a tenth of the radius
            CHECK((full_width || full_height || nearest));
            CHECK(near(seen(after, after.focus), {0, 0, seen(after, box.center()).z}, 1e-9 * box.radius()));
        }
}

TEST_CASE("looking around turns the view about the eye, and goes back to the same") {
    Random random(7);
    for (int round = 0; round < 200; ++round) {
        const scene::Camera before = random.camera();
        const scene::Camera right = navigation::looked_around(before, 30, 0, false);
        CHECK(right.eye == before.eye);
        CHECK(right.center == before.center);
        check_frame(right);
        const glm::dvec3 view = scene::view_direction(before), now = scene::view_direction(right);
        CHECK(glm::dot(view, now) == doctest::Approx(std::cos(degrees(30))));
        CHECK(glm::dot(now, scene::right_direction(before)) == doctest::Approx(0.5));
        const scene::Camera down = navigation::looked_around(before, 0, 30, false);
        CHECK(glm::dot(scene::view_direction(down), before.up) == doctest::Approx(-0.5));
        CHECK(near(navigation::looked_around(right, -30, 0, false).focus, before.focus, 1e-9 * 20));
    }
}

TEST_CASE("fit: nothing, a point, and a box far from the origin") {
    const scene::Camera camera;  // looks along -z
    const auto fitted = [&](const math::Bounds& box) {
        return navigation::fitted(camera, navigation::fit_target(box), 1);
    };
    // The front of a cube of side 2 fills 84 %.
    const double before_cube = 1 + 1 / (0.84 * std::tan(degrees(20)));
    CHECK(near(fitted({}).eye, {0, 0, before_cube}));
    CHECK(fitted({}).focus == glm::dvec3(0));
    math::Bounds point;
    point.add({3, 4, 5});
    CHECK(near(fitted(point).eye, {3, 4, 5 + before_cube}));
    for (const double far : {1e7, 1e12, 1e15, 1e30, 1e149})
        for (const double size : {0.0, 1e-6, 1.0}) {
            math::Bounds box;
            box.add({far, far, far});
            box.add({far + size, far, far});
            const scene::Camera fit = fitted(box);
            CHECK(scene::is_valid_pose(fit, box.radius()));
            CHECK(near(scene::view_direction(fit), {0, 0, -1}, 1e-3));
        }
}

TEST_CASE("near and far are tight around what is in front of the eye") {
    Random random(2);
    for (int round = 0; round < 2000; ++round) {
        const scene::Camera camera = random.camera();
        math::Bounds box;
        box.add(random.vector(20));
        box.add(random.vector(20));
        double nearest = kInfinity, farthest = -kInfinity;
        for (const glm::dvec3& corner : math::corners(box)) {
            nearest = std::min(nearest, seen(camera, corner).z);
            farthest = std::max(farthest, seen(camera, corner).z);
        }
        const scene::ClipRange range = scene::fit_clip_range(camera, box);
        CHECK(range.near > 0);
        CHECK(range.far > range.near);
        if (farthest <= 0) continue;
        CHECK(range.far >= farthest);
        CHECK(range.far < farthest * 1.01);
        if (nearest > 0) {
            CHECK(range.near <= nearest);
            CHECK(range.near > nearest * 0.99);
        } else {
            CHECK(range.near == doctest::Approx(range.far * 1e-6).epsilon(1e-9));
        }
    }
    // With the eye inside of something huge, what it looks at stays in view.
    math::Bounds huge;
    huge.add({-1e12, -1e12, -1e12});
    huge.add({1e12, 1e12, 1e12});
    CHECK(scene::fit_clip_range(scene::Camera{}, huge).near == doctest::Approx(5e-3));
    const scene::ClipRange empty = scene::fit_clip_range(scene::Camera{}, math::Bounds{});
    CHECK(empty.near > 0);
    CHECK(empty.far > 5);
}

TEST_CASE("the view matrix") {
    scene::Camera camera;
    camera.eye = {10, 2, 0};
    camera.focus = {7, 2, 0};
    const glm::dmat4 expected = glm::transpose(glm::dmat4(glm::dvec4(0, 0, -1, 0), glm::dvec4(0, 1, 0, -2),
                                                          glm::dvec4(1, 0, 0, -10), glm::dvec4(0, 0, 0, 1)));
    CHECK(scene::view_from_world(camera) == expected);

    Random random(3);
    for (int round = 0; round < 100; ++round) {
        const scene::Camera any = random.camera();
        const glm::dmat4 view = scene::view_from_world(any);
        const auto in_view = [&](const glm::dvec3& point) { return glm::dvec3(view * glm::dvec4(point, 1)); };
        CHECK(near(in_view(any.eye), glm::dvec3(0)));
        CHECK(near(in_view(any.focus), glm::dvec3(0, 0, -scene::focus_distance(any))));
        CHECK(near(in_view(any.eye + any.up), glm::dvec3(0, 1, 0)));
        CHECK(near(in_view(any.eye + scene::right_direction(any)), glm::dvec3(1, 0, 0)));
        CHECK(glm::determinant(view) == doctest::Approx(1).epsilon(1e-12));
    }
}

TEST_CASE("the projection matrix") {
    scene::Camera camera;
    camera.fov = 90;
    const glm::dmat4 clip = math::clip_from_view(scene::projection_of(camera, 2), 1, 3);
    const auto check = [&](const glm::dvec4& point, const glm::dvec4& expected) {
        CHECK(glm::distance(clip * point, expected) < 1e-14);
    };
    check({1, 0, 0, 0}, {0.5, 0, 0, 0});
    check({0, 1, 0, 0}, {0, 1, 0, 0});
    check({0, 0, 1, 0}, {0, 0, -2, -1});
    check({0, 0, 0, 1}, {0, 0, -3, 0});
    check({2, -1, -1, 1}, {1, -1, -1, 1});  // a corner of the near plane
    check({6, 3, -3, 1}, {3, 3, 3, 3});     // and of the far one
    camera.fov = 60;
    CHECK(math::clip_from_view(scene::projection_of(camera, 1), 1, 3)[1][1] ==
          doctest::Approx(std::sqrt(3.0)).epsilon(1e-15));
}

TEST_CASE("a drag to the right turns the scene to the right, down tips its top towards the viewer") {
    const scene::Camera camera;  // at (0, 0, 5), looking at the origin
    for (const bool keep_upright : {true, false}) {
        CAPTURE(keep_upright);
        const scene::Camera right = navigation::rotated(camera, 90, 0, keep_upright);
        CHECK(near(right.eye, {-5, 0, 0}));
        CHECK(near(right.up, {0, 1, 0}));
        const scene::Camera down = navigation::rotated(camera, 0, 90, keep_upright);
        CHECK(near(down.eye, {0, 5, 0}));
        CHECK(near(down.up, {0, 0, -1}));
        // What faces the viewer moves to the right, what is on top comes nearer.
        CHECK(seen(navigation::rotated(camera, 10, 0, keep_upright), {0, 0, 1}).x > 0.05);
        CHECK(seen(navigation::rotated(camera, 0, 30, keep_upright), {0, 1, 0}).z ==
              doctest::Approx(4.5).epsilon(1e-12));
        CHECK(seen(navigation::rotated(camera, 0, -30, keep_upright), {0, 1, 0}).z ==
              doctest::Approx(5.5).epsilon(1e-12));
    }
    for (int right = -360; right <= 360; right += 30)
        for (int down = -90; down <= 90; down += 15) {
            const double a = degrees(right), b = degrees(down);
            const scene::Camera turned = navigation::rotated(camera, right, down, true);
            CHECK(near(turned.eye,
                       glm::dvec3(-std::sin(a) * std::cos(b), std::sin(b), std::cos(a) * std::cos(b)) * 5.0));
            CHECK(near(turned.up, {std::sin(a) * std::sin(b), std::cos(b), -std::cos(a) * std::sin(b)}));
            CHECK(near(turned.focus, glm::dvec3(0)));
        }
}

TEST_CASE("a turn keeps the distances of eye and focus from the centre, and the distance between them") {
    Random random(4);
    for (int round = 0; round < 2000; ++round) {
        const scene::Camera camera = random.camera();
        const scene::Camera turned =
            navigation::rotated(camera, random.number(-400, 400), random.number(-400, 400), round % 2 == 0);
        const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-12 * b; };
        CHECK(same(glm::distance(turned.eye, turned.center), glm::distance(camera.eye, camera.center)));
        CHECK(same(glm::distance(turned.focus, turned.center), glm::distance(camera.focus, camera.center)));
        CHECK(same(scene::focus_distance(turned), scene::focus_distance(camera)));
        CHECK(turned.center == camera.center);
        CHECK(turned.fov == camera.fov);
        check_frame(turned);
    }
}

TEST_CASE("kept upright, the scene is never turned over") {
    Random random(5);
    for (int sequence = 0; sequence < 200; ++sequence) {
        scene::Camera camera = random.camera();  // rolled anyhow
        const double side = camera.up.y < 0 ? -1 : 1;
        bool at_pole = false;
        for (int step = 0; step < 50; ++step) {
            camera = navigation::rotated(camera, random.number(-300, 300), random.number(-90, 90), true);
            // Straight above or below there is no telling which side is up.
            at_pole = at_pole || std::abs(camera.up.y) < 1e-9;
            if (!at_pole || side > 0) CHECK(camera.up.y * side > -1e-9);
        }
        check_frame(camera);
    }
}

TEST_CASE("kept upright, a drag ends at the poles and comes back from there") {
    const scene::Camera camera;
    const scene::Camera top = navigation::rotated(camera, 0, 1000, true);
    CHECK(near(top.eye, {0, 5, 0}));
    CHECK(near(top.up, {0, 0, -1}));
    CHECK(near(navigation::rotated(top, 0, 50, true).eye, {0, 5, 0}));
    CHECK(near(navigation::rotated(top, 0, -90, true).eye, {0, 0, 5}));
    CHECK(near(navigation::rotated(top, 0, -1000, true).eye, {0, -5, 0}));
    // From above, to the right is still to the right: what is at the lower edge goes there.
    CHECK(seen(navigation::rotated(top, 10, 0, true), {0, 0, 1}).x > 0.05);

    const scene::Camera bottom = navigation::rotated(camera, 30, -1000, true);
    CHECK(near(bottom.eye, {0, -5, 0}));
    CHECK(navigation::rotated(bottom, 0, 20, true).up.y ==
          doctest::Approx(std::sin(degrees(20))).epsilon(1e-9));
}

TEST_CASE("a camera that hangs upside down stays so, and the scene still follows the finger") {
    scene::Camera camera;
    camera.up = {0, -1, 0};
    CHECK(seen(navigation::rotated(camera, 10, 0, true), {0, 0, 1}).x > 0.05);
    CHECK(seen(navigation::rotated(camera, 0, 10, true), {0, -1, 0}).z < 4.9);
    CHECK(near(navigation::rotated(camera, 0, 1000, true).eye, {0, -5, 0}));
    CHECK(near(navigation::rotated(camera, 0, 1000, true).up, {0, 0, -1}));
    CHECK(navigation::rotated(camera, 123, 45, true).up.y ==
          doctest::Approx(-std::cos(degrees(45))).epsilon(1e-12));
}

TEST_CASE("not kept upright, turns are about the camera's own up and go over the poles") {
    scene::Camera camera;
    camera.up = {1, 0, 0};  // its right is then -y
    const scene::Camera right = navigation::rotated(camera, 90, 0, false);
    CHECK(near(right.eye, {0, 5, 0}));
    CHECK(near(right.up, {1, 0, 0}));
    CHECK(seen(navigation::rotated(camera, 10, 0, false), {0, 0, 1}).x > 0.05);

    const scene::Camera over = navigation::rotated(scene::Camera{}, 0, 180, false);
    CHECK(near(over.eye, {0, 0, -5}));
    CHECK(near(over.up, {0, -1, 0}));
    CHECK(near(navigation::rotated(scene::Camera{}, 0, 360, false).eye, {0, 0, 5}));
}

TEST_CASE("a move by nothing changes nothing, to the bit") {
    Random random(6);
    for (int round = 0; round < 200; ++round) {
        scene::Camera camera = random.camera();
        if (round % 2) camera.up *= 1.0 + 1e-13;
        CHECK(navigation::rotated(camera, 0, 0, true) == camera);
        CHECK(navigation::rotated(camera, 0, 0, false) == camera);
        CHECK(navigation::rotated(camera, -0.0, -0.0, true) == camera);
        CHECK(navigation::panned(camera, 0, 0) == camera);
        CHECK(navigation::zoomed(camera, 1, 10) == camera);
    }
}

TEST_CASE("a pan keeps the point at the focus' depth under the finger") {
    Random random(7);
    for (int round = 0; round < 500; ++round) {
        const scene::Camera camera = random.camera();
        const glm::dvec3 across = scene::right_direction(camera);
        const glm::dvec3 point =
            camera.focus + (across * random.number(-1, 1) + camera.up * random.number(-1, 1)) *
                               scene::focus_distance(camera);
        const glm::dvec2 fraction{random.number(-2, 2), random.number(-2, 2)};
        const scene::Camera after = navigation::panned(camera, fraction.x, fraction.y);
        // In halves of the view's height, y up.
        const glm::dvec3 expected = seen(camera, point) + glm::dvec3(2 * fraction.x, -2 * fraction.y, 0);
        CHECK(near(seen(after, point), expected, 1e-11));
        CHECK(near(after.eye - after.focus, camera.eye - camera.focus));
        CHECK(after.up == camera.up);
        CHECK(after.center == camera.center);
        CHECK(after.fov == camera.fov);
    }
}

TEST_CASE("zoom divides the distance, along the view") {
    Random random(8);
    for (int round = 0; round < 200; ++round) {
        const scene::Camera camera = random.camera();
        const double factor = std::exp(random.number(-5, 5));
        const scene::Camera after = navigation::zoomed(camera, factor, 10);
        CHECK(scene::focus_distance(after) ==
              doctest::Approx(scene::focus_distance(camera) / factor).epsilon(1e-12));
        CHECK(near(scene::view_direction(after), scene::view_direction(camera)));
        CHECK(after.focus == camera.focus);
        CHECK(after.up == camera.up);
        CHECK(after.center == camera.center);
    }
}

TEST_CASE("zoom stays between a millionth and a million of the scene's radius") {
    const scene::Camera camera;
    const auto distance = [&](double factor, double radius) {
        return scene::focus_distance(navigation::zoomed(camera, factor, radius));
    };
    CHECK(distance(1e9, 2) == doctest::Approx(2e-6).epsilon(1e-9));
    CHECK(distance(1e-9, 2) == doctest::Approx(2e6).epsilon(1e-9));
    CHECK(distance(kInfinity, 2) == doctest::Approx(2e-6).epsilon(1e-9));
    CHECK(distance(0, 2) == doctest::Approx(2e6).epsilon(1e-9));
    CHECK(distance(1e9, 0) == doctest::Approx(1e-6).epsilon(1e-9));
    // Outside already: further away it does not go, back it may.
    CHECK(distance(2, 1e8) == doctest::Approx(5).epsilon(1e-12));
    CHECK(distance(0.5, 1e8) == doctest::Approx(10).epsilon(1e-12));
    CHECK(distance(0.5, 1e-8) == doctest::Approx(5).epsilon(1e-12));
    CHECK(distance(2, 1e-8) == doctest::Approx(2.5).epsilon(1e-12));

    // At a limit more of the same changes nothing.
    for (const double factor : {1.1, 1 / 1.1}) {
        scene::Camera at_limit =
            navigation::zoomed(navigation::zoomed(camera, std::pow(factor, 400), 3), factor, 3);
        for (int i = 0; i < 10; ++i) CHECK(navigation::zoomed(at_limit, factor, 3) == at_limit);
    }
}

TEST_CASE("far from the origin, zooming in ends before the numbers do") {
    for (const double far : {1e3, 1e7, 1e10, 1e15, 1e30}) {
        CAPTURE(far);
        scene::Camera camera;
        camera.focus = camera.center = {far, far, far};
        camera.eye = camera.focus + glm::dvec3(1, 2, 3) * std::max(1.0, far * 1e-7);
        camera = scene::with_orthogonal_up(camera);
        const glm::dvec3 before = scene::view_direction(camera);
        for (int i = 0; i < 500; ++i) camera = navigation::zoomed(camera, 1.1, 1);
        CHECK(scene::is_valid_pose(camera, 1));
        CHECK(near(scene::view_direction(camera), before, 2e-3));
        for (int i = 0; i < 100; ++i) camera = navigation::zoomed(camera, 1 / 1.1, 1);
        CHECK(near(scene::view_direction(camera), before, 2e-3));
    }
}

TEST_CASE("a move that no number can hold is not made") {
    const scene::Camera camera;
    for (const double much : {1e308, kInfinity, std::nan("")}) {
        CAPTURE(much);
        CHECK(scene::is_valid_pose(navigation::rotated(camera, much, 0, true), 1));
        CHECK(scene::is_valid_pose(navigation::rotated(camera, 0, -much, false), 1));
        CHECK(navigation::panned(camera, much, 0) == camera);
        CHECK(navigation::panned(camera, 0, -much) == camera);
        CHECK(scene::is_valid_pose(navigation::zoomed(camera, much, 1), 1));
    }
    CHECK(scene::is_valid_pose(navigation::panned(camera, 1e17, 0), 1));
}

TEST_CASE("a million moves do not drift") {
    scene::Camera start;
    start.eye = {3, 2, 4};
    start.center = {0.5, 0.25, -1};
    start = scene::with_orthogonal_up(start);
    for (const bool keep_upright : {true, false}) {
        Random random(9);
        scene::Camera camera = start;
        for (int i = 0; i < 1'000'000; ++i)
            camera = navigation::rotated(camera, random.number(-5, 5), random.number(-5, 5), keep_upright);
        const auto off = [](double a, double b) { return std::abs(a / b - 1); };
        CHECK(off(glm::distance(camera.eye, camera.center), glm::distance(start.eye, start.center)) < 1e-9);
        CHECK(off(glm::distance(camera.focus, camera.center), glm::distance(start.focus, start.center)) <
              1e-9);
        CHECK(off(scene::focus_distance(camera), scene::focus_distance(start)) < 1e-9);
        check_frame(camera);
        CHECK(camera.center == start.center);
    }
}

TEST_CASE("a pose is valid or not") {
    scene::Camera camera;
    CHECK(scene::is_valid_pose(camera, 1));
    const auto with = [&](auto change) {
        scene::Camera changed = camera;
        change(changed);
        return scene::is_valid_pose(changed, 1000);
    };
    CHECK_FALSE(with([](scene::Camera& c) { c.eye = c.focus; }));
    CHECK_FALSE(with([](scene::Camera& c) { c.eye = {0, 0, 0.9e-6}; }));
    CHECK(with([](scene::Camera& c) { c.eye = {0, 0, 1.1e-6}; }));
    CHECK_FALSE(with([](scene::Camera& c) { c.up = {0, 0, 0}; }));
    CHECK_FALSE(with([](scene::Camera& c) { c.up = {0, 0, 1}; }));
    CHECK_FALSE(with([](scene::Camera& c) { c.up = {0, 0, -7}; }));
    CHECK(with([](scene::Camera& c) { c.up = {0, 0.001, 1}; }));
    CHECK(with([](scene::Camera& c) { c.up = {3, 400, 5}; }));
    CHECK_FALSE(with([](scene::Camera& c) { c.up.x = std::nan(""); }));
    CHECK_FALSE(with([](scene::Camera& c) { c.eye.x = kInfinity; }));
    CHECK_FALSE(with([](scene::Camera& c) { c.focus.y = std::nan(""); }));
    CHECK_FALSE(with([](scene::Camera& c) { c.center.z = -kInfinity; }));
    CHECK_FALSE(with([](scene::Camera& c) { c.eye.x = 1e200; }));
    CHECK(scene::is_valid_pose(camera, 0));
    camera.eye = camera.focus;
    CHECK_FALSE(scene::is_valid_pose(camera, 0));
}

TEST_CASE("up is made orthogonal and unit, and then left alone") {
    Random random(10);
    for (int round = 0; round < 500; ++round) {
        scene::Camera camera = random.camera();
        camera.up = random.vector(100);
        const scene::Camera once = scene::with_orthogonal_up(camera);
        check_frame(once);
        CHECK(scene::with_orthogonal_up(once) == once);
        // It turns in the plane of view and up only, and towards the old one.
        CHECK(std::abs(glm::dot(once.up, glm::cross(scene::view_direction(camera), camera.up))) < 1e-9);
        CHECK(glm::dot(once.up, camera.up) > 0);
        CHECK(once.eye == camera.eye);
    }
    // As close to the view as is allowed.
    scene::Camera steep;
    steep.eye = {1, 2, 3};
    steep.up = glm::normalize(steep.eye) + glm::dvec3(3e-9, 0, 0);
    REQUIRE(scene::is_valid_pose(steep, 1));
    check_frame(scene::with_orthogonal_up(steep));
    CHECK(scene::with_orthogonal_up(scene::with_orthogonal_up(steep)) == scene::with_orthogonal_up(steep));
}

TEST_CASE("the scene's first camera node by id, in the world, active or not") {
    scene::CameraData data;
    data.eye = {0, 0, 4};
    data.focus = {0, 0, 0};
    data.fov = 33;
    scene::CameraData other = data;
    other.fov = 55;
    std::vector<scene::SceneParts::PartNode> nodes{camera_part(7, 0, other), camera_part(5, 20, data)};
    nodes[1].node.active = false;
    // A quarter turn about y, twice the size, moved.
    nodes.push_back({scene::Node{20,
                                 {},
                                 scene::NodeType::assembly,
                                 scene::kNone,
                                 {},
                                 true,
                                 glm::dmat4(glm::dvec4(0, 0, -2, 0), glm::dvec4(0, 2, 0, 0),
                                            glm::dvec4(2, 0, 0, 0), glm::dvec4(10, 20, 30, 1)),
                                 {}},
                     0});
    const scene::PlacedScene placed = scene_of(nodes);
    REQUIRE(scene::first_camera_node(placed) != scene::kNone);
    const auto camera = scene::camera_at(placed, scene::first_camera_node(placed));
    REQUIRE(camera);
    CHECK(near(camera->eye, {18, 20, 30}));
    CHECK(near(camera->focus, {10, 20, 30}));
    CHECK(near(camera->center, {10, 20, 30}));
    CHECK(near(camera->up, {0, 1, 0}));
    CHECK(camera->fov == 33);

    CHECK(scene::first_camera_node(scene_of({})) == scene::kNone);
    data.focus = data.eye;
    CHECK(scene::first_camera_node(scene_of({camera_part(1, 0, data)})) == scene::kNone);
    CHECK(scene::first_camera_node(scene_of({camera_part(1, 0, data), camera_part(2, 0, other)})) ==
          scene::kNone);
}

TEST_CASE("a camera that sees nothing of the scene is not its first view") {
    const auto with_eye = [](const glm::dvec3& eye, const glm::dvec3& focus, bool on_stage = false) {
        scene::SceneParts parts;
        scene::Geometry triangle;
        triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        for (const glm::dvec3& position : triangle.positions) triangle.bounds.add(position);
        triangle.triangles = {{0, 1, 2}};
        parts.geometries = {triangle};
        scene::CameraData data;
        data.eye = eye;
        data.focus = focus;
        scene::Node part{2,
                         {},
                         scene::NodeType::geometry,
                         scene::kNone,
                         {},
                         true,
                         glm::dmat4(1),
                         scene::GeometryData{0, scene::kNone}};
        parts.nodes = {camera_part(1, 0, data), {part, 0}};
        if (on_stage) {  // with presentation where the camera looks
            part.id = 3;
            part.matrix[3] = {focus, 1};
            part.presentation = true;
            parts.nodes.push_back({part, 0});
        }
        auto scene = scene::Scene::build(std::move(parts));
        REQUIRE(scene);
        return scene::place(*std::move(scene));
    };
    const scene::PlacedScene seen = with_eye({0, 0, 5}, {0, 0, 0}), behind = with_eye({0, 0, 5}, {0, 0, 9}),
                             beside = with_eye({0, 0, 5}, {9, 0, 0}),
                             stage = with_eye({0, 0, 5}, {9, 0, 0}, true);
    CHECK(scene::first_camera_node(seen) != scene::kNone);
    CHECK_FALSE(scene::why_not_first_camera(seen));
    for (const scene::PlacedScene* placed : {&behind, &beside, &stage}) {
        CHECK(scene::first_camera_node(*placed) == scene::kNone);
        CHECK(scene::why_not_first_camera(*placed) ==
              "the first view shows the whole scene: camera node 1 sees nothing of it");
    }
    CHECK_FALSE(scene::why_not_first_camera(scene_of({})));
}

TEST_CASE("home looks from three quarters and above, and fits") {
    math::Bounds box;
    box.add({1, 0, 2});
    box.add({3, 1.5, 6});
    for (const double aspect : {0.5, 2.0}) {
        const scene::Camera home = navigation::home_camera(navigation::fit_target(box), aspect);
        CHECK(home.center == box.center());
        const glm::dvec3 from_center = home.eye - home.focus;
        CHECK(from_center.x > 0);
        CHECK(from_center.y > 0);
        CHECK(from_center.z > from_center.x);
        CHECK(home.up.y > 0.9);
        check_frame(home);
        for (const glm::dvec3& corner : math::corners(box)) {
            CHECK(std::abs(seen(home, corner).x) < aspect);
            CHECK(std::abs(seen(home, corner).y) < 1);
        }
    }
    CHECK(scene::is_valid_pose(navigation::home_camera(navigation::fit_target({}), 1), 0));
}
