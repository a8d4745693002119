#pragma once

#include <functional>
#include <glm/glm.hpp>

#include "math/bounds.hpp"
#include "scene/camera.hpp"

namespace vrut::navigation {

/// What is fitted into a view, in world space.
struct FitTarget {
    math::Bounds box;  ///< holds it
    /// How far it reaches in a direction d: the largest d · p of its points p (its support function).
    std::function<double(const glm::dvec3& direction)> support;
};
FitTarget fit_target(const math::Bounds& box);

/// What covers a view's sides, in parts of its width and height. The rest of it is free.
struct Cover {
    double left = 0, right = 0, top = 0, bottom = 0;
};

/// The camera, looking along the same direction, from where the target just fits into what is free of a view
/// of `aspect`: in its middle, with a margin of 8 % on all sides, and no nearer than a tenth of its box's
/// radius. `focus` lies on the view's axis at the depth of the box's centre, which `center` is. An empty or
/// pointlike target counts as a cube of side 2.
scene::Camera fitted(const scene::Camera& camera, const FitTarget& target, double aspect,
                     const Cover& cover = {});
/// The view of a scene without a camera node: three quarters from the front and above, fitted.
scene::Camera home_camera(const FitTarget& target, double aspect, const Cover& cover = {});

// Camera moves. Each returns the camera bit-identical if the move is zero or its result is not finite.

/// The scene turns by `right` and `down` degrees, as if dragged there, around `camera.center`. With
/// `keep_upright` about the scene's vertical, and `down` stops at the poles, so that the scene never stands
/// on its head; else about the camera's own up.
scene::Camera rotated(const scene::Camera& camera, double right, double down, bool keep_upright);
/// The view turns by `right` and `down` degrees about the eye.
scene::Camera looked_around(const scene::Camera& camera, double right, double down, bool keep_upright);
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
