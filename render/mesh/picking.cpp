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

bool is_singular(double relative_determinant) { return !(std::abs(relative_determinant) > 1e-12); }

/// Returns the windings that are drawn.
Windings drawn_windings(const InstanceAtRay& part, bool two_sided) {
    const double determinant = scene::relative_determinant(part.axes);
    const bool both = is_singular(determinant) || two_sided;
    return {both || determinant > 0, both || determinant < 0};
}

/// A triangle in the ray's space, and its edge functions.
struct TriangleAtRay {
    TriangleAtRay(const InstanceAtRay& part, const math::RaySpace& space, std::uint32_t number) {
        const glm::uvec3& triangle = part.geometry.triangles[number];
        const auto corner = [&](unsigned vertex) {
            return space.to_ray_space(part.seen(part.geometry.positions[vertex]));
        };
        a = corner(triangle.x);
        b = corner(triangle.y);
        c = corner(triangle.z);
        u = math::edge_function(c, b);
        v = math::edge_function(a, c);
        w = math::edge_function(b, a);
    }
    double area() const { return u + v + w; }
    /// Along the ray to the triangle's plane; not finite where the area is 0.
    double distance() const { return a.z + (v * (b.z - a.z) + w * (c.z - a.z)) / area(); }

    glm::dvec3 a{0}, b{0}, c{0};
    double u = 0, v = 0, w = 0;
};

/// The search for the first triangle of a part along a ray.
class TriangleSearch {
public:
    /// Looks for hits from `nearest` on and before `farthest`.
    TriangleSearch(const InstanceAtRay& part, const math::RaySpace& space, const Windings& windings,
                   double nearest, double farthest)
        : part_(part), space_(space), windings_(windings), nearest_(nearest), farthest_(farthest) {}

    /// Of equal distances the lower number is hit, in whatever order they are asked.
    void test(std::uint32_t number) {
        const TriangleAtRay seen(part_, space_, number);
        // Asked for what is hit, not for what is missed: a number that is not finite misses.
        const bool clockwise = seen.u >= 0 && seen.v >= 0 && seen.w >= 0;
        const bool counter_clockwise = seen.u <= 0 && seen.v <= 0 && seen.w <= 0;
        if (!(clockwise && windings_.clockwise) && !(counter_clockwise && windings_.counter_clockwise))
            return;
        if (seen.area() == 0) return;
        const double distance = seen.distance();
        if (!(distance > 0 && distance >= nearest_)) return;
        if (!(distance < farthest_ || (met_ && distance == farthest_ && number < number_))) return;
        const glm::dvec3 normal = face_normal(part_, part_.geometry.triangles[number]);
        if (normal == glm::dvec3(0)) return;
        farthest_ = distance;
        normal_ = normal;
        number_ = number;
        met_ = true;
    }
    bool met() const { return met_; }
    const double& farthest() const { return farthest_; }
    const glm::dvec3& normal() const { return normal_; }

private:
    const InstanceAtRay& part_;
    const math::RaySpace& space_;
    Windings windings_;
    double nearest_;
    double farthest_;  ///< the distance of the hit, once there is one
    glm::dvec3 normal_{0};
    std::uint32_t number_ = 0;
    bool met_ = false;
};

double sum_of(const glm::dvec3& v) { return v.x + v.y + v.z; }

glm::dmat3 absolute(const glm::dmat3& m) { return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])}; }

/// A ray in the space of a geometry's tree. Its slack covers all that differs between that space and the one
/// in which triangles are asked: no box of a triangle that TriangleSearch would hit is missed.
class RayInTree {
public:
    /// None where the part is flat, or so thin or so far away that the slack would be the whole tree.
    static std::optional<RayInTree> of(const InstanceAtRay& part, const Ray& ray) {
        const double scale = tree_scale(part.geometry);
        const glm::dmat3 axes = part.axes * scale;  // eye = axes * tree + center
        const glm::dvec3 center = part.seen(part.geometry.bounds.center());
        const glm::dmat3 inverse = glm::inverse(axes);
        // |positions - origin| is 4 at most: the box is no further from its exact_origin.
        const glm::dvec3 extent = 4.0 * (absolute(axes) * glm::dvec3(1)) + glm::abs(part.place);
        const double largest = std::max({extent.x, extent.y, extent.z});
        // What the inverse is off by, however it was computed, and what is rounded: of the ray, of the
        // triangles as it sees them, of their shear to its direction.
        const glm::dvec3 off = absolute(inverse * axes - glm::dmat3(1)) * glm::dvec3(1.001);
        const glm::dvec3 slack = off + absolute(inverse) * glm::dvec3(kRounding * largest);
        if (!(std::max({slack.x, slack.y, slack.z}) < 1)) return {};
        return RayInTree(axes, center, inverse, slack, ray.direction, largest);
    }

    /// Of the distances at which the ray may hit the triangles of a box. It is the least of the whole box's,
    /// since the distance of a sliver's hit is as uncertain as its corners are far apart.
    double operator()(const Bvh<float>::Box& box) const {
        if (std::isnan(slabs_.entry(box))) return std::numeric_limits<double>::quiet_NaN();
        const glm::dvec3 a = glm::dvec3(box.min) * depth_, b = glm::dvec3(box.max) * depth_;
        return sum_of(glm::min(a, b)) + nearest_;
    }

private:
    static constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();

    RayInTree(const glm::dmat3& axes, const glm::dvec3& center, const glm::dmat3& inverse,
              const glm::dvec3& slack, const glm::dvec3& direction, double largest)
        : slabs_(inverse * -center, inverse * direction, slack) {
        // RaySpace's distance, which runs along the direction's longest axis.
        const glm::dvec3 size = glm::abs(direction);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        depth_ = glm::dvec3(axes[0][axis], axes[1][axis], axes[2][axis]) / direction[axis];
        nearest_ = center[axis] / direction[axis] - kRounding * largest / size[axis];
    }

    SlabRay slabs_;
    glm::dvec3 depth_{0};  ///< distance along the ray for each of the tree's axes
    double nearest_ = 0;   ///< and at its origin, less the slack
};

/// Calls `test` with each triangle that the ray may meet before `farthest`, which may fall meanwhile.
void search(const InstanceAtRay& part, const Ray& ray, const Bvh<float>* tree, const double& farthest,
            const auto& test) {
    if (tree)
        if (const auto in_tree = RayInTree::of(part, ray)) return tree->visit(*in_tree, farthest, test);
    for (std::uint32_t number = 0; number < part.geometry.triangles.size(); ++number) test(number);
}

/// A node that a ray may hit.
struct PickedNode {
    scene::Index index = scene::kNone;
    scene::Index geometry = scene::kNone;
    bool faces = true;  ///< they can be hit, and not only caps
    bool two_sided = false;
};

/// Looks for the first hit, node by node.
class Picker {
public:
    Picker(const scene::PlacedScene& placed, const Ray& ray, const PickOptions& options,
           const scene::KeptInterval& kept)
        : placed_(placed), ray_(ray), options_(options), kept_(kept), space_(ray.direction) {
        const bool closes = kept.cap && options.clip_planes[*kept.cap].caps && options.is_solid;
        if (closes) cap_normal_ = options.clip_planes[*kept.cap].normal;
    }

    void test(PickedNode node) {
        if (!node.faces && !cap_normal_) return;
        const scene::Geometry& geometry =
            placed_.scene->geometries()[static_cast<std::size_t>(node.geometry)];
        const InstanceAtRay part(geometry, placed_.world[static_cast<std::size_t>(node.index)], ray_.origin);
        const std::optional<double> from = box_entry(part, ray_.direction);
        if (!from || *from > best_.distance) return;
        const Bvh<float>* tree = options_.trees ? options_.trees->of(node.geometry) : nullptr;
        bool capped = false;
        for (std::size_t i = 0; i < options_.clip_planes.size(); ++i) {
            const scene::ClipPlane& plane = options_.clip_planes[i];
            const glm::dmat4& world = placed_.world[static_cast<std::size_t>(node.index)];
            if (!scene::crosses(scene::clip_equation(plane, world), geometry)) continue;
            const bool closed = plane.caps && options_.is_solid && options_.is_solid(node.geometry);
            capped |= closed && kept_.cap == i;
            node.two_sided |= !closed;
        }
        if (capped) test_cap(node, part, tree);
        if (node.faces) test_faces(node, part, tree);
    }

    std::optional<Hit> result() const {
        if (best_.node == scene::kNone) return {};
        Hit hit = best_;
        hit.point = ray_.origin + ray_.direction * hit.distance;
        if (glm::dot(hit.normal, ray_.direction) > 0) hit.normal = -hit.normal;
        return hit;
    }

private:
    /// Hits of the node count before that distance; a tie is met too where the id is higher.
    double farthest(const PickedNode& node) const {
        const auto id = [&](scene::Index at) {
            return placed_.scene->nodes()[static_cast<std::size_t>(at)].id;
        };
        const double farthest = best_.node == scene::kNone ? kept_.last : best_.distance;
        const bool wins_ties = best_.node == scene::kNone || id(node.index) > id(best_.node);
        return wins_ties ? std::nextafter(farthest, std::numeric_limits<double>::infinity()) : farthest;
    }

    void test_faces(const PickedNode& node, const InstanceAtRay& part, const Bvh<float>* tree) {
        TriangleSearch triangles(part, space_, drawn_windings(part, node.two_sided), kept_.first,
                                 farthest(node));
        search(part, ray_, tree, triangles.farthest(), [&](std::uint32_t number) { triangles.test(number); });
        if (triangles.met()) keep(node, triangles.farthest(), triangles.normal());
    }

    void test_cap(const PickedNode& node, const InstanceAtRay& part, const Bvh<float>* tree) {
        if (!(kept_.first < farthest(node)) || is_singular(scene::relative_determinant(part.axes))) return;
        int winding = 0;
        search(part, ray_, tree, std::numeric_limits<double>::infinity(),
               [&](std::uint32_t number) { winding += crossing(TriangleAtRay(part, space_, number)); });
        if (winding != 0) keep(node, kept_.first, *cap_normal_);
    }

    /// 1 or -1, by its winding, for a triangle that the ray crosses beyond the plane. One exactly through an
    /// edge or a corner crosses as many of each winding as one beside it.
    int crossing(const TriangleAtRay& seen) const {
        const double u = math::edge_side(seen.u, seen.c, seen.b), v = math::edge_side(seen.v, seen.a, seen.c),
                     w = math::edge_side(seen.w, seen.b, seen.a);
        const bool clockwise = u > 0 && v > 0 && w > 0, counter_clockwise = u < 0 && v < 0 && w < 0;
        if ((!clockwise && !counter_clockwise) || !(seen.distance() > kept_.first)) return 0;
        return clockwise ? 1 : -1;
    }

    void keep(const PickedNode& node, double distance, const glm::dvec3& normal) {
        best_.node = node.index;
        best_.distance = distance;
        best_.normal = normal;
    }

    const scene::PlacedScene& placed_;
    const Ray& ray_;
    const PickOptions& options_;
    const scene::KeptInterval& kept_;
    const math::RaySpace space_;
    std::optional<glm::dvec3> cap_normal_;  ///< of the plane through which the ray enters, if it has caps
    Hit best_{scene::kNone, glm::dvec3(0), glm::dvec3(0), std::numeric_limits<double>::infinity()};
};

/// None where an image shows nothing of the node, or where picks pass it.
std::optional<PickedNode> picked_node(const scene::PlacedScene& placed, std::size_t at,
                                      const PickOptions& options) {
    const bool uniform = scene::style_of(options.mode, false).override_material;  // no glass, no mirrors
    const auto index = static_cast<scene::Index>(at);
    const auto* data = std::get_if<scene::GeometryData>(&placed.scene->nodes()[at].data);
    if (!data || data->geometry == scene::kNone || !scene::is_finite(placed.world[at])) return {};
    if (placed.scene->is_presentation(index)) return {};
    const scene::Geometry& geometry = placed.scene->geometries()[static_cast<std::size_t>(data->geometry)];
    if (geometry.triangles.empty() || geometry.bounds.empty()) return {};
    const scene::Material& material = placed.scene->material(placed.nodes[at].material);
    const bool passed = options.through_transparent && placed.scene->is_transparent(material, data->geometry);
    const bool invisible = !uniform && material.diffuse.a == 0;
    return PickedNode{index, data->geometry, !passed && !invisible,
                      material.two_sided || (!uniform && placed.scene->is_mirror(material, data->geometry))};
}

}  // namespace

std::optional<Hit> pick(const scene::PlacedScene& placed, const Ray& ray, const PickOptions& options) {
    if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == glm::dvec3(0)) return {};
    const auto kept = scene::kept_interval(options.clip_planes, ray.origin, ray.direction);
    if (!kept) return {};
    const std::vector<bool> shown = scene::shown_nodes(placed, ray.origin);
    Picker picker(placed, ray, options, *kept);
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (shown[i])
            if (const auto node = picked_node(placed, i, options)) picker.test(*node);
    return picker.result();
}

}  // namespace vrut::mesh
