#include "scene/clip_plane.hpp"

#include <algorithm>
#include <limits>

namespace vrut::scene {

glm::dvec4 clip_equation(const ClipPlane& plane, const glm::dmat4& world_from_node) {
    const glm::dvec3 normal = glm::transpose(glm::dmat3(world_from_node)) * plane.normal;
    return {-normal, plane.distance - glm::dot(plane.normal, glm::dvec3(world_from_node[3]))};
}

Side side_of(const math::Bounds& box, const glm::dvec4& equation) {
    const double middle = glm::dot(equation, glm::dvec4(box.center(), 1));
    const double reach = glm::dot(glm::abs(glm::dvec3(equation)), box.half_extent());
    if (middle + reach < 0) return Side::hidden;
    return middle - reach < 0 ? Side::crossed : Side::shown;
}

bool crosses(const glm::dvec4& equation, const Geometry& geometry) {
    if (side_of(geometry.bounds, equation) != Side::crossed) return false;
    const auto is_shown = [&](const glm::dvec3& p) { return glm::dot(equation, glm::dvec4(p, 1)) >= 0; };
    const auto& corners = geometry.positions;
    return std::any_of(corners.begin(), corners.end(), is_shown) &&
           !std::all_of(corners.begin(), corners.end(), is_shown);
}

std::optional<KeptInterval> kept_interval(std::span<const ClipPlane> planes, const glm::dvec3& origin,
                                          const glm::dvec3& direction) {
    KeptInterval kept{0, std::numeric_limits<double>::infinity(), {}};
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const double height = planes[i].distance - glm::dot(planes[i].normal, origin);
        const double rise = glm::dot(planes[i].normal, direction);
        if (rise > 0) kept.last = std::min(kept.last, height / rise);
        if (rise == 0 && height < 0) return {};
        if (rise >= 0 || height >= 0) continue;
        const double distance = height / rise;
        if (distance <= kept.first) continue;
        kept.first = distance;
        kept.cap = i;
    }
    if (!(kept.first <= kept.last)) return {};
    return kept;
}

Material cap_material(const Material& material) {
    Material cap;
    cap.id = material.id;
    cap.name = material.name;
    cap.ambient = material.ambient;
    cap.diffuse = glm::dvec4(glm::dvec3(material.diffuse), 1);
    cap.emission = material.emission;
    return cap;
}

}  // namespace vrut::scene
