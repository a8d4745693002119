#pragma once

#include <glm/glm.hpp>
#include <numbers>

#include "math/bounds.hpp"
#include "math/projection.hpp"
#include "scene/scene.hpp"

namespace vrut::scene {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180;
/// The scene's vertical.
inline constexpr glm::dvec3 kVertical{0, 1, 0};

/// A pose in world space, in double. `up` is unit and at right angles to the view; `center` is what rotations
/// turn around. Near and far are not part of it: they follow from the scene (fit_clip_range).
struct Camera {
    glm::dvec3 eye{0, 0, 5}, focus{0, 0, 0}, up{0, 1, 0}, center{0, 0, 0};
    double fov = 40;  ///< vertical, degrees, 1 to 170

    bool operator==(const Camera&) const = default;
};

double focus_distance(const Camera& camera);
/// Unit vectors of the camera's axes: along the view, and to its right (view × up).
glm::dvec3 view_direction(const Camera& camera);
glm::dvec3 right_direction(const Camera& camera);

/// False where eye and focus are closer than 10⁻⁹ of `scene_radius`, `up` is zero or lies along the view, or
/// anything is not finite.
bool is_valid_pose(const Camera& camera, double scene_radius);
/// The same camera with `up` at right angles to the view and unit; the pose must be valid.
Camera with_orthogonal_up(Camera camera);

/// Returns `pose`, for which no up was given, with the roll of `before`: an upright (or upside-down) camera
/// stays so.
Camera with_roll_of(const Camera& before, Camera pose);

struct ClipRange {
    double near = 0.1, far = 100;
    bool operator==(const ClipRange&) const = default;
};

/// The tightest near and far around `bounds`; near is never below 10⁻⁶ of far, or 10⁻³ of the focus' distance
/// where that is less.
ClipRange fit_clip_range(const Camera& camera, const math::Bounds& bounds);

/// Right-handed, view along −z.
glm::dmat4 view_from_world(const Camera& camera);
/// What the camera sees in an image of `aspect`, its width / height.
math::Projection projection_of(const Camera& camera, double aspect);

/// Unit direction from the eye, in world space, through a point of a view of `aspect`: x and y from −1 (left,
/// top) to 1 (right, bottom).
glm::dvec3 direction_through(const Camera& camera, double aspect, const glm::dvec2& point);

/// Returns the present pose of a camera node in world space; none if it is not valid (is_valid_pose).
std::optional<Camera> camera_at(const PlacedScene& placed, Index camera_node);
/// Where drags look around from: a ball about a camera node's eye, in world space (CameraData::look_radius).
struct Seat {
    glm::dvec3 eye{0};
    double radius = 0;
};
std::vector<Seat> seats(const PlacedScene& placed);
/// Returns whether `eye` is within one of them.
bool looks_around_from(const PlacedScene& placed, const glm::dvec3& eye);
/// Returns the scene's initial camera: the camera node with the lowest id if there is one, its pose is valid,
/// and it sees something that can be drawn, where there is anything; else kNone.
Index first_camera_node(const PlacedScene& placed);
/// A sentence where there is a camera node and none is the initial camera.
std::optional<std::string> why_not_first_camera(const PlacedScene& placed);

}  // namespace vrut::scene
