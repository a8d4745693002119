#include "navigation/camera_moves.hpp"

#include <algorithm>
#include <cmath>

namespace vrut::navigation {

namespace {

// Eye and focus closer than this part of their coordinates would no longer say a direction.
constexpr double kResolution = 1e-12;

/// Rodrigues' formula; `axis` is unit.
glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double radians) {
    const double c = std::cos(radians), s = std::sin(radians);
    return v * c + glm::cross(axis, v) * s + axis * (glm::dot(axis, v) * (1 - c));
}

double closest_at(const glm::dvec3& point) {
    return kResolution * std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
}

/// A camera that looks straight up or down does not: either side of it may be up.
bool hangs_upside_down(const scene::Camera& camera) { return camera.up.y < -1e-12; }

/// `moved`, or `camera` where the move left the range of double.
scene::Camera if_valid(const scene::Camera& moved, const scene::Camera& camera) {
    return scene::is_valid_pose(moved, 0) ? moved : camera;
}

/// Clamps a pitch rotation about the right axis so that up · vertical keeps its sign. As a function of the
/// angle that product is a cosine: the allowed range is half a turn around its peak.
double clamp_pitch(const scene::Camera& camera, double radians) {
    const double up = camera.up.y, back = -scene::view_direction(camera).y;
    if (std::hypot(up, back) < 1e-12) return radians;  // the right axis is vertical: nothing can tip over
    const double sign = hangs_upside_down(camera) ? -1 : 1;
    // up(a) · vertical = up cos a + back sin a, greatest at a = atan2(back, up).
    const double peak = std::atan2(sign * back, sign * up);
    const double quarter = std::numbers::pi / 2;
    return std::clamp(radians, std::min(peak - quarter, 0.0), std::max(peak + quarter, 0.0));
}

/// Of tangents, along one axis of the view.
struct Span {
    double low, high;
};

/// Its middle part.
Span filled(const Span& span, double part) {
    const double middle = (span.low + span.high) / 2, half = (span.high - span.low) / 2 * part;
    return {middle - half, middle + half};
}

}  // namespace

FitTarget fit_target(const math::Bounds& box) {
    return {box, [box](const glm::dvec3& direction) {
                const glm::dvec3 farthest = glm::max(direction * box.min, direction * box.max);
                return farthest.x + farthest.y + farthest.z;
            }};
}

scene::Camera fitted(const scene::Camera& camera, const FitTarget& target, double aspect,
                     const Cover& cover) {
    constexpr double kFilled = 0.84;     // of the free width or height
    constexpr double kLeastDepth = 0.1;  // of the nearest point, in radii
    const glm::dvec3 middle = target.box.center();
    const double radius = target.box.radius();
    const double least = std::max(radius == 0 ? 1.0 : 0.0, closest_at(middle));
    if (radius < least) return fitted(camera, fit_target({middle - least, middle + least}), aspect, cover);

    const glm::dvec3 right = scene::right_direction(camera), back = -scene::view_direction(camera);
    const math::Projection view = scene::projection_of(camera, aspect);
    const Span x =
        filled({view.left + cover.left * view.width(), view.right - cover.right * view.width()}, kFilled);
    const Span y =
        filled({view.bottom + cover.bottom * view.height(), view.top - cover.top * view.height()}, kFilled);
    // A point p is within the right side where p · (right + x back) is at most the eye's; the others alike.
    const auto reach = [&](const glm::dvec3& side) { return target.support(side) - glm::dot(side, middle); };
    const double to_right = reach(x.high * back + right), to_left = reach(-x.low * back - right);
    const double to_top = reach(y.high * back + camera.up), to_bottom = reach(-y.low * back - camera.up);
    const double distance =
        std::max({(to_right + to_left) / (x.high - x.low), (to_top + to_bottom) / (y.high - y.low),
                  reach(back) + kLeastDepth * radius});
    // As far from one side as from the other.
    const double across = (to_right - to_left - (x.high + x.low) * distance) / 2;
    const double upwards = (to_top - to_bottom - (y.high + y.low) * distance) / 2;
    scene::Camera result = camera;
    result.center = middle;
    result.focus = middle + right * across + camera.up * upwards;
    result.eye = result.focus + back * distance;
    return result;
}

scene::Camera home_camera(const FitTarget& target, double aspect, const Cover& cover) {
    scene::Camera camera;
    camera.focus = {0, 0, 0};
    camera.eye = {1, 0.45, 1.25};
    return fitted(scene::with_orthogonal_up(camera), target, aspect, cover);
}

scene::Camera rotated(const scene::Camera& camera, double right, double down, bool keep_upright) {
    // The scene turns one way, the camera the other.
    const double yaw = -right * scene::kRadiansPerDegree;
    double pitch = -down * scene::kRadiansPerDegree;
    if (keep_upright) pitch = clamp_pitch(camera, pitch);
    if (yaw == 0 && pitch == 0) return camera;

    const glm::dvec3 across = scene::right_direction(camera);
    const glm::dvec3 axis = !keep_upright               ? camera.up
                            : hangs_upside_down(camera) ? -scene::kVertical
                                                        : scene::kVertical;
    const auto turn = [&](const glm::dvec3& v) { return turned(turned(v, across, pitch), axis, yaw); };
    scene::Camera result = camera;
    result.eye = camera.center + turn(camera.eye - camera.center);
    result.focus = camera.center + turn(camera.focus - camera.center);
    result.up = turn(camera.up);
    return if_valid(scene::with_orthogonal_up(result), camera);
}

scene::Camera looked_around(const scene::Camera& camera, double right, double down, bool keep_upright) {
    scene::Camera result = camera;
    result.center = camera.eye;  // the scene turns about it, the other way
    result = rotated(result, right, down, keep_upright);
    result.eye = camera.eye;
    result.center = camera.center;
    return result;
}

scene::Camera panned(const scene::Camera& camera, double right, double down, double depth) {
    if (right == 0 && down == 0) return camera;
    const double height = depth * scene::projection_of(camera, 1).height();
    const glm::dvec3 shift = (camera.up * down - scene::right_direction(camera) * right) * height;
    scene::Camera result = camera;
    result.eye += shift;
    result.focus += shift;
    return if_valid(result, camera);
}

scene::Camera panned(const scene::Camera& camera, double right, double down) {
    return panned(camera, right, down, scene::focus_distance(camera));
}

scene::Camera zoomed(const scene::Camera& camera, double factor, double scene_radius,
                     const glm::dvec3& point) {
    if (factor == 1) return camera;
    const double distance = scene::focus_distance(camera);
    const double radius = scene_radius > 0 ? scene_radius : 1;
    const double closest = std::max(radius * 1e-6, closest_at(camera.focus));
    // A pose given from outside may lie beyond the limits; then they are where it stands.
    const double wanted =
        std::clamp(distance / factor, std::min(distance, closest), std::max(distance, radius * 1e6));
    if (std::abs(wanted - distance) < 1e-14 * distance) return camera;  // at a limit
    scene::Camera result = camera;
    result.focus = point + (camera.focus - point) * (wanted / distance);
    result.eye = result.focus - scene::view_direction(camera) * wanted;
    return if_valid(result, camera);
}

scene::Camera zoomed(const scene::Camera& camera, double factor, double scene_radius) {
    return zoomed(camera, factor, scene_radius, camera.focus);
}

}  // namespace vrut::navigation
