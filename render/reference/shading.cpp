#include "reference/shading.hpp"

#include <algorithm>
#include <cmath>

#include "scene/camera.hpp"

namespace vrut::reference {

namespace {

/// Zero where there is no direction.
glm::dvec3 unit(const glm::dvec3& v) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return largest > 0 ? glm::normalize(v / largest) : glm::dvec3(0);
}

/// Of the corners, as the eye sees them; all are 0 for a triangle without area.
struct Corners {
    Corners(const Part& part, std::uint32_t triangle) {
        const glm::uvec3& at = part.geometry->triangles[triangle];
        const auto& given = part.geometry->positions;
        const glm::dvec3 own_face =
            unit(glm::cross(unit(given[at.y] - given[at.x]), unit(given[at.z] - given[at.x])));
        for (int k = 0; k < 3; ++k) {
            const auto corner = static_cast<std::size_t>(at[k]);
            const glm::dvec3 normal =
                part.geometry->normals.empty() ? glm::dvec3(0) : glm::dvec3(part.geometry->normals[corner]);
            normals[k] = unit(part.normal_matrix * (normal == glm::dvec3(0) ? own_face : unit(normal)));
            if (!part.geometry->texcoords.empty()) texcoords[k] = part.geometry->texcoords[corner];
        }
        sides[0] = part.positions[at.y] - part.positions[at.x];
        sides[1] = part.positions[at.z] - part.positions[at.x];
        face = unit(glm::cross(unit(sides[0]), unit(sides[1])));
    }

    glm::dmat3 normals{0};
    glm::dmat3x2 texcoords{0};
    std::array<glm::dvec3, 2> sides{};  ///< from the first corner to the others
    glm::dvec3 face{0};                 ///< normal of the plane
};

/// How the weights of the corners change where the point moves by `move` on their plane.
glm::dvec3 change_of_weights(const Corners& corners, const glm::dvec3& move) {
    const glm::dvec3 area = glm::cross(corners.sides[0], corners.sides[1]);
    const double doubled = glm::dot(area, corners.face);
    const double v = glm::dot(glm::cross(move, corners.sides[1]), corners.face) / doubled;
    const double w = glm::dot(glm::cross(corners.sides[0], move), corners.face) / doubled;
    return {-v - w, v, w};
}

double attenuated(const Light& light, double d) {
    const glm::dvec3 given = light.attenuation == glm::dvec3(0) ? glm::dvec3(1, 0, 0) : light.attenuation;
    return 1 / std::max(given.x + given.y * d + given.z * d * d, 1e-6);
}

/// 1 - cos, exact near 0.
double short_of_one(double radians) {
    const double sine = std::sin(radians / 2);
    return 2 * sine * sine;
}

/// smoothstep(cos(angle / 2), cos(0.45 angle), cos θ), by what the cosines are short of 1.
double in_cone(const Light& light, const glm::dvec3& from_light) {
    const double angle = light.angle * kRadiansPerDegree;
    const double outer = short_of_one(angle / 2), inner = short_of_one(0.45 * angle);
    const glm::dvec3 off = from_light - light.direction;
    const double here = glm::dot(off, off) / 2;
    if (here >= outer) return 0;
    const double t = std::min((outer - here) / (outer - inner), 1.0);
    return t * t * (3 - 2 * t);
}

struct Incoming {
    glm::dvec3 to_light{0};  ///< unit
    double intensity = 1;
};

Incoming incoming(const Light& light, const glm::dvec3& eye, const glm::dvec3& point) {
    if (!light.headlight && light.type == LightData::Type::directional) return {-light.direction, 1};
    const glm::dvec3 way = (light.headlight ? glm::dvec3(0) : light.position - eye) - point;
    Incoming result{unit(way), attenuated(light, glm::length(way))};
    if (!light.headlight && light.type == LightData::Type::spot)
        result.intensity *= in_cone(light, -result.to_light);
    return result;
}

}  // namespace

Spot spot_of(const Part& part, const Meeting& meeting, const Sight& ray) {
    const Corners corners(part, meeting.triangle);
    Spot spot;
    spot.point = ray.origin + ray.direction * meeting.distance;
    spot.texcoord = corners.texcoords * meeting.weights;
    const glm::dvec3 normal = corners.normals * meeting.weights;
    const double length = glm::length(normal);
    const bool vanishes = length < 1e-6;  // opposite neighbours
    spot.normal = vanishes ? corners.face : normal / length;
    const bool turned = (part.both_sides || vanishes) && glm::dot(spot.normal, ray.direction) > 0;
    if (turned) spot.normal = -spot.normal;
    for (std::size_t i = 0; i < 2; ++i) {
        // The neighbouring pixel's ray, met with the triangle's plane.
        const glm::dvec3 move = ray.origin_change[i] + ray.direction_change[i] * meeting.distance;
        const glm::dvec3 on_plane =
            move - ray.direction * (glm::dot(corners.face, move) / glm::dot(corners.face, ray.direction));
        const glm::dvec3 weights = change_of_weights(corners, on_plane);
        spot.texcoord_change[i] = corners.texcoords * weights;
        if (vanishes) continue;
        const glm::dvec3 change = corners.normals * weights * (turned ? -1.0 : 1.0);
        spot.normal_change[i] = (change - spot.normal * glm::dot(spot.normal, change)) / length;
    }
    return spot;
}

glm::dvec3 phong(const Material& material, const glm::dvec3& diffuse, const Light& light,
                 const glm::dvec3& eye, const Spot& spot, const glm::dvec3& to_viewer) {
    const auto [to_light, intensity] = incoming(light, eye, spot.point);
    const double cosine = glm::dot(to_light, spot.normal), lambert = std::max(cosine, 0.0);
    const glm::dvec3 reflected = spot.normal * (2 * cosine) - to_light;
    const double highlight = std::pow(std::max(glm::dot(reflected, to_viewer), 0.0), material.shininess);
    const glm::dvec3 lit = diffuse + glm::dvec3(material.specular) * highlight;
    const glm::dvec3 base = glm::dvec3(material.emission) + glm::dvec3(material.ambient);
    return glm::clamp(base + lit * glm::dvec3(light.color) * (lambert * intensity), 0.0, 1.0);
}

}  // namespace vrut::reference
