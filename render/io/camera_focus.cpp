#include "io/camera_focus.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "io/placed_parts.hpp"
#include "math/ray_space.hpp"
#include "mesh/bvh.hpp"

namespace vrut::io {

namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
constexpr double kClose = 1e-3;  ///< of the scene's radius: what is nearer does not count
constexpr std::size_t kMostLooks = std::size_t{1} << 24;

struct Ray {
    glm::dvec3 origin, direction;
};

struct ShownGeometry {
    const scene::Geometry* geometry = nullptr;
    glm::dmat4 node_from_world{1};
};

struct Shown {
    std::vector<ShownGeometry> geometries;
    math::Bounds bounds;            ///< in world space
    std::size_t left = kMostLooks;  ///< at boxes and triangles
};

Shown shown_in(const scene::SceneParts& parts, const scene::PlacedScene& placed) {
    Shown shown;
    const std::vector<bool> shown_near = nodes_shown_near(placed);
    for (std::size_t i = 0; i < shown_near.size(); ++i) {
        const auto* data = std::get_if<scene::GeometryData>(&placed.scene->nodes()[i].data);
        if (!shown_near[i] || !data || data->geometry == scene::kNone) continue;
        const scene::Geometry& geometry = parts.geometries[static_cast<std::size_t>(data->geometry)];
        const glm::dmat4 node_from_world = glm::inverse(placed.world[i]);
        if (geometry.triangles.empty() || !scene::is_finite(node_from_world)) continue;
        shown.geometries.push_back({&geometry, node_from_world});
        for (const glm::dvec3& corner : math::corners(geometry.bounds))
            shown.bounds.add(glm::dvec3(placed.world[i] * glm::dvec4(corner, 1)));
    }
    return shown;
}

/// How far along the ray it meets the triangle, whose corners are in the ray's space; infinite where it
/// misses it.
double meets_at(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double u = math::edge_function(c, b), v = math::edge_function(a, c), w = math::edge_function(b, a);
    const double area = u + v + w;
    const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    return inside && area != 0 ? a.z + (v * (b.z - a.z) + w * (c.z - a.z)) / area : kNothing;
}

/// The first surface beyond `nearest`, both in lengths of the direction.
double first_surface(const Ray& ray, double nearest, Shown& shown) {
    struct Entry {
        double at;
        const ShownGeometry* shown;
        Ray ray;  ///< in the node's space
    };
    if (shown.geometries.size() > shown.left) return kNothing;
    shown.left -= shown.geometries.size();
    std::vector<Entry> entries;
    for (const ShownGeometry& candidate : shown.geometries) {
        const Ray local{glm::dvec3(candidate.node_from_world * glm::dvec4(ray.origin, 1)),
                        glm::dvec3(candidate.node_from_world * glm::dvec4(ray.direction, 0))};
        const math::Bounds& bounds = candidate.geometry->bounds;
        const glm::dvec3 largest =
            glm::max(glm::abs(local.origin), glm::max(glm::abs(bounds.min), glm::abs(bounds.max)));
        const double at = mesh::SlabRay(local.origin, local.direction, 1e-14 * largest).entry(bounds);
        if (at < kNothing) entries.push_back({at, &candidate, local});
    }
    std::ranges::sort(entries, {}, &Entry::at);
    double first = kNothing;
    for (const Entry& entry : entries) {
        const scene::Geometry& geometry = *entry.shown->geometry;
        if (entry.at >= first || geometry.triangles.size() > shown.left) break;
        shown.left -= geometry.triangles.size();
        const double length = glm::length(entry.ray.direction);
        const math::RaySpace space(entry.ray.direction / length);
        const auto corner = [&](unsigned vertex) {
            return space.to_ray_space(geometry.positions[vertex] - entry.ray.origin);
        };
        for (const glm::uvec3& corners : geometry.triangles) {
            const double at = meets_at(corner(corners.x), corner(corners.y), corner(corners.z)) / length;
            if (at > nearest) first = std::min(first, at);
        }
    }
    return first;
}

}  // namespace

void focus_on_what_is_seen(scene::SceneParts& parts) {
    const auto wants_focus = [](const scene::SceneParts::PartNode& part) {
        const auto* camera = std::get_if<scene::CameraData>(&part.node.data);
        return camera && std::abs(glm::distance(camera->eye, camera->focus) - 1) < 1e-9;
    };
    if (std::ranges::none_of(parts.nodes, wants_focus)) return;
    const std::optional<scene::PlacedScene> placed = placed_nodes(parts);
    if (!placed) return;
    Shown shown = shown_in(parts, *placed);
    if (shown.geometries.empty()) return;
    const double close = kClose * shown.bounds.radius();
    for (scene::SceneParts::PartNode& part : parts.nodes) {
        if (!wants_focus(part)) continue;
        auto& camera = std::get<scene::CameraData>(part.node.data);
        const glm::dmat4& world =
            placed->world[static_cast<std::size_t>(placed->scene->find_node(part.node.id))];
        const Ray ray{glm::dvec3(world * glm::dvec4(camera.eye, 1)),
                      glm::dvec3(world * glm::dvec4(camera.focus - camera.eye, 0))};
        const double length = glm::length(ray.direction);
        if (!(length > 0)) continue;
        double at = first_surface(ray, close / length, shown);
        if (at == kNothing)
            at = glm::dot(shown.bounds.center() - ray.origin, ray.direction) / (length * length);
        if (at * length > close && at < kNothing)
            camera.focus = camera.eye + at * (camera.focus - camera.eye);
    }
}

}  // namespace vrut::io
