#include "mesh/picking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/ray_space.hpp"

namespace vrut::mesh {

namespace {

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// a + b + c, rounded about once (Knuth's exact sum of two).
double sum(double a, double b, double c) {
    const double ab = a + b;
    const double b_part = ab - a;
    const double lost = (a - (ab - b_part)) + (b - b_part);
    return (ab + c) + lost;
}

glm::dvec3 sum(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return {sum(a.x, b.x, c.x), sum(a.y, b.y, c.y), sum(a.z, b.z, c.z)};
}

/// The box's centre along the axes where each of its points minus that is exact (Sterbenz), else 0.
glm::dvec3 exact_origin(const math::Bounds& box) {
    glm::dvec3 origin(0);
    for (int axis = 0; axis < 3; ++axis) {
        const double near = std::min(std::abs(box.min[axis]), std::abs(box.max[axis]));
        const double far = std::max(std::abs(box.min[axis]), std::abs(box.max[axis]));
        if (box.min[axis] * box.max[axis] > 0 && far <= 2 * near) origin[axis] = box.center()[axis];
    }
    return origin;
}

/// A geometry as the ray's origin sees it. Its triangles are brought to the ray, not the ray to them: that
/// needs no inverse, which a flattened part has not, and keeps lengths in the scene's unit. The world's axes
/// are kept, but all is relative to the ray's origin, so that what is far from the world's origin, or from
/// the geometry's, cancels before it is rounded.
struct InstanceAtRay {
    InstanceAtRay(const scene::Geometry& part_geometry, const glm::dmat4& world, const glm::dvec3& eye)
        : geometry(part_geometry),
          axes(world),
          origin(exact_origin(geometry.bounds)),
          place(sum(axes * origin, glm::dvec3(world[3]), -eye)) {}

    glm::dvec3 seen(const glm::dvec3& position) const { return axes * (position - origin) + place; }

    const scene::Geometry& geometry;
    glm::dmat3 axes;           ///< world from node
    glm::dvec3 origin, place;  ///< a point of the node's space, and where it is seen
};

/// A lower bound of the distance at which the ray enters the part's box; none where it passes the box by, or
/// where the part lies too far away to be drawn. The box stays a box along the node's axes, flat or not: it
/// is passed by where a direction at right angles to the ray and to one of the edges parts the two. The
/// tolerance is far above the rounding, so that the triangles decide at the box's very edge.
std::optional<double> box_entry(const InstanceAtRay& part, const glm::dvec3& direction) {
    constexpr double kTolerance = 1e-12;
    const math::Bounds& box = part.geometry.bounds;
    const glm::dvec3 box_center = box.center();
    const glm::dvec3 half = glm::max(box.max - box_center, box_center - box.min);
    const glm::dvec3 center = part.seen(box_center);
    const glm::dmat3 edges(part.axes[0] * half.x, part.axes[1] * half.y, part.axes[2] * half.z);
    const auto reach = [&](const glm::dvec3& axis) {
        return std::abs(glm::dot(edges[0], axis)) + std::abs(glm::dot(edges[1], axis)) +
               std::abs(glm::dot(edges[2], axis));
    };
    const glm::dvec3 extent = glm::abs(edges[0]) + glm::abs(edges[1]) + glm::abs(edges[2]);
    if (!(glm::length(center - extent) < scene::kMaxDrawDistance &&
          glm::length(center + extent) < scene::kMaxDrawDistance))
        return {};

    const double tolerance = kTolerance * (glm::length(center) + glm::length(extent));
    const double middle = glm::dot(center, direction);
    const double depth = reach(direction) + tolerance;
    if (middle + depth < 0) return {};
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 axis = glm::cross(direction, edges[i]);
        if (std::abs(glm::dot(center, axis)) > reach(axis) + tolerance * glm::length(edges[i])) return {};
    }
    return middle - depth;
}

/// Unit, by the world's axes; zero for a triangle without area.
glm::dvec3 face_normal(const InstanceAtRay& part, const glm::uvec3& triangle) {
    const auto& positions = part.geometry.positions;
    // About 1 long, so that squares of small parts do not vanish.
    const auto side = [&](unsigned corner) {
        const glm::dvec3 v = part.axes * (positions[corner] - positions[triangle.x]);
        const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        return largest > 0 ? v / largest : glm::dvec3(0);
    };
    const glm::dvec3 cross = glm::cross(side(triangle.y), side(triangle.z));
    const double length = glm::length(cross);
    return length > 0 ? cross / length : glm::dvec3(0);
}

struct Windings {
    bool clockwise = false, counter_clockwise = false;  ///< in the ray's space
};

/// The sides that are drawn.
Windings drawn_windings(const InstanceAtRay& part, const scene::Material& material) {
    const double determinant = scene::relative_determinant(part.axes);
    const bool singular = !(std::abs(determinant) > 1e-12);
    const bool both = singular || material.two_sided;
    return {both || determinant > 0, both || determinant < 0};
}

/// The triangle that is met first, and before `hit.distance`; `hit.node` and `hit.point` are left alone.
/// `corners` is memory that is used again.
bool intersect_triangles(const InstanceAtRay& part, const math::RaySpace& space, const Windings& faces,
                         std::vector<glm::dvec3>& corners, Hit& hit) {
    corners.clear();
    for (const glm::dvec3& position : part.geometry.positions)
        corners.push_back(space.to_ray_space(part.seen(position)));

    bool met = false;
    for (const glm::uvec3& triangle : part.geometry.triangles) {
        const glm::dvec3 &a = corners[triangle.x], &b = corners[triangle.y], &c = corners[triangle.z];
        const double u = math::edge_function(c, b), v = math::edge_function(a, c),
                     w = math::edge_function(b, a);
        // Asked for what is hit, not for what is missed: a number that is not finite misses.
        const bool clockwise = u >= 0 && v >= 0 && w >= 0;
        const bool counter_clockwise = u <= 0 && v <= 0 && w <= 0;
        if (!(clockwise && faces.clockwise) && !(counter_clockwise && faces.counter_clockwise)) continue;
        const double area = u + v + w;
        if (area == 0) continue;
        const double distance = a.z + (v * (b.z - a.z) + w * (c.z - a.z)) / area;
        if (!(distance > 0 && distance < hit.distance)) continue;
        const glm::dvec3 normal = face_normal(part, triangle);
        if (normal == glm::dvec3(0)) continue;
        hit.distance = distance;
        hit.normal = normal;
        met = true;
    }
    return met;
}

}  // namespace

std::optional<Hit> pick(const scene::PlacedScene& placed, const Ray& ray, bool through_transparent) {
    if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == glm::dvec3(0)) return {};
    const std::vector<bool> shown = scene::shown_nodes(placed, ray.origin);
    const auto& nodes = placed.scene->nodes();
    const math::RaySpace space(ray.direction);
    std::vector<glm::dvec3> corners;
    Hit best;
    best.distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto* data = std::get_if<scene::GeometryData>(&nodes[i].data);
        if (!shown[i] || !data || data->geometry == scene::kNone || !scene::is_finite(placed.world[i]))
            continue;
        const scene::Geometry& geometry =
            placed.scene->geometries()[static_cast<std::size_t>(data->geometry)];
        const scene::Material& material = placed.scene->material(placed.nodes[i].material);
        if (geometry.triangles.empty() || geometry.bounds.empty()) continue;
        if (through_transparent && placed.scene->is_transparent(material)) continue;

        const InstanceAtRay part(geometry, placed.world[i], ray.origin);
        const std::optional<double> from = box_entry(part, ray.direction);
        if (!from || *from > best.distance) continue;
        // A tie is met too where the id is higher.
        const bool wins_ties =
            best.node != scene::kNone && nodes[i].id > nodes[static_cast<std::size_t>(best.node)].id;
        Hit hit = best;
        if (wins_ties) hit.distance = std::nextafter(best.distance, std::numeric_limits<double>::infinity());
        if (!intersect_triangles(part, space, drawn_windings(part, material), corners, hit)) continue;
        hit.node = static_cast<scene::Index>(i);
        best = hit;
    }
    if (best.node == scene::kNone) return {};
    best.point = ray.origin + ray.direction * best.distance;
    if (glm::dot(best.normal, ray.direction) > 0) best.normal = -best.normal;
    return best;
}

}  // namespace vrut::mesh
