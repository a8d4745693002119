#include "navigation/flight.hpp"

#include <algorithm>
#include <cmath>

#include "navigation/orientation.hpp"

namespace vrut::navigation {

namespace {

ViewBasis between_level(const LevelAngles& a, const LevelAngles& b, double part) {
    const double turn = std::remainder(b.around - a.around, 2 * std::numbers::pi);
    constexpr double kUpright = std::numbers::pi / 2;
    return view_basis(
        {a.around + turn * part, std::clamp(std::lerp(a.above, b.above, part), -kUpright, kUpright)});
}

ViewBasis between_any(const scene::Camera& a, const scene::Camera& b, double part) {
    const glm::dquat turned = glm::normalize(glm::slerp(orientation(a), orientation(b), part));
    return {turned * glm::dvec3(0, 0, -1), turned * glm::dvec3(0, 1, 0)};
}

}  // namespace

scene::Camera on_the_way(const scene::Camera& a, const scene::Camera& b, double part) {
    if (part <= 0 || a == b) return a;
    if (part == 1) return b;
    const auto from = level_angles(a), to = level_angles(b);
    const ViewBasis basis = from && to ? between_level(*from, *to, part) : between_any(a, b, part);
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
