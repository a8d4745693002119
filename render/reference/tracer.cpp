#include "reference/tracer.hpp"

#include <algorithm>
#include <cmath>

#include "base/srgb.hpp"

namespace vrut::reference {

namespace {

constexpr scene::Sampler kClamp{{scene::Wrap::clamp, scene::Wrap::clamp}};

const scene::Image& image_of(const plan::View& view, scene::Index texture) {
    return view.scene->scene->textures()[static_cast<std::size_t>(texture)].image;
}

std::vector<std::optional<MipMap>> textures_in_use(const plan::View& view, const TracedScene& surfaces) {
    std::vector<std::optional<MipMap>> textures;
    if (!view.scene) return textures;
    textures.resize(view.scene->scene->textures().size());
    const auto use = [&](scene::Index texture) {
        if (texture == scene::kNone) return;
        auto& map = textures[static_cast<std::size_t>(texture)];
        if (!map) map.emplace(image_of(view, texture));
    };
    for (const TracedInstance& part : surfaces.parts()) {
        for (const scene::Index texture :
             {part.material->texture, part.material->emissive_texture,
              part.material->occlusion_roughness_metallic_texture, part.material->normal_texture})
            use(texture);
    }
    use(view.background.texture);
    return textures;
}

/// Of a view with a scene and a cube map.
std::array<const scene::Image*, 6> cube_images(const plan::View& view) {
    std::array<const scene::Image*, 6> images{};
    for (std::size_t i = 0; i < 6; ++i) images[i] = &image_of(view, (*view.background.cube_map)[i]);
    return images;
}

std::optional<CubeMap> cube_map_of(const plan::View& view) {
    if (!view.scene || !view.background.cube_map) return {};
    return CubeMap(cube_images(view));
}

/// By the level of EnvironmentLight::prefiltered.
double level_of(double roughness) { return roughness * (scene::EnvironmentLight::kLevels - 1); }

glm::dvec3 reflect(const glm::dvec3& v, const glm::dvec3& normal) {
    return v - normal * (2 * glm::dot(v, normal));
}

}  // namespace

Tracer::Tracer(const plan::View& view)
    : view_(view), scene_(view), textures_(textures_in_use(view, scene_)), cube_map_(cube_map_of(view)) {
    const auto needs_light = [](const TracedInstance& part) {
        return part.material->metallic_roughness.has_value();
    };
    if (!cube_map_ || std::ranges::none_of(scene_.parts(), needs_light)) return;
    environment_light_ = scene::prefilter(cube_images(view));
    prefiltered_.emplace(environment_light_.prefiltered);
}

glm::dvec3 Tracer::color_at(const glm::dvec2& raster) const {
    return radiance({generate_ray(raster), raster});
}

scene::Index Tracer::node_at(const glm::dvec2& raster) const {
    const RayDifferential ray = generate_ray(raster);
    std::optional<TriangleHit> first = scene_.closest_opaque_hit(ray);
    const auto before = scene_.transparent_hits_before(ray, first);
    if (!before.empty()) first = before.front();
    return first ? scene_.parts()[first->part].node : scene::kNone;
}

std::vector<Tracer::VisibleHit> Tracer::hits_at(const glm::dvec2& raster) const {
    std::vector<VisibleHit> hits;
    const auto add = [&](const PathRay& path) {
        const std::optional<TriangleHit> opaque = scene_.closest_opaque_hit(path.ray, path.mirror);
        const bool in_mirror = path.mirror != TracedScene::kNoInstance;
        for (const TriangleHit& hit : scene_.transparent_hits_before(path.ray, opaque, path.mirror))
            hits.push_back({hit, path.ray, in_mirror});
        if (opaque) hits.push_back({*opaque, path.ray, in_mirror});
        return opaque;
    };
    const PathRay path{generate_ray(raster), raster};
    const std::optional<TriangleHit> opaque = add(path);
    if (opaque && parts()[opaque->part].mirror) add(reflected(path, *opaque));
    return hits;
}

RayDifferential Tracer::generate_ray(const glm::dvec2& raster) const {
    const glm::dvec3 view = scene::view_direction(view_.camera), right = scene::right_direction(view_.camera);
    const glm::dvec3 up = glm::cross(right, view);
    const double pixel = plan::projection_of(view_).height() / view_.height;
    const glm::dvec3 way = view + right * ((raster.x - view_.width / 2.0) * pixel) +
                           up * ((view_.height / 2.0 - raster.y) * pixel);
    const double length = glm::length(way);
    return {glm::dvec3(0), way / length, {}, {right * (pixel / length), up * (pixel / length)}};
}

/// From the front to the back, until nothing shines through.
glm::dvec3 Tracer::radiance(const PathRay& path) const {
    const std::optional<TriangleHit> opaque = scene_.closest_opaque_hit(path.ray, path.mirror);
    glm::dvec3 color(0);
    double transmittance = 1;
    for (const TriangleHit& hit : scene_.transparent_hits_before(path.ray, opaque, path.mirror)) {
        const ShadedSurface surface = surface_at(path, hit);
        color += surface.color * (transmittance * surface.alpha);
        transmittance *= 1 - surface.alpha;
        if (transmittance == 0) return color;
    }
    return color + (opaque ? surface_at(path, *opaque).color : background(path)) * transmittance;
}

Tracer::ShadedSurface Tracer::surface_at(const PathRay& path, const TriangleHit& hit) const {
    const TracedInstance& part = scene_.parts()[hit.part];
    const scene::Material& material = material_at(part, hit);
    SurfaceInteraction interaction = interaction_of(part, hit, path.ray);
    if (hit.cap)
        return {phong(material, glm::dvec3(material.diffuse), view_.light, view_.camera.eye, interaction,
                      -path.ray.direction)};
    const glm::dvec4 image =
        texel(material.texture, part, interaction, glm::dvec4(glm::dvec3(material.diffuse), 1));
    const glm::dvec3 diffuse(image);
    const double alpha = material.diffuse.a * image.a;
    if (interaction.tangents[0] != glm::dvec3(0) && material.normal_scale != 0) {
        const glm::dvec4 map = texel(material.normal_texture, part, interaction, glm::dvec4(0));
        interaction.normal =
            mapped_normal(interaction, (2.0 * glm::dvec3(map) - 1.0) *
                                           glm::dvec3(material.normal_scale, material.normal_scale, 1));
    }
    ShadedSurface surface{
        material.metallic_roughness && cube_map_
            ? metallic_color(path, part, interaction, diffuse * interaction.color)
            : phong(material, diffuse, view_.light, view_.camera.eye, interaction, -path.ray.direction),
        part.transparent ? std::clamp(alpha, 0.0, 1.0) : 1};
    if (material.emissive != glm::dvec3(0))
        surface.color =
            base::srgb_from_linear(base::linear_from_srgb(surface.color) + emitted_light(part, interaction));
    const double reflectivity = std::clamp(material.reflectivity, 0.0, 1.0);
    if (reflectivity == 0) return surface;
    if (part.mirror && path.mirror == TracedScene::kNoInstance)
        surface.color = glm::mix(surface.color, radiance(reflected(path, hit)), reflectivity);
    else if (!part.mirror && cube_map_)
        surface.color =
            glm::mix(surface.color, environment(path, interaction, interaction.normal), reflectivity);
    return surface;
}

glm::dvec4 Tracer::texel(scene::Index texture, const TracedInstance& part,
                         const SurfaceInteraction& interaction, const glm::dvec4& none) const {
    if (texture == scene::kNone || part.geometry->texcoords.empty()) return none;
    const auto index = static_cast<std::size_t>(texture);
    return textures_[index]->sample(interaction.texcoord, interaction.duv_dxy,
                                    view_.scene->scene->textures()[index].sampler);
}

glm::dvec3 Tracer::metallic_color(const PathRay& path, const TracedInstance& part,
                                  const SurfaceInteraction& interaction,
                                  const glm::dvec3& displayed_base) const {
    const scene::Material& material = *part.material;
    const glm::dvec4 image =
        texel(material.occlusion_roughness_metallic_texture, part, interaction, glm::dvec4(1));
    const auto [metallic, roughness, clear_coat] = *material.metallic_roughness;
    const MetallicSurface surface{base::linear_from_srgb(glm::clamp(displayed_base, 0.0, 1.0)),
                                  metallic * image.b, roughness * image.g, clear_coat, image.r};
    SurroundingLight surroundings;
    surroundings.irradiance = scene::irradiance(environment_light_, interaction.normal);
    const glm::dvec3 root =
        prefiltered_->sample(reflect(path.ray.direction, interaction.normal), level_of(surface.roughness));
    surroundings.glossy = root * root;
    if (clear_coat > 0)
        surroundings.sharp =
            base::linear_from_srgb(environment(path, interaction, interaction.smooth_normal));
    return metallic_roughness(surface, view_.light, view_.camera.eye, interaction, -path.ray.direction,
                              surroundings);
}

/// RGB, linear.
glm::dvec3 Tracer::emitted_light(const TracedInstance& part, const SurfaceInteraction& interaction) const {
    const glm::dvec4 image = texel(part.material->emissive_texture, part, interaction, glm::dvec4(1));
    return part.material->emissive * base::linear_from_srgb(glm::dvec3(image));
}

/// The new ray starts on the mirror's plane, which the triangle may miss by a rounding error; everything in
/// front of it is on the viewer's side.
Tracer::PathRay Tracer::reflected(const PathRay& path, const TriangleHit& hit) const {
    const math::Plane& plane = *scene_.parts()[hit.part].mirror;
    const RayDifferential& ray = path.ray;
    const double approach = glm::dot(plane.normal, ray.direction);
    double distance = -plane.distance(ray.origin) / approach;
    // Only a view along the plane meets the one and not the other.
    if (!(distance > 0 && std::isfinite(distance))) distance = hit.distance;
    PathRay result{{}, path.raster, hit.part};
    result.ray.origin = ray.origin + ray.direction * distance;
    result.ray.direction = glm::normalize(reflect(ray.direction, plane.normal));
    for (std::size_t i = 0; i < 2; ++i) {
        const glm::dvec3 move = ray.dorigin_dxy[i] + ray.ddirection_dxy[i] * distance;
        result.ray.dorigin_dxy[i] = move - ray.direction * (glm::dot(plane.normal, move) / approach);
        result.ray.ddirection_dxy[i] = reflect(ray.ddirection_dxy[i], plane.normal);
    }
    return result;
}

glm::dvec3 Tracer::environment(const PathRay& path, const SurfaceInteraction& interaction,
                               const glm::dvec3& normal) const {
    const glm::dvec3 &d = path.ray.direction, &n = interaction.smooth_normal;
    std::array<glm::dvec3, 2> change{};
    for (std::size_t i = 0; i < 2; ++i) {
        const glm::dvec3 &dd_dxy = path.ray.ddirection_dxy[i], &dn_dxy = interaction.dn_dxy[i];
        change[i] = reflect(dd_dxy, n) - 2.0 * (glm::dot(d, dn_dxy) * n + glm::dot(d, n) * dn_dxy);
    }
    return cube_map_->sample(reflect(d, normal), change);
}

glm::dvec3 Tracer::background(const PathRay& path) const {
    if (view_.background.shows_cube_map())
        return cube_map_->sample(path.ray.direction, path.ray.ddirection_dxy);
    if (view_.scene && view_.background.texture != scene::kNone) {
        const glm::dvec2 pixel = 1.0 / glm::dvec2(view_.width, view_.height);
        const glm::dvec2 uv(path.raster.x * pixel.x, 1 - path.raster.y * pixel.y);
        const auto& map = textures_[static_cast<std::size_t>(view_.background.texture)];
        return glm::dvec3(map->sample(uv, {glm::dvec2(pixel.x, 0), glm::dvec2(0, pixel.y)}, kClamp));
    }
    return glm::clamp(view_.background.color, 0.0, 1.0);
}

}  // namespace vrut::reference
