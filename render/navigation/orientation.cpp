#include "navigation/orientation.hpp"

#include <cmath>

namespace vrut::navigation {

std::optional<LevelAngles> level_angles(const scene::Camera& camera) {
    const glm::dvec3 right = scene::right_direction(camera);
    if (std::abs(right.y) >= 1e-9 || camera.up.y <= -1e-9) return std::nullopt;
    return LevelAngles{std::atan2(-right.z, right.x),
                       std::atan2(-scene::view_direction(camera).y, camera.up.y)};
}

ViewBasis view_basis(const LevelAngles& angles) {
    const glm::dvec3 ahead(-std::sin(angles.around), 0, -std::cos(angles.around));
    const double c = std::cos(angles.above), s = std::sin(angles.above);
    return {ahead * c - scene::kVertical * s, ahead * s + scene::kVertical * c};
}

glm::dquat orientation(const scene::Camera& camera) {
    const glm::dvec3 back = -scene::view_direction(camera), right = scene::right_direction(camera);
    return glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
}

glm::dvec3 turn_between(const scene::Camera& a, const scene::Camera& b) {
    glm::dquat turn = orientation(b) * glm::conjugate(orientation(a));
    if (turn.w < 0) turn = -turn;
    const glm::dvec3 axis(turn.x, turn.y, turn.z);
    const double length = glm::length(axis);
    return length > 0 ? axis * (2 * std::atan2(length, turn.w) / length) : glm::dvec3(0);
}

}  // namespace vrut::navigation
