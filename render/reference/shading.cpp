#include "reference/shading.hpp"

#include <algorithm>
#include <cmath>

#include "base/srgb.hpp"
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

/// In the direction of growing u, and on the side of growing v, across the normal.
std::array<glm::dvec3, 2> tangents_of(const TriangleVertices& corners, const glm::dvec3& normal) {
    const glm::dvec2 along = corners.texcoords[1] - corners.texcoords[0],
                     across = corners.texcoords[2] - corners.texcoords[0];
    const double determinant = along.x * across.y - along.y * across.x;
    const double sign = determinant < 0 ? -1 : 1;
    const glm::dvec3 u = sign * (corners.edges[0] * across.y - corners.edges[1] * along.y);
    const glm::dvec3 v = sign * (corners.edges[1] * along.x - corners.edges[0] * across.x);
    const glm::dvec3 tangent = unit(u - normal * glm::dot(normal, u));
    const glm::dvec3 bitangent = glm::cross(normal, tangent);
    return {tangent, glm::dot(bitangent, v) < 0 ? -bitangent : bitangent};
}

double fifth_power(double x) { return x * x * x * x * x; }

/// π times GGX's distribution and Smith's masking over 4 (n·l) (n·v).
double specular_lobe(double n_h, double n_l, double n_v, double roughness) {
    const double alpha = roughness * roughness, squared = alpha * alpha;
    const double spread = n_h * n_h * (squared - 1) + 1;
    const double masking = n_l * std::sqrt(n_v * n_v * (1 - squared) + squared) +
                           n_v * std::sqrt(n_l * n_l * (1 - squared) + squared);
    return squared / (spread * spread) * 0.5 / masking;
}

}  // namespace

SurfaceInteraction interaction_of(const TracedInstance& part, const TriangleHit& hit,
                                  const RayDifferential& ray) {
    SurfaceInteraction interaction;
    interaction.point = ray.origin + ray.direction * hit.distance;
    if (hit.cap) {
        interaction.normal = interaction.smooth_normal = hit.cap->normal;
        return interaction;
    }
    const TriangleVertices corners(part, hit.triangle);
    interaction.texcoord = corners.texcoords * hit.barycentrics;
    interaction.color = corners.colors * hit.barycentrics;
    const glm::dvec3 normal = corners.normals * hit.barycentrics;
    const double length = glm::length(normal);
    const bool vanishes = length < 1e-6;  // opposite neighbours
    interaction.normal = vanishes ? corners.face : normal / length;
    const bool turned = (part.two_sided || vanishes) && glm::dot(interaction.normal, ray.direction) > 0;
    if (part.material->normal_texture != scene::kNone && !part.geometry->texcoords.empty())
        interaction.tangents = tangents_of(corners, interaction.normal);
    if (turned) interaction.normal = -interaction.normal;
    interaction.smooth_normal = interaction.normal;
    interaction.side = turned ? -1 : 1;
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

glm::dvec3 mapped_normal(const SurfaceInteraction& interaction, const glm::dvec3& components) {
    const auto& [tangent, bitangent] = interaction.tangents;
    if (tangent == glm::dvec3(0)) return interaction.smooth_normal;
    const glm::dvec3 front = interaction.smooth_normal * interaction.side;
    return unit(tangent * components.x + bitangent * components.y + front * components.z) * interaction.side;
}

glm::dvec3 metallic_roughness(const MetallicSurface& surface, const scene::Light& light,
                              const glm::dvec3& eye, const SurfaceInteraction& interaction,
                              const glm::dvec3& to_viewer, const SurroundingLight& surroundings) {
    constexpr double kLeastCosine = 1e-3, kLeastRoughness = 0.05, kCoatRoughness = 0.1, kDielectric = 0.04;
    const double roughness = std::max(surface.roughness, kLeastRoughness);
    const glm::dvec3 matte = surface.base * (1 - surface.metallic);
    const glm::dvec3 facing = glm::mix(glm::dvec3(kDielectric), surface.base, surface.metallic);
    const auto cosine = [&](const glm::dvec3& normal) {
        return std::max(glm::dot(normal, to_viewer), kLeastCosine);
    };
    const double n_v = cosine(interaction.normal);

    const glm::dvec4 fit =
        roughness * glm::dvec4(-1, -0.0275, -0.572, 0.022) + glm::dvec4(1, 0.0425, 1.04, -0.04);
    const double bend = std::min(fit.x * fit.x, std::exp2(-9.28 * n_v)) * fit.x + fit.y;
    const double scale = -1.04 * bend + fit.z, offset = 1.04 * bend + fit.w, left = 1 - (scale + offset);
    const glm::dvec3 reflectance = facing * scale + offset;
    const glm::dvec3 mean = facing + (1.0 - facing) / 21.0;  // over all directions
    const glm::dvec3 scattered = reflectance * mean * left / (1.0 - left * mean);
    glm::dvec3 color =
        surface.occlusion * ((scattered + matte * (1.0 - reflectance - scattered)) * surroundings.irradiance +
                             reflectance * surroundings.glossy);

    const auto [to_light, arriving] = incident_light(light, eye, interaction.point);
    const glm::dvec3 power =
        glm::dvec3(light.color) * (arriving * (light.headlight ? scene::kHeadlightInEnvironment : 1));
    const glm::dvec3 half = unit(to_light + to_viewer);
    const double grazing = fifth_power(1 - std::max(glm::dot(to_viewer, half), 0.0));
    if (const double n_l = glm::dot(interaction.normal, to_light); n_l > 0) {
        const glm::dvec3 fresnel = facing + (1.0 - facing) * grazing;
        const double lobe = specular_lobe(glm::dot(interaction.normal, half), n_l, n_v, roughness);
        color += (matte * (1.0 - fresnel) + fresnel * lobe) * power * n_l;
    }

    if (surface.clear_coat > 0) {
        const double coat_n_v = cosine(interaction.smooth_normal);
        const double n_l = glm::dot(interaction.smooth_normal, to_light);
        const double through =
            surface.clear_coat * (kDielectric + (1 - kDielectric) * fifth_power(1 - coat_n_v));
        color = color * (1 - through) + surroundings.sharp * through;
        if (n_l > 0)
            color += power * (n_l * surface.clear_coat * (kDielectric + (1 - kDielectric) * grazing) *
                              specular_lobe(glm::dot(interaction.smooth_normal, half), n_l, coat_n_v,
                                            kCoatRoughness));
    }
    return base::srgb_from_linear(color);
}

}  // namespace vrut::reference
