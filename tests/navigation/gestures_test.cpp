#include "navigation/gestures.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "navigation/camera_moves.hpp"
#include "navigation/clicks.hpp"
#include "navigation/keys.hpp"
#include "near.hpp"

using namespace vrut;

namespace {

using Action = navigation::PointerInput::Action;
using Device = navigation::PointerInput::Device;

using Style = navigation::NavigationStyle;
using Operation = navigation::DragOperation;

constexpr unsigned kLeft = 1, kRight = 2, kMiddle = 4;
constexpr navigation::ModifierKeys kAlt{true, false, false, false};

bool near(const glm::dvec2& a, const glm::dvec2& b, double tolerance = 1e-9) {
    return glm::distance(a, b) <= tolerance;
}
bool near(const scene::Camera& a, const scene::Camera& b) {
    return ::near(a.eye, b.eye) && ::near(a.focus, b.focus) && ::near(a.up, b.up) &&
           ::near(a.center, b.center) && a.fov == b.fov;
}

/// A view of 1280x720 with the eye at (0, 0, 5), the focus at the origin, and hands on it.
class Hands {
public:
    scene::Camera camera;
    navigation::NavigationContext context;
    navigation::Gestures gestures;
    navigation::ModifierKeys modifiers;

    Hands() {
        context.bounds.add({-1, -1, -1});
        context.bounds.add({1, 1, 1});
    }

    void send(Action action, double x, double y, int button, unsigned buttons, Device device = Device::mouse,
              std::int64_t pointer = 1, const std::string& client = "tablet") {
        camera = gestures.pointer({action, client, pointer, device, x, y, button, buttons, modifiers}, camera,
                                  context);
    }
    void mouse_down(double x, double y, int button, unsigned buttons) {
        send(Action::down, x, y, button, buttons);
    }
    void mouse_move(double x, double y, unsigned buttons) { send(Action::move, x, y, -1, buttons); }
    void chord(double x, double y, int button, unsigned buttons) {
        send(Action::move, x, y, button, buttons);
    }
    void mouse_up(double x, double y, int button) { send(Action::up, x, y, button, 0); }
    void finger_down(std::int64_t finger, double x, double y) {
        send(Action::down, x, y, 0, 1, Device::touch, finger);
    }
    void finger_move(std::int64_t finger, double x, double y) {
        send(Action::move, x, y, -1, 1, Device::touch, finger);
    }
    void finger_up(std::int64_t finger, double x, double y) {
        send(Action::up, x, y, 0, 0, Device::touch, finger);
    }

    /// What a move from (100, 400) to (136, 40) does; the hand goes back then.
    Operation operation(unsigned buttons) {
        const scene::Camera before = camera;
        mouse_move(136, 40, buttons);
        const scene::Camera after = camera;
        mouse_move(100, 400, buttons);
        CHECK(near(camera, before));
        camera = before;
        gestures.restart(before);
        if (after == before) return Operation::none;
        if (near(after, navigation::rotated(before, 9, -90, true))) return Operation::rotate;
        if (near(after, navigation::panned(before, 0.05, -0.5))) return Operation::pan;
        CHECK(near(after, navigation::zoomed(before, 2, context.bounds.radius())));
        return Operation::zoom;
    }

    /// Where `point` is in the view, in CSS pixels from its top left.
    glm::dvec2 pixel_of(const glm::dvec3& point) const {
        const glm::dvec4 clip =
            math::clip_from_view(scene::projection_of(camera, context.width / context.height), 0.01, 100) *
            (scene::view_from_world(camera) * glm::dvec4(point, 1));
        return {(clip.x / clip.w + 1) / 2 * context.width, (1 - clip.y / clip.w) / 2 * context.height};
    }
    /// The point at the focus' depth that is seen there.
    glm::dvec3 point_at(double x, double y) const {
        const double height =
            2 * scene::focus_distance(camera) * std::tan(camera.fov * std::numbers::pi / 360);
        return camera.focus + (scene::right_direction(camera) * (x - context.width / 2) +
                               camera.up * (context.height / 2 - y)) *
                                  (height / context.height);
    }
};

}  // namespace

TEST_CASE("a drag that looks around keeps the eye, and the middle of the view follows the pointer") {
    for (const bool touch : {false, true}) {
        Hands hands;
        hands.context.looks_around_from = [](const glm::dvec3& eye) { return eye.z > 4; };
        const scene::Camera before = hands.camera;
        const Device device = touch ? Device::touch : Device::mouse;
        hands.send(Action::down, 640, 360, 0, 1, device);
        hands.send(Action::move, 641, 362, -1, 1, device);
        CHECK(hands.camera.eye == before.eye);
        CHECK(hands.camera.center == before.center);
        const glm::dvec3 view = scene::view_direction(hands.camera);
        const double height = scene::projection_of(before, 1).height() / 720;  // of a pixel, at distance 1
        CHECK(view.x == doctest::Approx(-height).epsilon(1e-3));
        CHECK(view.y == doctest::Approx(2 * height).epsilon(1e-3));
    }
    Hands outside;
    outside.context.looks_around_from = [](const glm::dvec3& eye) { return eye.z > 6; };
    outside.mouse_down(640, 360, 0, 1);
    outside.mouse_move(641, 362, 1);
    CHECK(outside.camera.eye != glm::dvec3(0, 0, 5));
}

TEST_CASE("keys turn the view about the eye there, the way they point") {
    Hands hands;
    hands.context.looks_around_from = [](const glm::dvec3&) { return true; };
    const auto pressed = [&](const char* key) {
        return navigation::apply_key_operation(*navigation::key_operation({key}), hands.camera, hands.camera,
                                               hands.context);
    };
    CHECK(pressed("ArrowRight").eye == hands.camera.eye);
    CHECK(scene::view_direction(pressed("ArrowRight")).x ==
          doctest::Approx(std::sin(5 * scene::kRadiansPerDegree)));
    CHECK(scene::view_direction(pressed("ArrowUp")).y ==
          doctest::Approx(std::sin(5 * scene::kRadiansPerDegree)));
}

TEST_CASE("left drag turns around the centre: the view's shorter side is half a turn") {
    Hands hands;
    SUBCASE("landscape") {
        hands.mouse_down(200, 100, 0, kLeft);
        CHECK(hands.camera == scene::Camera{});
        hands.mouse_move(560, 100, kLeft);
        CHECK(near(hands.camera.eye, {-5, 0, 0}));
        hands.mouse_move(200, 280, kLeft);  // back, and down by a quarter of the height
        CHECK(near(hands.camera.eye, {0, 5 / std::sqrt(2.0), 5 / std::sqrt(2.0)}));
        hands.mouse_up(200, 280, 0);
        CHECK_FALSE(hands.gestures.any_pressed());
    }
    SUBCASE("portrait") {
        hands.context.width = 500;
        hands.context.height = 900;
        hands.mouse_down(0, 0, 0, kLeft);
        hands.mouse_move(250, 0, kLeft);
        CHECK(near(hands.camera.eye, {-5, 0, 0}));
    }
    SUBCASE("speed") {
        hands.context.rotate_speed = 0.5;
        hands.mouse_down(0, 0, 0, kLeft);
        hands.mouse_move(720, 0, kLeft);
        CHECK(near(hands.camera.eye, {-5, 0, 0}));
    }
    SUBCASE("around the centre, not the focus") {
        hands.camera.center = {0, 0, 4};
        hands.mouse_down(0, 0, 0, kLeft);
        hands.mouse_move(360, 0, kLeft);
        CHECK(near(hands.camera.eye, {-1, 0, 4}));
        CHECK(near(hands.camera.focus, {4, 0, 4}));
    }
    SUBCASE("kept upright or not") {
        hands.mouse_down(0, 0, 0, kLeft);
        hands.mouse_move(0, 720, kLeft);
        CHECK(near(hands.camera.eye, {0, 5, 0}));
        hands.context.keep_upright = false;
        hands.mouse_move(0, 720, kLeft);
        CHECK(near(hands.camera.eye, {0, 0, -5}));
    }
}

TEST_CASE("right drag keeps the point at the focus' depth under the pointer") {
    Hands hands;
    const glm::dvec3 point = hands.point_at(300, 500);
    hands.mouse_down(300, 500, 2, kRight);
    hands.mouse_move(900, 20, kRight);
    CHECK(near(hands.pixel_of(point), {900, 20}));
    hands.mouse_move(-50, 1000, kRight);
    CHECK(near(hands.pixel_of(point), {-50, 1000}));
    CHECK(hands.camera.center == glm::dvec3(0));
    CHECK(scene::focus_distance(hands.camera) == doctest::Approx(5).epsilon(1e-14));
    hands.context.pan_speed = 2;
    hands.mouse_move(350, 500, kRight);
    CHECK(near(hands.pixel_of(point), {400, 500}));
}

namespace {

/// Hands on a view of a wall at z = 2, before the focus; to the left of x = 0 nothing is.
struct HandsOnWall : Hands {
    int looks = 0;
    HandsOnWall() {
        context.surface_at = [this](const scene::Camera& seen_by, const glm::dvec2& place) {
            ++looks;
            const glm::dvec2 size(context.width, context.height);
            const glm::dvec3 ray =
                scene::direction_through(seen_by, size.x / size.y, 2.0 * place / size - 1.0);
            const glm::dvec3 point = seen_by.eye + ray * ((2 - seen_by.eye.z) / ray.z);
            return point.x < 0 ? std::nullopt : std::optional(point);
        };
    }
    glm::dvec3 touched(double x, double y) { return *context.surface_at(camera, {x, y}); }
};

}  // namespace

TEST_CASE("a pan moves what was touched with the pointer, which is looked for once") {
    HandsOnWall hands;
    const glm::dvec3 point = hands.touched(900, 300);
    hands.mouse_down(900, 300, 2, kRight);
    hands.looks = 0;
    for (const glm::dvec2 place : {glm::dvec2{700, 100}, {20, 500}, {1000, 710}}) {
        hands.mouse_move(place.x, place.y, kRight);
        CHECK(near(hands.pixel_of(point), place));
    }
    CHECK(hands.looks == 1);
    CHECK(hands.camera.center == glm::dvec3(0));
    CHECK(scene::focus_distance(hands.camera) == doctest::Approx(5).epsilon(1e-14));
}

TEST_CASE("two fingers keep what was touched between them, at its depth") {
    HandsOnWall hands;
    const glm::dvec3 point = hands.touched(900, 200);
    hands.finger_down(1, 850, 150);
    hands.finger_down(2, 950, 250);
    hands.looks = 0;
    hands.finger_move(2, 1150, 450);
    CHECK(near(hands.pixel_of(point), {1000, 300}));
    hands.finger_move(1, 950, 250);
    CHECK(near(hands.pixel_of(point), {1050, 350}));
    CHECK(hands.looks == 1);
    CHECK(near(scene::view_direction(hands.camera), {0, 0, -1}));
    // The distance to what is touched is halved as that to the focus is.
    CHECK(scene::focus_distance(hands.camera) == doctest::Approx(2.5).epsilon(1e-13));
    CHECK(hands.camera.eye.z == doctest::Approx(3.5).epsilon(1e-13));
    CHECK(hands.camera.center == glm::dvec3(0));
}

TEST_CASE(
    "the wheel keeps what lies under the pointer, and where nothing is, the point at the focus' depth") {
    HandsOnWall hands;
    for (const glm::dvec2 place : {glm::dvec2{1100, 650}, {130, 90}}) {
        hands.camera = scene::Camera{};
        const auto surface = hands.context.surface_at(hands.camera, place);
        CHECK(surface.has_value() == (place.x > 640));
        const glm::dvec3 point = surface ? *surface : hands.point_at(place.x, place.y);
        for (const double delta : {-400, -1000, 700}) {
            hands.camera = navigation::wheel({delta, navigation::WheelInput::Unit::pixel, place.x, place.y},
                                             hands.camera, hands.context);
            CHECK(near(hands.pixel_of(point), place));
        }
        CHECK(scene::focus_distance(hands.camera) == doctest::Approx(5 / std::pow(1.1, 7)).epsilon(1e-12));
    }
}

TEST_CASE(
    "with turn_about_touched a turn keeps what was touched in its place; else, and of nothing, the centre") {
    HandsOnWall hands;
    hands.camera.center = {1, 0, -3};
    const scene::Camera before = hands.camera;
    const glm::dvec3 point = hands.touched(900, 400);
    const auto turn = [&](double x, double y) {
        hands.camera = before;
        hands.mouse_down(x, y, 0, kLeft);
        hands.mouse_move(x + 90, y + 40, kLeft);
        hands.mouse_up(x + 90, y + 40, 0);
        CHECK(hands.camera.center == before.center);
        return hands.camera;
    };
    CHECK(near(turn(900, 400), navigation::rotated(before, 22.5, 10, true)));
    hands.context.turn_about_touched = true;
    const scene::Camera turned = turn(900, 400);
    CHECK(near(hands.pixel_of(point), {900, 400}));
    CHECK(near(scene::view_direction(turned),
               scene::view_direction(navigation::rotated(before, 22.5, 10, true))));
    CHECK(near(turn(100, 400), navigation::rotated(before, 22.5, 10, true)));
}

TEST_CASE("middle drag up over the view's height divides the distance by 4") {
    Hands hands;
    hands.mouse_down(100, 700, 1, kMiddle);
    hands.mouse_move(400, -20, kMiddle);
    CHECK(near(hands.camera.eye, {0, 0, 1.25}));
    hands.mouse_move(400, 340, kMiddle);
    CHECK(near(hands.camera.eye, {0, 0, 2.5}));
    hands.mouse_move(400, 1420, kMiddle);
    CHECK(near(hands.camera.eye, {0, 0, 20}));
    hands.context.zoom_speed = 0.5;
    hands.mouse_move(400, 1420, kMiddle);
    CHECK(near(hands.camera.eye, {0, 0, 10}));
}

TEST_CASE("one finger turns, and so does a pen; a pen's barrel button pans") {
    Hands mouse;
    mouse.mouse_down(10, 20, 0, kLeft);
    mouse.mouse_move(200, 70, kLeft);
    Hands finger;
    finger.finger_down(7, 10, 20);
    finger.finger_move(7, 200, 70);
    CHECK(finger.camera == mouse.camera);
    Hands pen;
    pen.send(Action::down, 10, 20, 0, kLeft, Device::pen);
    pen.send(Action::move, 200, 70, -1, kLeft, Device::pen);
    CHECK(pen.camera == mouse.camera);
    Hands barrel;
    const glm::dvec3 point = barrel.point_at(10, 20);
    barrel.send(Action::down, 10, 20, 2, kRight, Device::pen);
    barrel.send(Action::move, 200, 70, -1, kRight, Device::pen);
    CHECK(near(barrel.pixel_of(point), {200, 70}));
}

TEST_CASE("two fingers pan and pinch together") {
    Hands hands;
    hands.finger_down(1, 540, 360);
    hands.finger_down(2, 740, 360);
    CHECK(hands.camera == scene::Camera{});
    hands.finger_move(1, 600, 400);
    hands.finger_move(2, 1000, 400);
    CHECK(scene::focus_distance(hands.camera) == doctest::Approx(2.5).epsilon(1e-13));
    // What was in the middle between them, at the focus' depth, is there still.
    CHECK(near(hands.pixel_of({0, 0, 0}), {800, 400}));
    CHECK(near(scene::view_direction(hands.camera), {0, 0, -1}));

    // Closer than at the start; turned against each other, which does nothing.
    hands.finger_move(1, 640, 310);
    hands.finger_move(2, 640, 410);
    CHECK(near(hands.camera.eye, {0, 0, 10}));
    hands.finger_move(1, 740, 360);
    hands.finger_move(2, 540, 360);
    CHECK(near(hands.camera, scene::Camera{}));
}

TEST_CASE("two fingers side by side keep the points under both of them") {
    Hands hands;
    const glm::dvec3 a = hands.point_at(100, 600), b = hands.point_at(160, 500);
    hands.finger_down(1, 100, 600);
    hands.finger_down(2, 160, 500);
    hands.finger_move(2, 660, 100);
    hands.finger_move(1, 600, 200);
    CHECK(near(hands.pixel_of(a), {600, 200}));
    CHECK(near(hands.pixel_of(b), {660, 100}));
}

TEST_CASE("fingers on one spot divide by nothing") {
    Hands hands;
    hands.finger_down(1, 300, 300);
    hands.finger_down(2, 300, 300);
    hands.finger_move(2, 302, 300);
    CHECK(scene::is_valid_pose(hands.camera, 1));
    hands.finger_move(2, 300, 300);
    CHECK(near(hands.camera, scene::Camera{}));
    for (const double far : {1e9, -1e300}) {
        hands.finger_move(1, far, -far);
        CHECK(scene::is_valid_pose(hands.camera, 1));
    }
}

TEST_CASE("chords: the button pressed last decides, and no step jumps") {
    Hands hands;
    hands.mouse_down(600, 300, 0, kLeft);
    hands.mouse_move(650, 310, kLeft);
    const scene::Camera turned = hands.camera;
    CHECK(near(turned, navigation::rotated(scene::Camera{}, 12.5, 2.5, true)));
    hands.chord(650, 310, 2, kLeft | kRight);
    CHECK(hands.camera == turned);
    const glm::dvec3 point = hands.point_at(650, 310);
    hands.mouse_move(700, 400, kLeft | kRight);
    CHECK(near(hands.pixel_of(point), {700, 400}));
    const scene::Camera moved = hands.camera;

    SUBCASE("the first goes up first") {
        hands.chord(700, 400, 0, kRight);
        CHECK(hands.camera == moved);
        hands.mouse_move(720, 410, kRight);
        CHECK(near(hands.pixel_of(point), {720, 410}));
    }
    SUBCASE("the second goes up first") {
        hands.chord(700, 400, 2, kLeft);
        CHECK(hands.camera == moved);
        hands.mouse_move(720, 400, kLeft);
        CHECK(near(hands.camera, navigation::rotated(moved, 5, 0, true)));
        hands.mouse_up(720, 400, 0);
        CHECK(near(hands.camera, navigation::rotated(moved, 5, 0, true)));
        CHECK_FALSE(hands.gestures.any_pressed());
    }
    SUBCASE("a third") {
        hands.chord(700, 400, 1, kLeft | kRight | kMiddle);
        hands.mouse_move(700, 40, kLeft | kRight | kMiddle);
        CHECK(scene::focus_distance(hands.camera) == doctest::Approx(2.5).epsilon(1e-13));
        const scene::Camera zoomed_in = hands.camera;
        hands.chord(700, 40, 0, kRight | kMiddle);
        hands.chord(700, 40, 1, kRight);
        CHECK(hands.camera == zoomed_in);
        const glm::dvec3 under = hands.point_at(700, 40);
        hands.mouse_move(60, 70, kRight);
        CHECK(near(hands.pixel_of(under), {60, 70}));
    }
    SUBCASE("the movement that comes with the press belongs to the drag before") {
        hands.chord(700, 400, 2, kLeft);
        hands.chord(800, 400, 2, kLeft | kRight);
        CHECK(near(hands.camera, navigation::rotated(moved, 25, 0, true)));
    }
    SUBCASE("a change of buttons that no event named") {
        hands.mouse_move(700, 400, kLeft);
        hands.mouse_move(720, 400, kLeft);
        CHECK(near(hands.camera, navigation::rotated(moved, 5, 0, true)));
    }
    SUBCASE("and where it was is not known: the whole way is the new drag's") {
        hands.mouse_move(720, 400, kLeft);
        CHECK(near(hands.camera, navigation::rotated(moved, 5, 0, true)));
    }
}

TEST_CASE("buttons that mean nothing move nothing, alone or with another") {
    Hands hands;
    hands.mouse_down(100, 100, 3, 8);
    hands.mouse_move(300, 300, 8);
    CHECK(hands.camera == scene::Camera{});
    hands.chord(300, 300, 0, 8 | kLeft);
    hands.mouse_move(310, 300, 8 | kLeft);
    CHECK(near(hands.camera, navigation::rotated(scene::Camera{}, 2.5, 0, true)));
    const scene::Camera turned = hands.camera;
    hands.chord(310, 300, 0, 8);
    hands.mouse_move(500, 600, 8);
    CHECK(hands.camera == turned);
    hands.mouse_up(500, 600, 3);

    Hands left;
    left.mouse_down(100, 100, 0, kLeft);
    left.chord(100, 100, 4, kLeft | 16);
    left.mouse_move(110, 100, kLeft | 16);
    CHECK(near(left.camera, navigation::rotated(scene::Camera{}, 2.5, 0, true)));
}

TEST_CASE("hovering does nothing, nor does what is not pressed") {
    Hands hands;
    hands.mouse_move(100, 100, 0);
    hands.mouse_move(200, 300, kLeft);
    hands.mouse_up(400, 400, 0);
    hands.send(Action::cancel, 0, 0, -1, 0);
    hands.finger_move(3, 10, 10);
    CHECK(hands.camera == scene::Camera{});
    CHECK_FALSE(hands.gestures.any_pressed());
}

TEST_CASE("a second press of a pressed pointer starts anew") {
    Hands hands;
    hands.mouse_down(100, 100, 0, kLeft);
    hands.mouse_move(200, 100, kLeft);
    const scene::Camera turned = hands.camera;
    hands.mouse_down(500, 300, 0, kLeft);
    CHECK(hands.camera == turned);
    hands.mouse_move(520, 300, kLeft);
    CHECK(near(hands.camera, navigation::rotated(turned, 5, 0, true)));
    // It was one pointer all the time.
    hands.mouse_up(520, 300, 0);
    CHECK_FALSE(hands.gestures.any_pressed());

    Hands other;  // anew with another button
    other.mouse_down(100, 100, 0, kLeft);
    const glm::dvec3 point = other.point_at(500, 300);
    other.mouse_down(500, 300, 2, kRight);
    other.mouse_move(600, 200, kRight);
    CHECK(near(other.pixel_of(point), {600, 200}));
}

TEST_CASE("the place of the release counts, that of a cancel does not") {
    Hands hands;
    hands.mouse_down(100, 100, 0, kLeft);
    hands.mouse_move(200, 100, kLeft);
    hands.mouse_up(460, 100, 0);
    CHECK(near(hands.camera.eye, {-5, 0, 0}));

    Hands cancelled;
    cancelled.finger_down(4, 100, 100);
    cancelled.finger_move(4, 200, 100);
    const scene::Camera before = cancelled.camera;
    CHECK(before != scene::Camera{});
    cancelled.send(Action::cancel, 0, 0, 0, 0, Device::touch, 4);
    CHECK(cancelled.camera == before);
    CHECK_FALSE(cancelled.gestures.any_pressed());
    cancelled.finger_move(4, 500, 500);
    CHECK(cancelled.camera == before);
}

TEST_CASE("a button released unseen is released: its drag ends where it was") {
    Hands hands;
    hands.mouse_down(100, 100, 0, kLeft);
    hands.mouse_move(200, 100, kLeft);
    const scene::Camera before = hands.camera;
    hands.mouse_move(900, 650, 0);
    CHECK(hands.camera == before);
    CHECK_FALSE(hands.gestures.any_pressed());
}

TEST_CASE("a finger lifted of two goes over into a turn, without a jump") {
    for (const std::int64_t lifted : {1, 2}) {
        CAPTURE(lifted);
        Hands hands;
        hands.finger_down(1, 400, 300);
        hands.finger_down(2, 600, 300);
        hands.finger_move(1, 350, 350);
        hands.finger_move(2, 650, 250);
        const scene::Camera before = hands.camera;
        hands.finger_up(lifted, lifted == 1 ? 350 : 650, lifted == 1 ? 350 : 250);
        CHECK(hands.camera == before);
        const std::int64_t left = 3 - lifted;
        const glm::dvec2 at = left == 1 ? glm::dvec2(350, 350) : glm::dvec2(650, 250);
        hands.finger_move(left, at.x, at.y);
        CHECK(hands.camera == before);
        hands.finger_move(left, at.x + 40, at.y + 20);
        CHECK(near(hands.camera, navigation::rotated(before, 10, 5, true)));
        // And back to two.
        const scene::Camera turned = hands.camera;
        hands.finger_down(9, 100, 100);
        CHECK(hands.camera == turned);
        hands.finger_move(9, 110, 100);
        CHECK(near(scene::view_direction(hands.camera), scene::view_direction(turned)));
    }
}

TEST_CASE("a third finger is ignored") {
    Hands two, three;
    for (Hands* hands : {&two, &three}) {
        hands->finger_down(1, 400, 300);
        hands->finger_down(2, 600, 300);
        hands->finger_move(2, 640, 310);
    }
    const scene::Camera before = three.camera;
    three.finger_down(3, 900, 600);
    three.finger_move(3, 100, 50);
    CHECK(three.camera == before);
    three.finger_up(3, 100, 50);
    CHECK(three.camera == before);
    for (Hands* hands : {&two, &three}) hands->finger_move(1, 300, 200);
    CHECK(three.camera == two.camera);

    // It stays so when one of the others goes.
    three.finger_down(3, 900, 600);
    for (Hands* hands : {&two, &three}) hands->finger_up(1, 300, 200);
    three.finger_move(3, 100, 100);
    for (Hands* hands : {&two, &three}) hands->finger_move(2, 700, 310);
    CHECK(three.camera == two.camera);
    three.finger_up(2, 700, 310);
    three.finger_up(3, 900, 600);
    CHECK_FALSE(three.gestures.any_pressed());
}

TEST_CASE("a pointer is a client's: the same number elsewhere is another one") {
    Hands hands;
    hands.send(Action::down, 540, 360, 0, 1, Device::touch, 1, "a");
    hands.send(Action::down, 740, 360, 0, 1, Device::touch, 1, "b");
    CHECK(hands.gestures.is_pressed("a", 1));
    CHECK(hands.gestures.is_pressed("b", 1));
    CHECK_FALSE(hands.gestures.is_pressed("a", 2));
    CHECK_FALSE(hands.gestures.is_pressed("c", 1));
    hands.send(Action::move, 440, 360, -1, 1, Device::touch, 1, "a");
    hands.send(Action::move, 840, 360, -1, 1, Device::touch, 1, "b");
    CHECK(near(hands.camera.eye, {0, 0, 2.5}));

    const scene::Camera before = hands.camera;
    hands.gestures.lift("a", hands.camera);
    CHECK_FALSE(hands.gestures.is_pressed("a", 1));
    CHECK(hands.gestures.is_pressed("b", 1));
    hands.send(Action::move, 840, 360, -1, 1, Device::touch, 1, "b");
    CHECK(hands.camera == before);
    hands.send(Action::move, 860, 360, -1, 1, Device::touch, 1, "b");
    CHECK(near(hands.camera, navigation::rotated(before, 5, 0, true)));
}

TEST_CASE("what changes the camera in mid-drag makes the drag begin anew there") {
    Hands hands;
    hands.mouse_down(100, 100, 0, kLeft);
    hands.mouse_move(200, 150, kLeft);
    SUBCASE("a wheel") {
        hands.camera =
            navigation::wheel({-100, navigation::WheelInput::Unit::pixel}, hands.camera, hands.context);
        hands.gestures.restart(hands.camera);
        CHECK(scene::focus_distance(hands.camera) == doctest::Approx(5 / 1.1).epsilon(1e-13));
    }
    SUBCASE("a patch") {
        hands.camera.eye = {7, 8, 9};
        hands.camera.center = {1, 0, 0};
        hands.camera = scene::with_orthogonal_up(hands.camera);
        hands.gestures.restart(hands.camera);
    }
    const scene::Camera changed = hands.camera;
    hands.mouse_move(200, 150, kLeft);
    CHECK(hands.camera == changed);
    hands.mouse_move(220, 160, kLeft);
    CHECK(near(hands.camera, navigation::rotated(changed, 5, 2.5, true)));
}

TEST_CASE("many moves, few, or in another order: the same camera to the bit") {
    std::mt19937 random(12);
    std::uniform_real_distribution<double> place(-200, 1500);
    struct Kind {
        std::string name;
        int button;  // -1: two fingers, -2: one
        bool keep_upright;
    };
    for (const Kind& kind : {Kind{"turn", 0, true}, Kind{"turn freely", 0, false}, Kind{"pan", 2, true},
                             Kind{"zoom", 1, true}, Kind{"pinch", -1, true}, Kind{"finger", -2, true}}) {
        CAPTURE(kind.name);
        struct Move {
            std::int64_t finger;
            double x, y;
        };
        std::vector<Move> path;
        path.reserve(50);
        for (int i = 0; i < 50; ++i)
            path.push_back({kind.button == -1 ? 1 + i % 2 : 1, place(random), place(random)});

        const auto drag = [&](const std::vector<Move>& moves, bool with_wheel) {
            Hands hands;
            hands.camera.eye = {3, 4, 5};
            hands.camera.center = {1, 1, 0};
            hands.camera = scene::with_orthogonal_up(hands.camera);
            hands.context.keep_upright = kind.keep_upright;
            hands.context.zoom_speed = 0.3;
            const unsigned buttons = kind.button == 1 ? kMiddle : kind.button == 2 ? kRight : kLeft;
            const Device device = kind.button < 0 ? Device::touch : Device::mouse;
            hands.send(Action::down, 300, 350, std::max(kind.button, 0), buttons, device, 1);
            if (kind.button == -1) hands.send(Action::down, 500, 370, 0, buttons, device, 2);
            for (const Move& move : moves)
                hands.send(Action::move, move.x, move.y, -1, buttons, device, move.finger);
            if (with_wheel) {
                hands.camera = navigation::wheel({-50, navigation::WheelInput::Unit::pixel}, hands.camera,
                                                 hands.context);
                hands.gestures.restart(hands.camera);
                for (const Move& move : moves)
                    hands.send(Action::move, move.y, move.x, -1, buttons, device, move.finger);
            }
            const Move& last = moves.back();
            hands.send(Action::up, with_wheel ? last.y : last.x, with_wheel ? last.x : last.y,
                       std::max(kind.button, 0), 0, device, last.finger);
            return hands.camera;
        };
        for (const bool with_wheel : {false, true}) {
            const scene::Camera fifty = drag(path, with_wheel);
            CHECK_FALSE(near(fifty, drag({{1, 300, 350}}, with_wheel)));
            CHECK(scene::is_valid_pose(fifty, 1));
            const std::vector<Move> two(path.end() - 2, path.end());
            CHECK(drag(two, with_wheel) == fifty);
            if (kind.button != -1) CHECK(drag({path.back()}, with_wheel) == fifty);
            std::vector<Move> shuffled = path;
            for (int round = 0; round < 5; ++round) {
                std::shuffle(shuffled.begin(), shuffled.end() - 2, random);
                CHECK(drag(shuffled, with_wheel) == fifty);
            }
        }
    }
}

TEST_CASE("navigation styles: which button does what with which key held") {
    struct Row {
        Style style = Style::vrut;
        navigation::ModifierKeys modifiers;
        Operation left = Operation::none, middle = Operation::none, right = Operation::none;
    };
    using enum navigation::DragOperation;
    const navigation::ModifierKeys others{false, true, true, true};
    for (const Row& row : {
             Row{Style::vrut, {}, rotate, zoom, pan},
             Row{Style::vrut, kAlt, rotate, zoom, pan},
             Row{Style::vrut, others, rotate, zoom, pan},
             Row{Style::maya, {}, none, none, none},
             Row{Style::maya, kAlt, rotate, pan, zoom},
             Row{Style::maya, others, none, none, none},
             Row{Style::maya, {true, true, true, true}, rotate, pan, zoom},
             Row{Style::cinema4d, {}, none, none, none},
             Row{Style::cinema4d, kAlt, rotate, pan, zoom},
             Row{Style::cinema4d, others, none, none, none},
             Row{Style::catia, {}, none, pan, none},
             Row{Style::catia, kAlt, none, pan, none},
         }) {
        const auto drag = [&](int button, unsigned buttons) {
            Hands hands;
            hands.context.style = row.style;
            hands.modifiers = row.modifiers;
            hands.mouse_down(100, 400, button, buttons);
            return hands.operation(buttons);
        };
        CAPTURE(static_cast<int>(row.style));
        CAPTURE(row.modifiers.alt);
        CHECK(drag(0, kLeft) == row.left);
        CHECK(drag(1, kMiddle) == row.middle);
        CHECK(drag(2, kRight) == row.right);
        CHECK(drag(3, 8) == none);
    }
}

TEST_CASE("the modifier counts when a drag begins, or begins anew with other buttons") {
    Hands hands;
    hands.context.style = Style::maya;
    hands.modifiers = kAlt;
    hands.mouse_down(100, 400, 0, kLeft);
    hands.modifiers = {};
    CHECK(hands.operation(kLeft) == Operation::rotate);
    hands.chord(100, 400, 1, kLeft | kMiddle);
    CHECK(hands.operation(kLeft | kMiddle) == Operation::none);
    hands.modifiers = kAlt;
    CHECK(hands.operation(kLeft | kMiddle) == Operation::none);
    hands.chord(100, 400, 2, kLeft | kMiddle | kRight);
    CHECK(hands.operation(kLeft | kMiddle | kRight) == Operation::zoom);
    hands.chord(100, 400, 2, kLeft | kMiddle);
    CHECK(hands.operation(kLeft | kMiddle) == Operation::rotate);  // as when the last one goes up in vrut
    hands.chord(100, 400, 0, kMiddle);
    CHECK(hands.operation(kMiddle) == Operation::pan);
}

TEST_CASE("catia: the middle button pans, with another it turns, and zooms once that is up again") {
    for (const auto& [other, bit] : {std::pair{0, kLeft}, {2, kRight}}) {
        Hands hands;
        hands.context.style = Style::catia;
        hands.mouse_down(100, 400, 1, kMiddle);
        CHECK(hands.operation(kMiddle) == Operation::pan);
        for (int round = 0; round < 2; ++round) {
            hands.chord(100, 400, other, kMiddle | bit);
            CHECK(hands.operation(kMiddle | bit) == Operation::rotate);
            hands.chord(100, 400, other, kMiddle);
            CHECK(hands.operation(kMiddle) == Operation::zoom);
        }
        hands.mouse_up(100, 400, 1);
        hands.mouse_down(100, 400, 1, kMiddle);  // forgotten with the release
        CHECK(hands.operation(kMiddle) == Operation::pan);
    }
    Hands hands;  // the other one first
    hands.context.style = Style::catia;
    hands.mouse_down(100, 400, 0, kLeft);
    CHECK(hands.operation(kLeft) == Operation::none);
    hands.chord(100, 400, 1, kLeft | kMiddle);
    CHECK(hands.operation(kLeft | kMiddle) == Operation::rotate);
    hands.chord(100, 400, 2, kLeft | kMiddle | kRight);
    CHECK(hands.operation(kLeft | kMiddle | kRight) == Operation::rotate);
    hands.chord(100, 400, 0, kMiddle | kRight);
    CHECK(hands.operation(kMiddle | kRight) == Operation::rotate);
    hands.chord(100, 400, 1, kRight);  // the middle one up: nothing left
    CHECK(hands.operation(kRight) == Operation::none);
    hands.chord(100, 400, 1, kRight | kMiddle);
    hands.chord(100, 400, 2, kMiddle);
    CHECK(hands.operation(kMiddle) == Operation::zoom);
    hands.chord(100, 400, 3, kMiddle | 8);  // a button that means nothing
    CHECK(hands.operation(kMiddle | 8) == Operation::zoom);
}

TEST_CASE("cinema4d: number keys say what the left button does") {
    const auto drag = [](const std::vector<navigation::KeyInput>& held, Style style = Style::cinema4d,
                         const std::string& client = "tablet") {
        Hands hands;
        hands.context.style = style;
        for (const navigation::KeyInput& key : held) hands.gestures.key_down(client, key);
        hands.mouse_down(100, 400, 0, kLeft);
        return hands.operation(kLeft);
    };
    CHECK(drag({{"1", false, "Digit1"}}) == Operation::pan);
    CHECK(drag({{"2", false, "Digit2"}}) == Operation::zoom);
    CHECK(drag({{"3", false, "Digit3"}}) == Operation::rotate);
    CHECK(drag({{"4", false, "Digit4"}}) == Operation::none);
    CHECK(drag({{"0", false, "Digit0"}}) == Operation::none);
    CHECK(drag({{"2", false, "Numpad2"}}) == Operation::zoom);
    CHECK(drag({{"ArrowDown", false, "Numpad2"}}) == Operation::none);
    CHECK(drag({{"&", false, "Digit1"}}) == Operation::pan);                           // on a French keyboard
    CHECK(drag({{"1", false, "Digit1"}, {"2", false, "Digit2"}}) == Operation::zoom);  // the newest
    CHECK(drag({{"a", false, "KeyA"}, {"10", false, ""}, {"F1", false, "F1"}}) == Operation::none);
    CHECK(drag({{"3", false, "Digit3"}}, Style::cinema4d, "other") == Operation::none);
    CHECK(drag({{"3", false, "Digit3"}}, Style::maya) == Operation::none);
    CHECK(drag({{"2", false, "Digit2"}}, Style::vrut) == Operation::rotate);

    Hands hands;
    hands.context.style = Style::cinema4d;
    navigation::Gestures& gestures = hands.gestures;
    gestures.key_down("tablet", {"1", false, "Digit1"});
    gestures.key_down("tablet", {"1", false, "Digit1"});  // it repeats itself
    hands.mouse_down(100, 400, 0, kLeft);
    gestures.key_up("tablet", {"!", true, "Digit1"});  // released with Shift held
    CHECK(gestures.held_keys().empty());
    CHECK(hands.operation(kLeft) == Operation::pan);  // it counts when the drag begins
    gestures.key_down("tablet", {"3", false, "Digit3"});
    CHECK(hands.operation(kLeft) == Operation::pan);
    hands.mouse_up(100, 400, 0);
    hands.mouse_down(100, 400, 0, kLeft);
    CHECK(hands.operation(kLeft) == Operation::rotate);
    hands.mouse_up(100, 400, 0);
    hands.mouse_down(100, 400, 2, kRight);
    CHECK(hands.operation(kRight) == Operation::none);  // the left button only
    gestures.key_up("tablet", {"3", false, "Digit3"});
    gestures.key_down("tablet", {"2", false, "Digit2"});
    hands.chord(100, 400, 0, kRight | kLeft);
    CHECK(hands.operation(kRight | kLeft) == Operation::zoom);
    gestures.key_down("other", {"2", false, "Digit2"});
    gestures.lift("tablet", hands.camera);
    CHECK(gestures.held_keys() == std::vector<navigation::Gestures::HeldKey>{{"other", 2}});
}

TEST_CASE("touch and the wheel are the same in all styles") {
    for (const Style style : {Style::maya, Style::catia, Style::cinema4d}) {
        Hands same, other;
        other.context.style = style;
        for (Hands* hands : {&same, &other}) {
            hands->finger_down(1, 400, 300);
            hands->finger_move(1, 500, 350);
            hands->finger_down(2, 600, 300);
            hands->finger_move(2, 700, 100);
            hands->camera =
                navigation::wheel({-50, navigation::WheelInput::Unit::pixel}, hands->camera, hands->context);
        }
        CHECK(other.camera == same.camera);
        CHECK_FALSE(near(same.camera, scene::Camera{}));
    }
}

// --- whole sessions, made by chance

namespace {

struct Event {
    navigation::PointerInput input;
    navigation::EventTime when;
};

/// Any events of a mouse, a pen and four fingers of two clients, sensible or not, with much dragging.
std::vector<Event> random_events(unsigned seed) {
    std::mt19937 random(seed);
    const auto number = [&](int low, int high) { return std::uniform_int_distribution(low, high)(random); };
    std::vector<Event> events;
    navigation::PointerInput input;
    double time = 1000;
    for (int i = 0; i < 400; ++i) {
        if (number(0, 2) == 0 || i == 0) {
            input.pointer = number(1, 6);
            input.client = number(0, 4) == 0 ? "b" : "a";
            input.device = input.pointer == 1   ? Device::mouse
                           : input.pointer == 2 ? Device::pen
                                                : Device::touch;
        }
        const Action last = input.action;
        const bool goes_on = i > 0 && number(0, 3) != 0;  // presses become clicks, clicks double ones
        if (goes_on && (last == Action::down || last == Action::up)) {
            input.action = last == Action::down ? Action::up : Action::down;
        } else {
            const int kind = number(0, 11);
            input.action = kind < 2    ? Action::down
                           : kind < 3  ? Action::up
                           : kind == 3 ? Action::cancel
                                       : Action::move;
            // Steps of 8 pixels and 10 ms: what almost is something is as frequent as what is.
            input.x = 400 + number(-1, 1) * 8 + (number(0, 5) == 0 ? number(-300, 300) * 1.37 : 0);
            input.y = 300 + number(-1, 1) * 8;
            input.modifiers.alt = number(0, 1) == 0;
            input.button = input.action == Action::down || number(0, 7) == 0 ? number(0, 2) : -1;
        }
        if (input.action == Action::move)
            input.buttons = number(0, 5) == 0 ? static_cast<unsigned>(number(0, 7)) : input.buttons;
        else
            input.buttons = input.action == Action::down ? navigation::button_mask(input.button) : 0;
        time += number(0, 12) * 10.1;
        events.push_back(
            {input, {time, std::chrono::microseconds(std::llround(time * 1000) + number(0, 50000))}});
    }
    return events;
}

/// What the server does with them: drags, and clicks that set the centre.
struct Session {
    Hands hands;
    navigation::Clicks clicks;
    int completed = 0;

    explicit Session(Style style) {
        hands.camera.eye = {3, 4, 5};
        hands.context.style = style;
        hands.camera = scene::with_orthogonal_up(hands.camera);
    }
    void send(const Event& event) {
        hands.camera = hands.gestures.pointer(event.input, hands.camera, hands.context);
        if (const auto click = clicks.pointer(event.input, event.when, hands.context.style)) {
            ++completed;
            hands.camera.center = {click->x / 1000, click->y / 1000, static_cast<int>(click->operation)};
            hands.gestures.restart(hands.camera);
        }
    }
};

bool may_be_merged(const navigation::PointerInput& a, const navigation::PointerInput& b) {
    return a.action == Action::move && b.action == Action::move && a.button == -1 && b.button == -1 &&
           a.pointer == b.pointer && a.client == b.client && a.buttons == b.buttons;
}

}  // namespace

TEST_CASE("moves merged or not, and clocks that start elsewhere: the same camera to the bit") {
    int completed = 0, merged = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        const Style style = static_cast<Style>(seed % 4);
        CAPTURE(seed);
        const std::vector<Event> events = random_events(seed);
        Session all(style), few(style), later(style);
        for (std::size_t i = 0; i < events.size(); ++i) {
            all.send(events[i]);
            Event shifted = events[i];
            *shifted.when.stamp += 1048576;
            shifted.when.arrival -= std::chrono::microseconds(987654321987);
            later.send(shifted);
            if (i + 1 < events.size() && may_be_merged(events[i].input, events[i + 1].input)) {
                ++merged;
                continue;
            }
            few.send(events[i]);
            REQUIRE(few.hands.camera == all.hands.camera);
            REQUIRE(later.hands.camera == all.hands.camera);
        }
        CHECK(few.completed == all.completed);
        completed += all.completed;
    }
    CHECK(completed > 100);  // else nothing was tested
    CHECK(merged > 5000);
}

TEST_CASE("what is pressed, pressed again: a fresh Gestures goes on alike, to the bit") {
    int in_drag = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        CAPTURE(seed);
        const std::vector<Event> events = random_events(seed);
        Session session(static_cast<Style>(seed % 4));
        Hands& hands = session.hands;
        const std::size_t begin = 20 + seed;
        for (std::size_t i = 0; i < begin; ++i) {
            if (i % 5 == 0)
                hands.gestures.key_down(i % 2 == 0 ? "a" : "b", {std::to_string(1 + i % 3), false});
            session.send(events[i]);
        }
        in_drag += hands.gestures.any_pressed() ? 1 : 0;
        const scene::Camera before = hands.camera;
        Hands fresh = hands;
        fresh.gestures = {};
        const auto keys = hands.gestures.held_keys();
        const auto pressed = hands.gestures.pressed();
        for (Hands* each : {&hands, &fresh}) {
            for (const navigation::Gestures::HeldKey& key : keys)
                each->gestures.key_down(key.client, key.input());
            for (const navigation::PointerInput& input : pressed)
                each->camera = each->gestures.pointer(input, each->camera, each->context);
            REQUIRE(each->camera == before);
            REQUIRE(each->gestures.held_keys() == keys);
        }
        for (std::size_t i = begin; i < events.size(); ++i) {
            for (Hands* each : {&hands, &fresh})
                each->camera = each->gestures.pointer(events[i].input, each->camera, each->context);
            REQUIRE(fresh.camera == hands.camera);
        }
    }
    CHECK(in_drag > 100);
}

TEST_CASE("what is pressed is told as it is now") {
    Hands hands;
    hands.modifiers = kAlt;
    hands.mouse_down(100, 200, 0, kLeft);
    hands.modifiers = {};
    hands.mouse_move(110, 220, kLeft);
    hands.modifiers.shift = true;
    hands.finger_down(7, 300, 400);
    const std::vector<navigation::PointerInput> pressed = hands.gestures.pressed();
    REQUIRE(pressed.size() == 2);
    CHECK(pressed[0].action == Action::down);
    CHECK(pressed[0].client == "tablet");
    CHECK(pressed[0].pointer == 1);
    CHECK(pressed[0].device == Device::mouse);
    CHECK(pressed[0].x == 110);
    CHECK(pressed[0].y == 220);
    CHECK(pressed[0].button == 0);
    CHECK(pressed[0].buttons == kLeft);
    CHECK(pressed[0].modifiers.alt);
    CHECK_FALSE(pressed[0].modifiers.shift);
    CHECK(pressed[1].pointer == 7);
    CHECK(pressed[1].device == Device::touch);
    CHECK(pressed[1].modifiers.shift);
}

TEST_CASE("wheel: a step is 100 pixels, 3 lines or a third of a page") {
    const Hands hands;
    const auto distance = [&](double delta, navigation::WheelInput::Unit unit) {
        return scene::focus_distance(navigation::wheel({delta, unit}, hands.camera, hands.context));
    };
    using Unit = navigation::WheelInput::Unit;
    CHECK(distance(-100, Unit::pixel) == doctest::Approx(5 / 1.1).epsilon(1e-13));
    CHECK(distance(-3, Unit::line) == doctest::Approx(5 / 1.1).epsilon(1e-13));
    CHECK(distance(-1.0 / 3, Unit::page) == doctest::Approx(5 / 1.1).epsilon(1e-13));
    CHECK(distance(100, Unit::pixel) == doctest::Approx(5 * 1.1).epsilon(1e-13));
    CHECK(distance(6, Unit::line) == doctest::Approx(5 * 1.21).epsilon(1e-13));
    CHECK(distance(1, Unit::page) == doctest::Approx(5 * 1.331).epsilon(1e-13));
    CHECK(distance(-50, Unit::pixel) == doctest::Approx(5 / std::sqrt(1.1)).epsilon(1e-13));
    for (const auto unit : {Unit::pixel, Unit::line, Unit::page}) {
        CHECK(navigation::wheel({0, unit}, hands.camera, hands.context) == hands.camera);
        const double radius = std::sqrt(3.0);
        for (const double huge : {1e9, 1e300, std::numeric_limits<double>::max()}) {
            CHECK(distance(-huge, unit) == doctest::Approx(radius * 1e-6).epsilon(1e-9));
            CHECK(distance(huge, unit) == doctest::Approx(radius * 1e6).epsilon(1e-9));
        }
    }
    navigation::NavigationContext fast = hands.context;
    fast.zoom_speed = 2;
    CHECK(scene::focus_distance(navigation::wheel({-100, Unit::pixel}, hands.camera, fast)) ==
          doctest::Approx(5 / 1.21).epsilon(1e-13));
}

TEST_CASE("keys") {
    Hands hands;
    hands.context.rotate_speed = hands.context.pan_speed = hands.context.zoom_speed = 7;  // not for keys
    scene::Camera home;
    home.eye = {9, 9, 9};
    const auto pressed = [&](const std::string& key, bool shift = false) {
        const std::optional<navigation::KeyOperation> operation = navigation::key_operation({key, shift, ""});
        return operation ? navigation::apply_key_operation(*operation, hands.camera, home, hands.context)
                         : hands.camera;
    };
    const double s = 5 * std::sin(5 * std::numbers::pi / 180), c = 5 * std::cos(5 * std::numbers::pi / 180);
    CHECK(near(pressed("ArrowRight").eye, {-s, 0, c}));
    CHECK(near(pressed("ArrowLeft").eye, {s, 0, c}));
    CHECK(near(pressed("ArrowDown").eye, {0, s, c}));
    CHECK(near(pressed("ArrowUp").eye, {0, -s, c}));

    const auto shifted = [&](const std::string& key) {
        Hands after = hands;
        after.camera = pressed(key, true);
        return after.pixel_of({0, 0, 0});
    };
    CHECK(near(shifted("ArrowRight"), {640 + 36, 360}));
    CHECK(near(shifted("ArrowLeft"), {640 - 36, 360}));
    CHECK(near(shifted("ArrowDown"), {640, 360 + 36}));
    CHECK(near(shifted("ArrowUp"), {640, 360 - 36}));

    CHECK(near(pressed("+").eye, {0, 0, 5 / 1.1}));
    CHECK(near(pressed("+", true).eye, {0, 0, 5 / 1.1}));
    CHECK(near(pressed("-").eye, {0, 0, 5 * 1.1}));
    CHECK(pressed("Home") == home);

    using Kind = navigation::KeyOperation::Kind;
    for (const auto& [key, kind] : {std::pair{"f", Kind::fit},
                                    {"w", Kind::toggle_wireframe},
                                    {"s", Kind::toggle_stylized},
                                    {"Escape", Kind::escape}}) {
        REQUIRE(navigation::key_operation({key, false, ""}).has_value());
        CHECK(navigation::key_operation({key, false, ""})->kind == kind);
        CHECK(pressed(key) == hands.camera);
    }
    for (const char* key : {"a", "F5", "Enter", "", "arrowleft", "Shift", "1", "=", "W", "F"})
        CHECK_FALSE(navigation::key_operation({key, false, ""}).has_value());
}
