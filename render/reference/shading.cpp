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
struct TriangleVertices {
    TriangleVertices(const TracedInstance& part, std::uint32_t triangle) {
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
            if (part.colored) colors[k] = part.geometry->colors[corner];
        }
        edges[0] = part.positions[at.y] - part.positions[at.x];
        edges[1] = part.positions[at.z] - part.positions[at.x];
        face = unit(glm::cross(unit(edges[0]), unit(edges[1])));
    }

    glm::dmat3 normals{0};
    glm::dmat3x2 texcoords{0};
    glm::dmat3 colors{1, 1, 1, 1, 1, 1, 1, 1, 1};
    std::array<glm::dvec3, 2> edges{};  ///< from the first corner to the others
    glm::dvec3 face{0};                 ///< normal of the plane
};

/// How the barycentrics change where the point moves by `move` on their plane.
glm::dvec3 dbarycentrics(const TriangleVertices& corners, const glm::dvec3& move) {
    const glm::dvec3 area = glm::cross(corners.edges[0], corners.edges[1]);
    const double doubled = glm::dot(area, corners.face);
    const double v = glm::dot(glm::cross(move, corners.edges[1]), corners.face) / doubled;
    const double w = glm::dot(glm::cross(corners.edges[0], move), corners.face) / doubled;
    return {-v - w, v, w};
}

double attenuated(const scene::Light& light, double d) {
    const glm::dvec3 given = light.attenuation == glm::dvec3(0) ? glm::dvec3(1, 0, 0) : light.attenuation;
    return 1 / std::max(given.x + given.y * d + given.z * d * d, 1e-6);
}

/// 1 - cos, exact near 0.
double short_of_one(double radians) {
    const double sine = std::sin(radians / 2);
    return 2 * sine * sine;
}

/// smoothstep(cos(angle / 2), cos(0.45 angle), cos θ), by what the cosines are short of 1.
double in_cone(const scene::Light& light, const glm::dvec3& from_light) {
    const double angle = light.angle * scene::kRadiansPerDegree;
    const double outer = short_of_one(angle / 2), inner = short_of_one(0.45 * angle);
    const glm::dvec3 off = from_light - light.direction;
    const double here = glm::dot(off, off) / 2;
    if (here >= outer) return 0;
    const double t = std::min((outer - here) / (outer - inner), 1.0);
    return t * t * (3 - 2 * t);
}

struct IncidentLight {
    glm::dvec3 to_light{0};  ///< unit
    double intensity = 1;
};

IncidentLight incident_light(const scene::Light& light, const glm::dvec3& eye, const glm::dvec3& point) {
    if (!light.headlight && light.type == scene::LightData::Type::directional) return {-light.direction, 1};
    const glm::dvec3 way = (light.headlight ? glm::dvec3(0) : light.position - eye) - point;
    IncidentLight result{unit(way), attenuated(light, glm::length(way))};
    if (!light.headlight && light.type == scene::LightData::Type::spot)
        result.intensity *= in_cone(light, -result.to_light);
    return result;
}

}  // namespace

SurfaceInteraction interaction_of(const TracedInstance& part, const TriangleHit& hit,
                                  const RayDifferential& ray) {
    const TriangleVertices corners(part, hit.triangle);
    SurfaceInteraction interaction;
    interaction.point = ray.origin + ray.direction * hit.distance;
    interaction.texcoord = corners.texcoords * hit.barycentrics;
    interaction.color = corners.colors * hit.barycentrics;
    const glm::dvec3 normal = corners.normals * hit.barycentrics;
    const double length = glm::length(normal);
    const bool vanishes = length < 1e-6;  // opposite neighbours
    interaction.normal = vanishes ? corners.face : normal / length;
    const bool turned = (part.two_sided || vanishes) && glm::dot(interaction.normal, ray.direction) > 0;
    if (turned) interaction.normal = -interaction.normal;
    for (std::size_t i = 0; i < 2; ++i) {
        // The neighbouring pixel's ray, met with the triangle's plane.
        const glm::dvec3 move = ray.dorigin_dxy[i] + ray.ddirection_dxy[i] * hit.distance;
        const glm::dvec3 on_plane =
            move - ray.direction * (glm::dot(corners.face, move) / glm::dot(corners.face, ray.direction));
        const glm::dvec3 barycentrics = dbarycentrics(corners, on_plane);
        interaction.duv_dxy[i] = corners.texcoords * barycentrics;
        if (vanishes) continue;
        const glm::dvec3 change = corners.normals * barycentrics * (turned ? -1.0 : 1.0);
        interaction.dn_dxy[i] = (change - interaction.normal * glm::dot(interaction.normal, change)) / length;
    }
    return interaction;
}

glm::dvec3 phong(const scene::Material& material, const glm::dvec3& diffuse, const scene::Light& light,
                 const glm::dvec3& eye, const SurfaceInteraction& interaction, const glm::dvec3& to_viewer) {
    const auto [to_light, intensity] = incident_light(light, eye, interaction.point);
    const double cosine = glm::dot(to_light, interaction.normal), lambert = std::max(cosine, 0.0);
    const glm::dvec3 reflected = interaction.normal * (2 * cosine) - to_light;
    const double highlight = std::pow(std::max(glm::dot(reflected, to_viewer), 0.0), material.shininess);
    const glm::dvec3 lit = diffuse * interaction.color + glm::dvec3(material.specular) * highlight;
    const glm::dvec3 base = glm::dvec3(material.emission) + glm::dvec3(material.ambient) * interaction.color;
    return glm::clamp(base + lit * glm::dvec3(light.color) * (lambert * intensity), 0.0, 1.0);
}

}  // namespace vrut::reference
