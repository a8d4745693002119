// Studies of the camera.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "navigation/camera_moves.hpp"
#include "navigation/gestures.hpp"
#include "scene/camera.hpp"
#include "study.hpp"

namespace vrut::stability {

Study many_moves(const Laboratory& laboratory) {
    Study study{"moves", "Turns one after the other", "turns", "distance from the centre, relative error"};
    study.bound = 1e-6;
    study.baseline.title = "matrices in single precision, piled up";
    study.method.title = "pose in double, made orthogonal again";
    study.explanation =
        "The camera is a pose in double; a drag is computed from where it began, and a turn keeps the "
        "distances from the centre.";
    study.cost = "Less than a microsecond a move.";
    const scene::Camera start =
        navigation::home_camera(navigation::fit_target({{-1, -1, -1}, {1, 1, 1}}), 1.5);
    const double radius = glm::distance(start.eye, start.center);
    const glm::vec3 axis(glm::normalize(glm::dvec3(0.3, 1, 0.2)));
    const glm::mat4 turn = glm::rotate(glm::mat4(1), 0.7F, axis);
    glm::mat4 piled(1);
    scene::Camera camera = start;
    double done = 0;
    for (const double count : laboratory.chosen({1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7})) {
        for (; done < count; ++done) {
            piled = turn * piled;
            camera = navigation::rotated(camera, 11.3, done < count / 2 ? 3.1 : -2.7, false);
        }
        const auto off = [&](const glm::dvec3& eye) { return std::abs(glm::length(eye) / radius - 1); };
        study.baseline.points.push_back(
            {count, off(glm::dvec3(piled * glm::vec4(glm::vec3(start.eye - start.center), 1)))});
        const bool has_turned = glm::distance(camera.eye, start.eye) > 0.01 * radius;
        study.method.points.push_back({count, has_turned ? off(camera.eye - camera.center) : kNothing});
    }
    return study;
}

Study over_the_pole(const Laboratory& laboratory) {
    Study study{"pole", "Turning over the pole", "degrees dragged down",
                "tilt of the picture's up from the vertical, in degrees"};
    study.bound = 90.001;
    study.baseline.title = "about the camera's own up";
    study.method.title = "kept upright";
    study.explanation =
        "With keepUpright the scene turns about its own vertical, and tipping stops at the poles; a drag "
        "back comes back at once.";
    study.cost = "None.";
    scene::Camera level;
    level.eye = {0, 0, 5};
    for (const double degrees : laboratory.chosen({1, 10, 30, 60, 89, 100, 170, 300, 890, 1e4, 1e6 + 100})) {
        const auto tilt = [&](const scene::Camera& camera) {
            return glm::degrees(std::acos(std::clamp(glm::dot(camera.up, scene::kVertical), -1.0, 1.0)));
        };
        study.baseline.points.push_back({degrees, tilt(navigation::rotated(level, 0, degrees, false))});
        const scene::Camera upright = navigation::rotated(level, 0, degrees, true);
        const bool has_turned = glm::distance(upright.eye, level.eye) > 0.01;
        study.method.points.push_back({degrees, has_turned ? tilt(upright) : kNothing});
    }
    return study;
}

Study through_the_focus(const Laboratory& laboratory) {
    Study study{"zoom", "Wheel steps towards the focus", "steps at one blow",
                "degrees by which the view has turned"};
    study.bound = 0.001;
    study.baseline.title = "a tenth of the distance a step";
    study.method.title = "the distance divided by 1.1 a step";
    study.explanation =
        "Zoom divides the distance between eye and focus, and ends at a millionth and at a million of the "
        "scene's radius.";
    study.cost = "None.";
    const scene::Camera start =
        navigation::home_camera(navigation::fit_target({{-1, -1, -1}, {1, 1, 1}}), 1.5);
    const glm::dvec3 view = scene::view_direction(start);
    for (const double steps : laboratory.chosen({1, 5, 9, 11, 100, 1e3, 1e6, 1e9})) {
        scene::Camera linear = start;
        linear.eye += view * (0.1 * steps * scene::focus_distance(start));
        const auto turned = [&](const scene::Camera& camera) {
            const double cosine = glm::dot(view, glm::normalize(camera.focus - camera.eye));
            return glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
        };
        study.baseline.points.push_back({steps, turned(linear)});
        const scene::Camera zoomed =
            navigation::wheel({-100 * steps, navigation::WheelInput::Unit::pixel}, start, {});
        const bool is_nearer = scene::focus_distance(zoomed) < 0.95 * scene::focus_distance(start);
        study.method.points.push_back({steps, is_nearer ? turned(zoomed) : kNothing});
    }
    return study;
}

Study largest_numbers(const Laboratory& laboratory) {
    Study study{"numbers", "Poses at the end of the range", "distance of eye and focus from the origin",
                "numbers of the camera that are none"};
    study.bound = 0;
    study.baseline.title = "turned as it is asked";
    study.method.title = "a move that no number can hold is not made";
    study.explanation = "The camera stays as it is, to the bit; messages with such poses are refused before.";
    study.cost = "One look at 13 numbers a move.";
    constexpr double kTurned = 1e30;  // the farthest pose that messages may have
    for (const double far : laboratory.chosen({1, 1e10, 1e50, 1e100, 1e150, 1e200, 1e250, 1e280})) {
        scene::Camera camera;
        camera.eye = {far, far, 2 * far};
        camera.focus = {far, far, far};
        const auto none = [](const glm::dvec3& v) {
            return !std::isfinite(v.x) + !std::isfinite(v.y) + !std::isfinite(v.z);
        };
        // As the length of a vector is usually computed.
        const glm::dvec3 arm = camera.eye - camera.center;
        const glm::dvec3 turned = arm / std::sqrt(glm::dot(arm, arm)) * std::sqrt(glm::dot(arm, arm));
        study.baseline.points.push_back({far, 1.0 * none(turned)});
        const scene::Camera after = navigation::rotated(camera, 30, 20, true);
        if (far <= kTurned && after.eye == camera.eye) {
            study.method.points.push_back({far, kNothing});
            continue;
        }
        study.method.points.push_back(
            {far, 1.0 * (none(after.eye) + none(after.focus) + none(after.up) + none(after.center))});
    }
    return study;
}

}  // namespace vrut::stability
