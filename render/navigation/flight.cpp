#include "navigation/flight.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace vrut::navigation {

namespace {

struct ViewBasis {
    glm::dvec3 view, up;
};

/// The horizon is level, and the scene does not stand on its head. Straight up and down count, too.
bool is_level(const scene::Camera& camera) {
    return std::abs(scene::right_direction(camera).y) < 1e-9 && camera.up.y > -1e-9;
}

/// Radians: of the right vector around the vertical, which tells more than the view where that is vertical.
double azimuth(const scene::Camera& camera) {
    const glm::dvec3 right = scene::right_direction(camera);
    return std::atan2(-right.z, right.x);
}

/// Radians of the eye above the focus, -π/2 to π/2.
double elevation(const scene::Camera& camera) {
    return std::atan2(-scene::view_direction(camera).y, camera.up.y);
}

ViewBasis between_level(const scene::Camera& a, const scene::Camera& b, double part) {
    const double from = azimuth(a), turn = std::remainder(azimuth(b) - from, 2 * std::numbers::pi);
    constexpr double kUpright = std::numbers::pi / 2;
    const double around = from + turn * part,
                 above = std::clamp(std::lerp(elevation(a), elevation(b), part), -kUpright, kUpright);
    const glm::dvec3 ahead(-std::sin(around), 0, -std::cos(around));
    const double c = std::cos(above), s = std::sin(above);
    return {ahead * c - scene::kVertical * s, ahead * s + scene::kVertical * c};
}

glm::dquat orientation(const scene::Camera& camera) {
    const glm::dvec3 back = -scene::view_direction(camera), right = scene::right_direction(camera);
    return glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
}

ViewBasis between_any(const scene::Camera& a, const scene::Camera& b, double part) {
    const glm::dquat turned = glm::normalize(glm::slerp(orientation(a), orientation(b), part));
    return {turned * glm::dvec3(0, 0, -1), turned * glm::dvec3(0, 1, 0)};
}

}  // namespace

scene::Camera on_the_way(const scene::Camera& a, const scene::Camera& b, double part) {
    if (part <= 0 || a == b) return a;
    if (part == 1) return b;
    const ViewBasis basis = is_level(a) && is_level(b) ? between_level(a, b, part) : between_any(a, b, part);
    const double distance =
        scene::focus_distance(a) * std::pow(scene::focus_distance(b) / scene::focus_distance(a), part);
    scene::Camera result;
    result.focus = a.focus + (b.focus - a.focus) * part;
    result.center = a.center + (b.center - a.center) * part;
    result.fov = std::lerp(a.fov, b.fov, part);
    result.eye = result.focus - basis.view * distance;
    result.up = basis.up;
    // Very near to something very far off the way is finer than double tells.
    if (!scene::is_valid_pose(result, 0)) return part < 0.5 ? a : b;
    return scene::with_orthogonal_up(result);
}

CameraPath::CameraPath(const scene::Camera& from, const std::vector<CameraKeyframe>& keyframes, Easing easing)
    : path_{{0, from}}, easing_(easing) {
    if (!keyframes.empty() && keyframes.front().at <= 0) path_.clear();
    path_.insert(path_.end(), keyframes.begin(), keyframes.end());
}

scene::Camera CameraPath::at(double ms) const {
    const auto next = std::upper_bound(path_.begin(), path_.end(), ms,
                                       [](double time, const CameraKeyframe& key) { return time < key.at; });
    if (next == path_.begin()) return path_.front().camera;
    if (next == path_.end() || std::prev(next)->at == ms) return std::prev(next)->camera;
    const auto index = static_cast<std::size_t>(std::prev(next) - path_.begin());
    return on_the_way(path_[index].camera, path_[index + 1].camera, std::min(progress(index, ms), 1.0));
}

// The way through the keyframes, counted in keyframes, is a monotone cubic of time: Fritsch and Butland, A
// method for constructing local monotone piecewise cubic interpolants (1984).
double CameraPath::progress(std::size_t index, double ms) const {
    const double step = path_[index + 1].at - path_[index].at;
    const double t = (ms - path_[index].at) / step;
    if (easing_ == Easing::linear) return t;
    const double start = slope(index) * step, end = slope(index + 1) * step;
    return t * t * (3 - 2 * t) + t * (1 - t) * (start * (1 - t) - end * t);
}

/// Keyframes per ms while passing one: the harmonic mean of those before and after it.
double CameraPath::slope(std::size_t index) const {
    const bool at_an_end = index == 0 || index + 1 == path_.size();
    return at_an_end ? 0 : 2 / (path_[index + 1].at - path_[index - 1].at);
}

}  // namespace vrut::navigation
