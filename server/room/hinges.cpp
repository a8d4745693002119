#include "room/hinges.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "scene/camera.hpp"

namespace vrut::server::room {

scene::Index hinged(const scene::Scene& scene, scene::Index node) {
    const auto at = [&](scene::Index index) -> const scene::Node& {
        return scene.nodes()[static_cast<std::size_t>(index)];
    };
    while (node != scene::kNone && !at(node).hinge) node = at(node).parent;
    return node;
}

glm::dmat4 opened(const scene::Node& node, double part) {
    const double radians = part * node.hinge->degrees * scene::kRadiansPerDegree;
    return node.matrix * glm::rotate(glm::dmat4(1), radians, scene::unit_axis(*node.hinge));
}

double opened_part(const scene::Node& node, const glm::dmat4& matrix) {
    const double whole = node.hinge->degrees * scene::kRadiansPerDegree;
    if (whole == 0 || matrix == node.matrix) return 0;
    const glm::dvec3 axis = scene::unit_axis(*node.hinge);
    const glm::dvec3 sizes = glm::abs(axis);
    const bool along_x = sizes.x <= std::min(sizes.y, sizes.z);
    const glm::dvec3 across = glm::normalize(glm::cross(
        axis, along_x ? glm::dvec3(1, 0, 0) : glm::dvec3(0, sizes.y < sizes.z, sizes.y >= sizes.z)));
    const glm::dvec3 turned(glm::inverse(node.matrix) * matrix * glm::dvec4(across, 0));
    double radians = std::atan2(glm::dot(turned, glm::cross(axis, across)), glm::dot(turned, across));
    if (radians * whole < 0 && std::abs(whole) > std::numbers::pi)
        radians += std::copysign(2 * std::numbers::pi, whole);
    const double part = radians / whole;
    return std::isfinite(part) ? std::clamp(part, 0.0, 1.0) : 0;
}

std::optional<double> hinge_part(const scene::Node& node, const glm::dmat4& matrix) {
    if (!node.hinge) return std::nullopt;
    constexpr double kNear = 1e-9;
    const double part = opened_part(node, matrix);
    const glm::dmat4 turned = part == 0 ? node.matrix : opened(node, part);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) {
            const double size = std::max(1.0, std::abs(node.matrix[column][row]));
            if (!(std::abs(turned[column][row] - matrix[column][row]) <= kNear * size)) return std::nullopt;
        }
    return part;
}

}  // namespace vrut::server::room
