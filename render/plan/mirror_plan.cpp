#include "plan/mirror_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/frustum.hpp"
#include "plan/transparency_plan.hpp"

namespace vrut::plan {

namespace {

/// In pixels. A smaller mirror is seen edge-on or from far away; whether it covers a pixel centre depends on
/// rounding.
constexpr double kSmallestArea = 1.0 / 256;

/// Part of a part's radius; of one in double-single positions, part of the distance from the eye, if that is
/// less. Positions are wrong by less; where a part stands on a mirror, so much of it is not reflected.
constexpr double kClipMargin = 5e-7;

/// Of homogeneous points, at whose corners a plane's product is positive inside.
using Polygon = std::vector<glm::dvec4>;

Polygon cut(const Polygon& polygon, const glm::dvec4& inside) {
    Polygon rest;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec4 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double at_a = glm::dot(inside, a), at_b = glm::dot(inside, b);
        if (at_a >= 0) rest.push_back(a);
        if ((at_a >= 0) != (at_b >= 0)) rest.push_back(glm::mix(a, b, at_a / (at_a - at_b)));
    }
    return rest;
}

/// The part of a geometry's plane that lies in its bounds.
Polygon slice(const math::Plane& plane, const math::Bounds& bounds) {
    const double radius = bounds.radius();
    const glm::dvec3& n = plane.normal;
    const glm::dvec3 u =
        glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 v = glm::cross(n, u);
    const glm::dvec3 center = bounds.center() - n * plane.distance(bounds.center());
    Polygon polygon;
    for (const glm::dvec2& corner : {glm::dvec2(1, 1), {-1, 1}, {-1, -1}, {1, -1}})
        polygon.emplace_back(center + (u * corner.x + v * corner.y) * radius, 1);
    const glm::dvec3 low = bounds.min - 1e-4 * radius, high = bounds.max + 1e-4 * radius;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec4 inside(0);
        inside[axis] = 1;
        inside.w = -low[axis];
        polygon = cut(polygon, inside);
        inside[axis] = -1;
        inside.w = high[axis];
        polygon = cut(polygon, inside);
    }
    return polygon;
}

/// Pixels of the image, and of half a pixel around it, that a polygon of clip space covers.
double covered_area(Polygon polygon, const glm::dvec2& viewport) {
    const glm::dvec2 edge = 1.0 + 1.0 / viewport;
    for (const glm::dvec4& inside : {glm::dvec4(0, 0, -1, 1),
                                     {1, 0, 0, edge.x},
                                     {-1, 0, 0, edge.x},
                                     {0, 1, 0, edge.y},
                                     {0, -1, 0, edge.y}})
        polygon = cut(polygon, inside);
    double doubled = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec4 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const glm::dvec2 p = glm::dvec2(a) / a.w * viewport / 2.0, q = glm::dvec2(b) / b.w * viewport / 2.0;
        doubled += p.x * q.y - p.y * q.x;
    }
    return std::abs(doubled) / 2;
}

const scene::Geometry& geometry_of(const scene::Scene& scene, const DrawItem& item) {
    return scene.geometries()[static_cast<std::size_t>(item.geometry)];
}

struct MirrorCandidate {
    std::size_t index = 0;  ///< among the opaque
    math::Plane plane;      ///< whose normal is on the viewer's side
    double area = 0;
};

std::vector<MirrorCandidate> candidates(std::span<const DrawItem> opaque, const scene::Scene& scene,
                                        const glm::dmat4& clip_from_view, const glm::dvec2& viewport) {
    std::vector<MirrorCandidate> found;
    for (std::size_t i = 0; i < opaque.size(); ++i) {
        const DrawItem& item = opaque[i];
        auto plane = mirror_plane(scene, item);
        if (!plane) continue;
        if (plane->distance(glm::dvec3(0)) < 0) plane->normal = -plane->normal;
        Polygon polygon = slice(*scene.plane(item.geometry), geometry_of(scene, item).bounds);
        const glm::dmat4 clip_from_node = clip_from_view * item.view_from_node;
        for (glm::dvec4& point : polygon) point = clip_from_node * point;
        const double area = covered_area(std::move(polygon), viewport);
        if (area >= kSmallestArea) found.push_back({i, *plane, area});
    }
    return found;
}

void keep_largest(std::vector<MirrorCandidate>& mirrors) {
    if (mirrors.size() <= kMaxMirrors) return;
    std::stable_sort(mirrors.begin(), mirrors.end(),
                     [](const MirrorCandidate& a, const MirrorCandidate& b) { return a.area > b.area; });
    mirrors.resize(kMaxMirrors);
    std::sort(mirrors.begin(), mirrors.end(),
              [](const MirrorCandidate& a, const MirrorCandidate& b) { return a.index < b.index; });
}

/// A pixel more on all sides: samples lie beside the pixels' centres.
math::PixelBox box_of(const DrawItem& item, const scene::Scene& scene, const glm::dmat4& clip_from_view,
                      const glm::ivec2& viewport) {
    const math::PixelBox box =
        math::pixel_box(geometry_of(scene, item).bounds, clip_from_view * item.view_from_node, viewport);
    return math::intersection({box.low - 1, box.high + 1}, {{0, 0}, viewport});
}

bool are_coincident(const DrawItem& a, const DrawItem& b) {
    return a.geometry == b.geometry && a.view_from_node == b.view_from_node;
}

/// From the eye, of the box around an item.
double farthest_distance(const DrawItem& item, const scene::Scene& scene) {
    double farthest = 0;
    for (const glm::dvec3& corner : math::corners(geometry_of(scene, item).bounds))
        farthest = std::max(farthest, glm::length(glm::dvec3(item.view_from_node * glm::dvec4(corner, 1))));
    return farthest;
}

/// `item` as the mirror shows it; none where all of it lies behind the mirror, or in its plane.
std::optional<DrawItem> reflected(const DrawItem& item, const scene::Scene& scene, const math::Plane& plane,
                                  const MirrorItem& mirror) {
    const math::Bounds& bounds = geometry_of(scene, item).bounds;
    const glm::dmat4& matrix = item.view_from_node;
    // Distances from the plane, of points of the node's space.
    glm::dvec4 distance = glm::dvec4(plane.normal, -glm::dot(plane.normal, plane.point)) * matrix;
    const glm::dvec3 half = bounds.half_extent();
    double rounded = glm::length(transformed(matrix, bounds).half_extent());
    if (scene.needs_double_single(item.geometry))
        rounded = std::min(rounded, farthest_distance(mirror.surface, scene));
    const double margin = kClipMargin * rounded;
    const double middle = glm::dot(distance, glm::dvec4(bounds.center(), 1));
    const double reach = glm::dot(glm::abs(glm::dvec3(distance)), half);
    if (!(middle + reach > margin)) return {};
    DrawItem image = item;
    image.view_from_node = mirror.reflection * matrix;
    image.mirrored = !item.mirrored;
    image.cut_plane = item.cut_plane * mirror.reflection;
    if (middle - reach < margin) {
        distance.w -= margin;
        image.clip_planes.push_back(distance);
    }
    return image;
}

std::vector<DrawItem> reflected_items(const MirrorItem& mirror, const math::Plane& plane,
                                      std::span<const DrawItem> shown, const View& view) {
    const glm::dvec2 scale = 2.0 / glm::dvec2(view.width, view.height);
    const math::NdcRect area{glm::dvec2(mirror.box.low) * scale - 1.0,
                             glm::dvec2(mirror.box.high) * scale - 1.0};
    const math::Frustum frustum = math::frustum_of(math::cropped(projection_of(view), area));
    const scene::Scene& scene = *view.scene->scene;
    std::vector<DrawItem> items;
    for (const DrawItem& item : shown) {
        if (are_coincident(item, mirror.surface)) continue;
        const auto image = reflected(item, scene, plane, mirror);
        if (image && !math::is_outside(frustum, image->view_from_node, geometry_of(scene, item).bounds))
            items.push_back(*image);
    }
    return items;
}

}  // namespace

std::optional<math::Plane> mirror_plane(const scene::Scene& scene, const DrawItem& item) {
    if (item.cut || !scene.is_mirror(scene.material(item.material), item.geometry)) return {};
    return transformed(item.view_from_node, *scene.plane(item.geometry));
}

std::vector<MirrorItem> extract_mirrors(std::vector<DrawItem>& opaque, std::span<const DrawItem> shown,
                                        const View& view) {
    const scene::Scene& scene = *view.scene->scene;
    const glm::ivec2 viewport(view.width, view.height);
    const glm::dmat4 clip_from_view = math::reversed_clip_from_view(projection_of(view), near_distance(view));
    std::vector<MirrorCandidate> chosen = candidates(opaque, scene, clip_from_view, viewport);
    if (chosen.empty()) return {};
    keep_largest(chosen);
    std::vector<DrawItem> surfaces;
    surfaces.reserve(chosen.size());
    for (const MirrorCandidate& candidate : chosen) surfaces.push_back(opaque[candidate.index]);
    mark_occluded_by_coincident(surfaces, opaque, scene);
    std::vector<MirrorItem> mirrors;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const math::Plane& plane = chosen[i].plane;
        MirrorItem& mirror = mirrors.emplace_back();
        mirror.surface = surfaces[i];
        mirror.reflection = math::reflection_about(plane);
        mirror.box = box_of(mirror.surface, scene, clip_from_view, viewport);
        mirror.reflected.opaque = reflected_items(mirror, plane, shown, view);
    }
    for (auto it = chosen.rbegin(); it != chosen.rend(); ++it)
        opaque.erase(opaque.begin() + static_cast<std::ptrdiff_t>(it->index));
    return mirrors;
}

}  // namespace vrut::plan
