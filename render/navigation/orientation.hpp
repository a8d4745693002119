#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "scene/camera.hpp"

namespace vrut::navigation {

/// Unit vectors in world space, at right angles.
struct ViewBasis {
    glm::dvec3 view, up;
};

/// How a camera whose horizon is level is turned; radians.
struct LevelAngles {
    double
        around;  ///< of its right vector about the vertical, which is defined where the view is vertical, too
    double above;  ///< of the eye above the focus, -π/2 to π/2
};

/// None where the horizon is not level, or the scene stands on its head. Straight up and down count as level.
std::optional<LevelAngles> level_angles(const scene::Camera& camera);
ViewBasis view_basis(const LevelAngles& angles);

/// From the camera's axes to the world's.
glm::dquat orientation(const scene::Camera& camera);
/// The shortest turn from `a` to `b`: a world axis, as long as the angle in radians, 0 to π.
glm::dvec3 turn_between(const scene::Camera& a, const scene::Camera& b);

}  // namespace vrut::navigation
