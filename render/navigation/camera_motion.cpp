#include "navigation/camera_motion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "navigation/flight.hpp"

namespace vrut::navigation {

namespace {

/// Messages that come together count as one step.
constexpr double kOneStepMs = 8;
/// Who has not moved for so long stands still.
constexpr double kStillMs = 25;
/// Of a way ahead, as way_between() measures it: a frame from farther off is of little use to a warp.
constexpr double kFarthest = glm::pi<double>() / 4;
/// About a pixel.
constexpr double kLeast = 1e-3;
/// The first step of a drag is slow, and so is whatever comes before a jump.
constexpr double kFaster = 2;

/// Radians, of unit vectors.
double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return 2 * std::asin(std::min(glm::distance(a, b) / 2, 1.0));
}

/// Radians of a turn, or the parts of the focus' distance by which the camera was moved.
double way_between(const scene::Camera& a, const scene::Camera& b) {
    const double distance = scene::focus_distance(a);
    return std::max({angle_between(scene::view_direction(a), scene::view_direction(b)),
                     angle_between(a.up, b.up), glm::distance(a.focus, b.focus) / distance,
                     std::abs(std::log(scene::focus_distance(b) / distance))});
}

}  // namespace

void CameraMotion::add(double ms, const scene::Camera& camera) {
    if (!steps_.empty() && steps_.back().camera == camera) return;
    if (!steps_.empty() && ms - steps_.back().ms < kOneStepMs)
        steps_.back().camera = camera;
    else
        steps_.push_back({ms, camera});
    if (steps_.size() > 3) steps_.pop_front();
}

bool CameraMotion::stands_still(double ms) const {
    return steps_.size() < 3 || ms - steps_.back().ms > kStillMs;
}

double CameraMotion::speed(double ms) const {
    if (stands_still(ms)) return 0;
    const Step &first = steps_[0], &second = steps_[1], &last = steps_[2];
    const double before = way_between(first.camera, second.camera) / (second.ms - first.ms);
    const double now = way_between(second.camera, last.camera) / (last.ms - second.ms);
    return 1000 * std::min(kFaster * before, now);
}

std::optional<scene::Camera> CameraMotion::ahead(double ms, double ahead) const {
    if (stands_still(ms)) return std::nullopt;
    const Step &second = steps_[1], &last = steps_[2];
    const double farther = std::min(speed(ms) * (ms - last.ms + ahead) / 1000, kFarthest);
    if (!(farther > kLeast)) return std::nullopt;
    const double way = way_between(second.camera, last.camera);
    scene::Camera camera = on_the_way(second.camera, last.camera, 1 + farther / way);
    camera.fov = last.camera.fov;  // which would soon leave its range
    return camera;
}

}  // namespace vrut::navigation
