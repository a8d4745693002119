#include "reference/tracer.hpp"

#include <algorithm>
#include <cmath>

namespace vrut::reference {

namespace {

const Image& image_of(const View& view, Index texture) {
    return view.scene->scene->textures()[static_cast<std::size_t>(texture)].image;
}

std::vector<std::optional<MipMap>> textures_in_use(const View& view, const Surfaces& surfaces) {
    std::vector<std::optional<MipMap>> textures;
    if (!view.scene) return textures;
    textures.resize(view.scene->scene->textures().size());
    const auto use = [&](Index texture) {
        if (texture == kNone) return;
        auto& map = textures[static_cast<std::size_t>(texture)];
        if (!map) map.emplace(image_of(view, texture));
    };
    for (const Part& part : surfaces.parts()) use(part.material->texture);
    use(view.background.texture);
    return textures;
}

std::optional<CubeMap> cube_map_of(const View& view) {
    if (!view.scene || !view.background.cube_map) return {};
    std::array<const Image*, 6> images{};
    for (std::size_t i = 0; i < 6; ++i) images[i] = &image_of(view, (*view.background.cube_map)[i]);
    return CubeMap(images);
}

glm::dvec3 reflect(const glm::dvec3& v, const glm::dvec3& normal) {
    return v - normal * (2 * glm::dot(v, normal));
}

}  // namespace

Tracer::Tracer(const View& view)
    : view_(view),
      surfaces_(view),
      textures_(textures_in_use(view, surfaces_)),
      cube_map_(cube_map_of(view)) {}

glm::dvec3 Tracer::color_at(const glm::dvec2& place) const { return color_of({sight_through(place), place}); }

Index Tracer::node_at(const glm::dvec2& place) const {
    const Sight sight = sight_through(place);
    std::optional<Meeting> first = surfaces_.first_opaque(sight);
    const auto before = surfaces_.transparent_before(sight, first);
    if (!before.empty()) first = before.front();
    return first ? surfaces_.parts()[first->part].node : kNone;
}

std::vector<Tracer::Layer> Tracer::layers_at(const glm::dvec2& place) const {
    std::vector<Layer> layers;
    const auto add = [&](const Look& look) {
        const std::optional<Meeting> opaque = surfaces_.first_opaque(look.sight, look.mirror);
        const bool in_mirror = look.mirror != Surfaces::kNoPart;
        for (const Meeting& meeting : surfaces_.transparent_before(look.sight, opaque, look.mirror))
            layers.push_back({meeting, look.sight, in_mirror});
        if (opaque) layers.push_back({*opaque, look.sight, in_mirror});
        return opaque;
    };
    const Look look{sight_through(place), place};
    const std::optional<Meeting> opaque = add(look);
    if (opaque && parts()[opaque->part].mirror) add(reflected(look, *opaque));
    return layers;
}

Sight Tracer::sight_through(const glm::dvec2& place) const {
    const glm::dvec3 view = view_direction(view_.camera), right = right_direction(view_.camera);
    const glm::dvec3 up = glm::cross(right, view);
    const double pixel = 2 * std::tan(view_.camera.fov * kRadiansPerDegree / 2) / view_.height;
    const glm::dvec3 way = view + right * ((place.x - view_.width / 2.0) * pixel) +
                           up * ((view_.height / 2.0 - place.y) * pixel);
    const double length = glm::length(way);
    return {glm::dvec3(0), way / length, {}, {right * (pixel / length), up * (pixel / length)}};
}

/// From the front to the back, until nothing shines through.
glm::dvec3 Tracer::color_of(const Look& look) const {
    const std::optional<Meeting> opaque = surfaces_.first_opaque(look.sight, look.mirror);
    glm::dvec3 color(0);
    double through = 1;
    for (const Meeting& meeting : surfaces_.transparent_before(look.sight, opaque, look.mirror)) {
        const Surface surface = surface_at(look, meeting);
        color += surface.color * (through * surface.alpha);
        through *= 1 - surface.alpha;
        if (through == 0) return color;
    }
    return color + (opaque ? surface_at(look, *opaque).color : background(look)) * through;
}

Tracer::Surface Tracer::surface_at(const Look& look, const Meeting& meeting) const {
    const Part& part = surfaces_.parts()[meeting.part];
    const Material& material = *part.material;
    const Spot spot = spot_of(part, meeting, look.sight);
    glm::dvec4 diffuse = material.diffuse;
    if (material.texture != kNone && !part.geometry->texcoords.empty()) {
        const glm::dvec4 texel = textures_[static_cast<std::size_t>(material.texture)]->sample(
            spot.texcoord, spot.texcoord_change, Wrap::repeat);
        diffuse = glm::dvec4(glm::dvec3(texel), diffuse.a * texel.a);
    }
    Surface surface{
        phong(material, glm::dvec3(diffuse), view_.light, view_.camera.eye, spot, -look.sight.direction),
        part.transparent ? std::clamp(diffuse.a, 0.0, 1.0) : 1};
    const double reflectivity = std::clamp(material.reflectivity, 0.0, 1.0);
    if (reflectivity == 0) return surface;
    if (part.mirror && look.mirror == Surfaces::kNoPart)
        surface.color = glm::mix(surface.color, color_of(reflected(look, meeting)), reflectivity);
    else if (!part.mirror && cube_map_)
        surface.color = glm::mix(surface.color, environment(look, spot), reflectivity);
    return surface;
}

/// As if the eye looked from behind the mirror's plane. The new ray starts on the plane, which the triangle
/// may miss by a hair; all before it is on the viewer's side.
Tracer::Look Tracer::reflected(const Look& look, const Meeting& meeting) const {
    const Plane& plane = *surfaces_.parts()[meeting.part].mirror;
    const Sight& ray = look.sight;
    const double approach = glm::dot(plane.normal, ray.direction);
    double distance = -plane.distance(ray.origin) / approach;
    // Only a view along the plane meets the one and not the other.
    if (!(distance > 0 && std::isfinite(distance))) distance = meeting.distance;
    Look result{{}, look.place, meeting.part};
    result.sight.origin = ray.origin + ray.direction * distance;
    result.sight.direction = glm::normalize(reflect(ray.direction, plane.normal));
    for (std::size_t i = 0; i < 2; ++i) {
        const glm::dvec3 move = ray.origin_change[i] + ray.direction_change[i] * distance;
        result.sight.origin_change[i] = move - ray.direction * (glm::dot(plane.normal, move) / approach);
        result.sight.direction_change[i] = reflect(ray.direction_change[i], plane.normal);
    }
    return result;
}

glm::dvec3 Tracer::environment(const Look& look, const Spot& spot) const {
    const glm::dvec3 &d = look.sight.direction, &n = spot.normal;
    std::array<glm::dvec3, 2> change{};
    for (std::size_t i = 0; i < 2; ++i) {
        const glm::dvec3 &d_change = look.sight.direction_change[i], &n_change = spot.normal_change[i];
        change[i] = reflect(d_change, n) - 2.0 * (glm::dot(d, n_change) * n + glm::dot(d, n) * n_change);
    }
    return cube_map_->sample(reflect(d, n), change);
}

glm::dvec3 Tracer::background(const Look& look) const {
    if (cube_map_) return cube_map_->sample(look.sight.direction, look.sight.direction_change);
    if (view_.scene && view_.background.texture != kNone) {
        const glm::dvec2 pixel = 1.0 / glm::dvec2(view_.width, view_.height);
        const glm::dvec2 place(look.place.x * pixel.x, 1 - look.place.y * pixel.y);
        const auto& map = textures_[static_cast<std::size_t>(view_.background.texture)];
        return glm::dvec3(map->sample(place, {glm::dvec2(pixel.x, 0), glm::dvec2(0, pixel.y)}, Wrap::clamp));
    }
    return glm::clamp(view_.background.color, 0.0, 1.0);
}

}  // namespace vrut::reference
