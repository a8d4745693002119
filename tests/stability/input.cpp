// Studies of fingers, clocks and links that deliver less than was sent.
#include <cmath>

#include "navigation/camera_moves.hpp"
#include "navigation/clicks.hpp"
#include "navigation/gestures.hpp"
#include "study.hpp"

namespace vrut::stability {

namespace {

navigation::PointerInput touch(navigation::PointerInput::Action action, const glm::dvec2& place) {
    navigation::PointerInput input;
    input.action = action;
    input.client = "c1";
    input.pointer = 1;
    input.device = navigation::PointerInput::Device::touch;
    input.x = place.x;
    input.y = place.y;
    input.button = action == navigation::PointerInput::Action::move ? -1 : 0;
    input.buttons = action == navigation::PointerInput::Action::up ? 0 : 1;
    return input;
}

}  // namespace

Study moves_lost(const Laboratory& laboratory) {
    Study study{"lost-moves", "Moves of a drag that are merged or lost", "moves lost, in percent",
                "where the eye ends, error / its distance"};
    study.bound = 0;
    study.baseline.title = "each move turns on from the one before";
    study.method.title = "from the drag's start and where the pointer is";
    study.explanation =
        "A drag is a function of the camera at its start and of the pointers' places: moves may be merged or "
        "lost, and the last one alone decides.";
    study.cost = "None: one move is computed where several came.";
    const scene::Camera start =
        navigation::home_camera(navigation::fit_target({{-1, -1, -1}, {1, 1, 1}}), 1.5);
    navigation::NavigationContext context;
    context.keep_upright = false;
    const auto place = [](int i) {
        return glm::dvec2(640 + 300 * std::sin(i * 0.05), 360 + 200 * std::sin(i * 0.08));
    };
    const auto drag = [&](double percent, bool on_from_before) {
        constexpr int kMoves = 200;
        Noise noise;
        navigation::Gestures gestures;
        scene::Camera camera =
            gestures.pointer(touch(navigation::PointerInput::Action::down, place(0)), start, context);
        glm::dvec2 before = place(0);
        for (int i = 1; i <= kMoves; ++i) {
            if (i < kMoves && 50 * (noise.next() + 1) < percent) continue;
            if (on_from_before) {
                const glm::dvec2 degrees = (place(i) - before) * 180.0 / context.height;
                camera = navigation::rotated(camera, degrees.x, degrees.y, false);
            } else {
                camera = gestures.pointer(touch(navigation::PointerInput::Action::move, place(i)), camera,
                                          context);
            }
            before = place(i);
        }
        return camera.eye;
    };
    const bool turns = glm::distance(drag(0, false), start.eye) > 0.01 * scene::focus_distance(start);
    for (const double percent : laboratory.chosen({1, 10, 30, 50, 70, 90, 99})) {
        const auto off = [&](bool on_from_before) {
            return glm::distance(drag(percent, on_from_before), drag(0, on_from_before)) /
                   scene::focus_distance(start);
        };
        study.baseline.points.push_back({percent, off(true)});
        study.method.points.push_back({percent, turns ? off(false) : kNothing});
    }
    return study;
}

Study releases_lost(const Laboratory& laboratory) {
    Study study{"lost-releases", "Releases of a finger that are lost", "pixels to where it is pressed next",
                "degrees that the view turns, and fingers left pressed"};
    study.bound = 1e-9;
    study.baseline.title = "the next press goes on with the drag";
    study.method.title = "a press begins anew, and who leaves is lifted";
    study.explanation =
        "A second press of a pressed pointer begins a new drag where it is; a client that leaves has its "
        "pointers lifted; the camera stays where it is.";
    study.cost = "None.";
    const scene::Camera start =
        navigation::home_camera(navigation::fit_target({{-1, -1, -1}, {1, 1, 1}}), 1.5);
    navigation::NavigationContext context;
    context.keep_upright = false;
    const glm::dvec2 place(640, 360);
    const auto degrees = [&](const scene::Camera& a, const scene::Camera& b) {
        return glm::degrees(
            2 * std::asin(std::min(1.0, glm::distance(a.eye, b.eye) / 2 / scene::focus_distance(start))));
    };
    for (const double pixels : laboratory.chosen({1, 3, 10, 30, 100, 300})) {
        using Action = navigation::PointerInput::Action;
        const glm::dvec2 next = place + glm::dvec2(pixels, 0);
        navigation::Gestures gestures;
        scene::Camera camera = gestures.pointer(touch(Action::down, place - 50.0), start, context);
        camera = gestures.pointer(touch(Action::move, place), camera, context);
        const scene::Camera pressed_again = gestures.pointer(touch(Action::down, next), camera, context);
        gestures.lift("c1", pressed_again);
        navigation::PointerInput other = touch(Action::down, place);
        other.client = "c2";
        scene::Camera after = gestures.pointer(other, pressed_again, context);
        other = touch(Action::move, next);
        other.client = "c2";
        after = gestures.pointer(other, after, context);
        // As it is where nobody pressed before.
        navigation::Gestures fresh;
        other.action = Action::down;
        other.x = place.x;
        other.button = 0;
        scene::Camera alone = fresh.pointer(other, pressed_again, context);
        other = touch(Action::move, next);
        other.client = "c2";
        alone = fresh.pointer(other, alone, context);
        const scene::Camera swept = navigation::rotated(camera, pixels * 180 / context.height, 0, false);
        study.baseline.points.push_back({pixels, degrees(swept, camera)});
        const bool turns = camera.eye != start.eye && after.eye != pressed_again.eye;
        study.method.points.push_back(
            {pixels,
             turns ? degrees(pressed_again, camera) + degrees(after, alone) + gestures.is_pressed("c1", 1)
                   : kNothing});
    }
    return study;
}

Study jittering_taps(const Laboratory& laboratory) {
    Study study{"jitter", "Double taps of a hand that shakes", "jitter of each press, up to so many pixels",
                "taps that are not taken for one, in percent"};
    study.bound = 5;
    study.limit = 7;
    study.method.title = "10 pixels from press to release, 24 between the two";
    study.explanation =
        "Beyond, it is a drag, which the hand sees at once and can take back; nothing is selected.";
    study.cost = "Two targets less than 24 pixels apart cannot be tapped one after the other within 0.4 s.";
    constexpr int kTaps = 300;
    for (const double pixels : laboratory.chosen({1, 2, 4, 7, 20, 50, 100})) {
        Noise noise;
        int missed = 0;
        for (int tap = 0; tap < kTaps; ++tap) {
            navigation::Clicks clicks;
            bool found = false;
            std::chrono::microseconds time{0};
            for (int press = 0; press < 2; ++press)
                for (const auto action :
                     {navigation::PointerInput::Action::down, navigation::PointerInput::Action::up}) {
                    const glm::dvec2 place(300 + pixels * noise.next(), 200 + pixels * noise.next());
                    found = clicks.pointer(touch(action, place), {{}, time}).has_value() || found;
                    time += std::chrono::milliseconds(80);
                }
            missed += !found;
        }
        study.method.points.push_back({pixels, 100.0 * missed / kTaps});
    }
    return study;
}

Study jumping_clocks(const Laboratory& laboratory) {
    Study study{"clocks", "A client's clock that jumps", "jump between two events, in ms",
                "error of the time between them, in ms"};
    study.bound = 1000;
    study.method.title = "time stamps, where the arrival agrees within a second";
    study.explanation =
        "Where a time stamp falls, is absent, or departs from the arrival by more than a second, the arrival "
        "counts.";
    study.cost = "A link that holds an event up for more than a second may split a double click.";
    for (const double jump : laboratory.chosen({1, 10, 100, 1e3, 3e3, 1e4, 1e6, 1e9})) {
        double worst = 0;
        for (const double direction : {1.0, -1.0}) {
            navigation::EventClock clock;
            constexpr std::chrono::milliseconds kFirst{50}, kBetween{2000};
            const auto first = clock.time({1e6, kFirst});
            const auto second = clock.time({1e6 + kBetween.count() + direction * jump, kFirst + kBetween});
            worst = std::max(
                worst,
                std::abs(std::chrono::duration<double, std::milli>(second - first - kBetween).count()));
        }
        study.method.points.push_back({jump, worst});
    }
    return study;
}

}  // namespace vrut::stability
