#include "reference/traced_scene.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "math/ray_space.hpp"
#include "mesh/watertight.hpp"

namespace vrut::reference {

namespace {

/// Normals go by the cofactor matrix · sign(det) (eq. 6.3 without its inverse), to a scale that keeps parts
/// of any size within the range of double.
glm::dmat3 normal_matrix(glm::dmat3 m, double determinant) {
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(m[i][k]));
    if (largest > 0) m /= largest;
    return glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])) *
           (determinant < 0 ? -1.0 : 1.0);
}

/// The node's matrix for positions less `center`, with the eye as its origin: what is far from the world's
/// origin cancels before it is rounded.
glm::dmat4 eye_from_centered(const glm::dmat4& world, const glm::dvec3& center, const glm::dvec3& eye) {
    glm::dmat4 matrix(world);
    matrix[3] = glm::dvec4((glm::dmat3(world) * center + glm::dvec3(world[3])) - eye, 1);
    return matrix;
}

/// None where the node draws nothing.
std::optional<TracedInstance> instance_of(const plan::View& view, std::size_t node) {
    const scene::PlacedScene& placed = *view.scene;
    const scene::Scene& scene = *placed.scene;
    const auto* data = std::get_if<scene::GeometryData>(&scene.nodes()[node].data);
    if (!data || data->geometry == scene::kNone || !scene::is_finite(placed.world[node])) return {};
    const scene::Geometry& geometry = scene.geometries()[static_cast<std::size_t>(data->geometry)];
    if (geometry.triangles.empty()) return {};
    const glm::dvec3 center = geometry.bounds.center();
    const glm::dmat4 matrix = eye_from_centered(placed.world[node], center, view.camera.eye);
    const math::Bounds box =
        math::transformed(matrix, math::Bounds{geometry.bounds.min - center, geometry.bounds.max - center});
    if (!(glm::length(box.min) < scene::kMaxDrawDistance && glm::length(box.max) < scene::kMaxDrawDistance))
        return {};

    TracedInstance part;
    part.node = static_cast<scene::Index>(node);
    part.geometry = &geometry;
    part.positions.reserve(geometry.positions.size());
    for (const glm::dvec3& position : geometry.positions)
        part.positions.emplace_back(matrix * glm::dvec4(position - center, 1));
    const double determinant = scene::relative_determinant(glm::dmat3(matrix));
    part.normal_matrix = normal_matrix(glm::dmat3(matrix), determinant);

    const scene::Material& material = scene.material(placed.nodes[node].material);
    const scene::Material* const override_material = plan::style_of(view).override_material;
    part.material = override_material ? override_material : &material;
    part.transparent = !override_material && scene.is_transparent(material, data->geometry);
    part.clipped = !scene.is_presentation(part.node);
    part.colored = !override_material && !geometry.colors.empty();
    if (!override_material && scene.is_mirror(material, data->geometry)) {
        const math::Plane& plane = *scene.plane(data->geometry);
        part.mirror = math::transformed(matrix, math::Plane{plane.normal, plane.point - center});
    }
    part.flattened = !(std::abs(determinant) > 1e-12);
    part.two_sided = part.flattened || material.two_sided || part.mirror;
    part.clockwise = part.two_sided || determinant > 0;
    part.counter_clockwise = part.two_sided || determinant < 0;
    return part;
}

void number_coincident(std::vector<TracedInstance>& parts, const scene::PlacedScene& placed) {
    std::multimap<const scene::Geometry*, std::uint32_t> firsts;
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
        const auto world = [&](std::uint32_t part) {
            return placed.world[static_cast<std::size_t>(parts[part].node)];
        };
        const auto [begin, end] = firsts.equal_range(parts[i].geometry);
        const auto first =
            std::find_if(begin, end, [&](const auto& other) { return world(other.second) == world(i); });
        parts[i].coincident_group = first == end ? i : first->second;
        if (first == end) firsts.emplace(parts[i].geometry, i);
    }
}

std::vector<scene::ClipPlane> relative_to_eye(std::vector<scene::ClipPlane> planes, const glm::dvec3& eye) {
    for (scene::ClipPlane& plane : planes) plane.distance -= glm::dot(plane.normal, eye);
    return planes;
}

bool cuts(const scene::ClipPlane& plane, const TracedInstance& part) {
    const auto is_beyond = [&](const glm::dvec3& position) {
        return glm::dot(plane.normal, position) > plane.distance;
    };
    const auto beyond = std::ranges::count_if(part.positions, is_beyond);
    return beyond > 0 && static_cast<std::size_t>(beyond) < part.positions.size();
}

/// Those that a plane cuts are capped, if they are watertight and not flattened; or open.
void find_capped(std::vector<TracedInstance>& parts, const plan::View& view,
                 const std::vector<scene::ClipPlane>& planes) {
    const std::atomic<bool> go_on{false};
    const scene::Material* const override_material = plan::style_of(view).override_material;
    std::map<const scene::Geometry*, bool> watertight;
    for (TracedInstance& part : parts) {
        const auto is_cut = [&](const scene::ClipPlane& plane) { return cuts(plane, part); };
        if (part.flattened || !part.clipped || std::ranges::none_of(planes, is_cut)) continue;
        const auto [known, is_new] = watertight.emplace(part.geometry, false);
        if (is_new) known->second = mesh::is_watertight(*part.geometry, go_on);
        if (known->second)
            part.cap_material = override_material ? *override_material : scene::cap_material(*part.material);
        const auto is_open = [&](const scene::ClipPlane& plane) {
            return cuts(plane, part) && !(plane.caps && part.cap_material);
        };
        if (std::ranges::any_of(planes, is_open))
            part.two_sided = part.clockwise = part.counter_clockwise = true;
    }
}

std::vector<TracedInstance> parts_of(const plan::View& view, const std::vector<scene::ClipPlane>& planes) {
    std::vector<TracedInstance> parts;
    const scene::Style style = plan::style_of(view);
    if (!view.scene || !style.faces) return parts;
    const auto& nodes = view.scene->scene->nodes();
    const std::vector<bool> shown = scene::shown_nodes(*view.scene, view.camera.eye);
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (shown[i] &&
            (style.presentation || !view.scene->scene->is_presentation(static_cast<scene::Index>(i))))
            if (auto part = instance_of(view, i)) parts.push_back(*std::move(part));
    const auto id = [&](const TracedInstance& part) { return nodes[static_cast<std::size_t>(part.node)].id; };
    std::sort(parts.begin(), parts.end(),
              [&](const TracedInstance& a, const TracedInstance& b) { return id(a) < id(b); });
    number_coincident(parts, *view.scene);
    find_capped(parts, view, planes);
    return parts;
}

/// A part of a coordinate, far above what the test of a triangle rounds off.
constexpr double kSlack = 1e-14;

double largest_of(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

mesh::SlabRay slab_ray(const RayDifferential& ray) {
    return {ray.origin, ray.direction, glm::dvec3(kSlack * largest_of(ray.origin))};
}

std::vector<mesh::Bvh<double>::Box> boxes_of(const std::vector<TracedInstance>& parts,
                                             const auto& triangles) {
    std::vector<mesh::Bvh<double>::Box> boxes;
    boxes.reserve(triangles.size());
    for (const auto& triangle : triangles) {
        const TracedInstance& part = parts[triangle.part];
        math::Bounds box;
        for (int k = 0; k < 3; ++k) box.add(part.positions[part.geometry->triangles[triangle.index][k]]);
        const double slack = kSlack * std::max(largest_of(box.min), largest_of(box.max));
        boxes.push_back({box.min - slack, box.max + slack});
    }
    return boxes;
}

auto triangles_of(const std::vector<TracedInstance>& parts, const auto& contains, auto triangles) {
    for (std::uint32_t i = 0; i < parts.size(); ++i)
        for (std::uint32_t k = 0; contains(parts[i]) && k < parts[i].geometry->triangles.size(); ++k)
            triangles.push_back({i, k});
    return triangles;
}

struct Crossing {
    TriangleHit hit;  ///< with the part left to be filled in
    bool clockwise = false;
};

/// `clockwise` and `counter_clockwise`: which triangles are met.
std::optional<Crossing> cross(const TracedInstance& part, std::uint32_t triangle, const math::RaySpace& space,
                              const glm::dvec3& origin, bool clockwise, bool counter_clockwise) {
    const glm::uvec3& corners = part.geometry->triangles[triangle];
    const glm::dvec3 a = space.to_ray_space(part.positions[corners.x] - origin);
    const glm::dvec3 b = space.to_ray_space(part.positions[corners.y] - origin);
    const glm::dvec3 c = space.to_ray_space(part.positions[corners.z] - origin);
    const double u = math::edge_function(c, b), v = math::edge_function(a, c), w = math::edge_function(b, a);
    const double u_side = math::edge_side(u, c, b), v_side = math::edge_side(v, a, c),
                 w_side = math::edge_side(w, b, a);
    const bool is_clockwise = u_side > 0 && v_side > 0 && w_side > 0;
    const bool is_counter_clockwise = u_side < 0 && v_side < 0 && w_side < 0;
    if (!(is_clockwise && clockwise) && !(is_counter_clockwise && counter_clockwise)) return {};
    const double area = u + v + w;
    if (area == 0) return {};
    const double distance = a.z + (v * (b.z - a.z) + w * (c.z - a.z)) / area;
    if (!(distance > 0)) return {};
    return Crossing{{0, triangle, distance, glm::dvec3(u, v, w) / area}, is_clockwise};
}

/// A hit in the kept interval, if the part is clipped, with the part left to be filled in.
std::optional<TriangleHit> intersect(const TracedInstance& part, std::uint32_t triangle,
                                     const math::RaySpace& space, const glm::dvec3& origin,
                                     const scene::KeptInterval& kept) {
    const auto crossing = cross(part, triangle, space, origin, part.clockwise, part.counter_clockwise);
    if (crossing && !part.clipped) return crossing->hit;
    if (!crossing || crossing->hit.distance < kept.first || crossing->hit.distance > kept.last) return {};
    return crossing->hit;
}

bool is_opaque(const TracedInstance& part) { return !part.transparent; }
bool is_transparent(const TracedInstance& part) { return part.transparent; }
bool is_capped(const TracedInstance& part) { return part.cap_material.has_value(); }

}  // namespace

bool TriangleHit::is_in_front_of(const TriangleHit& other) const {
    const bool is_cap = cap.has_value(), other_is_cap = other.cap.has_value();
    return std::tie(distance, other.part, other_is_cap, other.triangle) <
           std::tie(other.distance, part, is_cap, triangle);
}

const scene::Material& material_at(const TracedInstance& part, const TriangleHit& hit) {
    return hit.cap ? *part.cap_material : *part.material;
}

TracedScene::TriangleSet::TriangleSet(const std::vector<TracedInstance>& parts,
                                      bool (*contains)(const TracedInstance&))
    : triangles(triangles_of(parts, contains, std::vector<TriangleRef>())),
      tree(boxes_of(parts, triangles)) {}

TracedScene::TracedScene(const plan::View& view)
    : clip_planes_(relative_to_eye(view.clip_planes, view.camera.eye)),
      parts_(parts_of(view, clip_planes_)),
      opaque_(parts_, is_opaque),
      transparent_(parts_, is_transparent),
      capped_(parts_, is_capped) {}

scene::KeptInterval TracedScene::kept_of(const RayDifferential& ray) const {
    constexpr scene::KeptInterval kNothing{1, 0, {}};
    return scene::kept_interval(clip_planes_, ray.origin, ray.direction).value_or(kNothing);
}

std::optional<TriangleHit> TracedScene::cap_hit(const RayDifferential& ray,
                                                const scene::KeptInterval& kept) const {
    if (!kept.cap || !clip_planes_[*kept.cap].caps) return {};
    const math::RaySpace space(ray.direction);
    std::map<std::uint32_t, int> windings;  // of the parts, where the ray comes through the plane
    const mesh::SlabRay slabs = slab_ray(ray);
    const auto entry = [&](const auto& box) { return slabs.entry(box); };
    capped_.tree.visit(entry, std::numeric_limits<double>::infinity(), [&](std::uint32_t number) {
        const auto& [part, index] = capped_.triangles[number];
        const auto crossing = cross(parts_[part], index, space, ray.origin, true, true);
        if (crossing && crossing->hit.distance > kept.first) windings[part] += crossing->clockwise ? 1 : -1;
    });
    const auto is_outside = [](const auto& winding) { return winding.second == 0; };
    const auto last = std::find_if_not(windings.rbegin(), windings.rend(), is_outside);
    if (last == windings.rend()) return {};
    return TriangleHit{
        last->first, 0, kept.first, {}, TriangleHit::Cap{*kept.cap, clip_planes_[*kept.cap].normal}};
}

std::optional<TriangleHit> TracedScene::closest_opaque_hit(const RayDifferential& ray,
                                                           std::uint32_t excluded) const {
    const scene::KeptInterval kept = kept_of(ray);
    const math::RaySpace space(ray.direction);
    TriangleHit first;
    first.distance = std::numeric_limits<double>::infinity();
    if (const auto cap = cap_hit(ray, kept)) first = *cap;
    const mesh::SlabRay slabs = slab_ray(ray);
    const auto entry = [&](const auto& box) { return slabs.entry(box); };
    opaque_.tree.visit(entry, first.distance, [&](std::uint32_t number) {
        const TriangleRef& triangle = opaque_.triangles[number];
        if (is_coincident(triangle.part, excluded)) return;
        auto hit = intersect(parts_[triangle.part], triangle.index, space, ray.origin, kept);
        if (!hit) return;
        hit->part = triangle.part;
        if (hit->is_in_front_of(first)) first = *hit;
    });
    if (!std::isfinite(first.distance)) return {};
    return first;
}

std::vector<TriangleHit> TracedScene::transparent_hits_before(const RayDifferential& ray,
                                                              const std::optional<TriangleHit>& end,
                                                              std::uint32_t excluded) const {
    std::vector<TriangleHit> hits;
    const scene::KeptInterval kept = kept_of(ray);
    const math::RaySpace space(ray.direction);
    const double farthest = end ? end->distance : std::numeric_limits<double>::infinity();
    const mesh::SlabRay slabs = slab_ray(ray);
    const auto entry = [&](const auto& box) { return slabs.entry(box); };
    transparent_.tree.visit(entry, farthest, [&](std::uint32_t number) {
        const TriangleRef& triangle = transparent_.triangles[number];
        if (is_coincident(triangle.part, excluded)) return;
        auto hit = intersect(parts_[triangle.part], triangle.index, space, ray.origin, kept);
        if (!hit) return;
        hit->part = triangle.part;
        if (!end || hit->is_in_front_of(*end)) hits.push_back(*hit);
    });
    std::sort(hits.begin(), hits.end(),
              [](const TriangleHit& a, const TriangleHit& b) { return a.is_in_front_of(b); });
    return hits;
}

}  // namespace vrut::reference
