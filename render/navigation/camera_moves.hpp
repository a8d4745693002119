#pragma once

#include "math/bounds.hpp"
#include "scene/camera.hpp"

namespace vrut::navigation {

/// The camera, looking along the same direction, from where the sphere around `bounds` just fits into a view
/// of `aspect`: distance r / sin(half of the smaller fov). Empty bounds count as a unit sphere at the origin.
scene::Camera fitted(const scene::Camera& camera, const math::Bounds& bounds, double aspect);
/// The view of a scene without a camera node: three quarters from the front and above, fitted.
scene::Camera home_camera(const math::Bounds& bounds, double aspect);

// Camera moves. Each returns the camera bit-identical if the move is zero or its result is not finite.

/// The scene turns by `right` and `down` degrees, as if dragged there, around `camera.center`. With
/// `keep_upright` about the scene's vertical, and `down` stops at the poles, so that the scene never stands
/// on its head; else about the camera's own up.
scene::Camera rotated(const scene::Camera& camera, double right, double down, bool keep_upright);
/// The image moves right and down by fractions of the view's height in the plane at `depth`, or through
/// `focus`.
scene::Camera panned(const scene::Camera& camera, double right, double down, double depth);
scene::Camera panned(const scene::Camera& camera, double right, double down);
/// Eye and focus come nearer to `point`, or the eye to `focus`: the distance between them is divided by
/// `factor` (above 0), and stays within 10⁻⁶ and 10⁶ of `scene_radius`. The point stays where it is seen.
scene::Camera zoomed(const scene::Camera& camera, double factor, double scene_radius,
                     const glm::dvec3& point);
scene::Camera zoomed(const scene::Camera& camera, double factor, double scene_radius);

}  // namespace vrut::navigation
