#include "plan/transparency_plan.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

#include "plan/strong_components.hpp"

namespace vrut::plan {

namespace {

constexpr double kVisibleDifference = 1.0 / 255;

/// Between which colours a material can be seen under a light, whatever its normals.
struct ColorRange {
    glm::dvec3 low{0}, high{1};
    double alpha = 1;
};

ColorRange color_range(const scene::Material& material, const scene::Light& light) {
    if (material.reflectivity > 0) return {glm::dvec3(0), glm::dvec3(1), material.diffuse.a};
    const glm::dvec3 diffuse =
        material.texture == scene::kNone ? glm::dvec3(material.diffuse) : glm::dvec3(1);
    const double brightest = light.attenuation == glm::dvec3(0) ? 1 : 1 / std::max(light.attenuation.x, 1e-6);
    const glm::dvec3 unlit = glm::dvec3(material.emission) + glm::dvec3(material.ambient);
    const glm::dvec3 lit = (diffuse + glm::dvec3(material.specular)) * glm::dvec3(light.color) * brightest;
    return {glm::clamp(unlit, 0.0, 1.0), glm::clamp(unlit + lit, 0.0, 1.0), material.diffuse.a};
}

/// How much a colour can change where two surfaces are drawn in the wrong order: a₁ a₂ |c₁ - c₂|.
double wrong_order_error(const ColorRange& a, const ColorRange& b) {
    const glm::dvec3 most = glm::max(glm::abs(a.high - b.low), glm::abs(b.high - a.low));
    return a.alpha * b.alpha * std::max({most.x, most.y, most.z});
}

/// An item as the order sees it: in view space, the eye at the origin, looking along -z.
struct TransparentItem {
    OrientedBox box;
    double radius = 0;
    double nearest = 0, farthest = 0;  ///< its range of z
    glm::dvec2 low{0}, high{0};        ///< around what it can cover, on the plane z = -1
    ColorRange colors;
};

/// A flat box gets a thickness that does not count, so that each of its sides faces somewhere.
void thicken(OrientedBox& box) {
    const double size = glm::length(box.axes[0]) + glm::length(box.axes[1]) + glm::length(box.axes[2]);
    for (std::size_t k = 0; k < 3; ++k) {
        if (glm::length(box.axes[k]) > 1e-9 * size) continue;
        const glm::dvec3 across = glm::cross(box.axes[(k + 1) % 3], box.axes[(k + 2) % 3]);
        if (const double length = glm::length(across); length > 0)
            box.axes[k] = across * (1e-9 * size / length);
    }
}

TransparentItem transparent_item_of(OrientedBox box, const ColorRange& colors) {
    thicken(box);
    constexpr double kEverywhere = std::numeric_limits<double>::infinity();
    TransparentItem result{
        box, 0, -kEverywhere, kEverywhere, glm::dvec2(kEverywhere), glm::dvec2(-kEverywhere), colors};
    for (unsigned corner = 0; corner < 8; ++corner) {
        glm::dvec3 at = box.center;
        for (unsigned k = 0; k < 3; ++k) at += corner >> k & 1 ? box.axes[k] : -box.axes[k];
        result.radius = std::max(result.radius, glm::distance(at, box.center));
        result.nearest = std::max(result.nearest, at.z);
        result.farthest = std::min(result.farthest, at.z);
        result.low = glm::min(result.low, glm::dvec2(at) / -at.z);
        result.high = glm::max(result.high, glm::dvec2(at) / -at.z);
    }
    if (!(result.nearest < 0)) {
        result.low = glm::dvec2(-kEverywhere);
        result.high = glm::dvec2(kEverywhere);
    }
    return result;
}

/// What a plane at right angles to `axis` tells of two boxes whose extents along it are these: it lies
/// between them, and the eye, at 0, is on the side of the one in front.
DepthRelation relation_along_axis(double first, double first_extent, double second, double second_extent) {
    const bool upwards = first < second;
    const double below = upwards ? first + first_extent : second + second_extent;
    const double above = upwards ? second - second_extent : first - first_extent;
    if (below < 0 && above > 0) return DepthRelation::apart;  // the plane holds the eye
    return ((below + above) / 2 > 0) == upwards ? DepthRelation::first_in_front
                                                : DepthRelation::second_in_front;
}

/// Of two boxes by a plane that parts them, for which fifteen directions come into question: those of their
/// axes and at right angles to two of them. Coplanar ones have the second in front.
DepthRelation depth_relation(const OrientedBox& a, const OrientedBox& b, double size) {
    const double tolerance = 1e-6 * size;
    bool coplanar = false;
    DepthRelation result = DepthRelation::unknown;
    const auto try_axis = [&](const glm::dvec3& direction) {
        const double length = glm::length(direction);
        if (!(length > 0)) return false;
        const glm::dvec3 axis = direction / length;
        const double at_a = glm::dot(axis, a.center), at_b = glm::dot(axis, b.center);
        double extent_a = 0, extent_b = 0;
        for (const glm::dvec3& half : a.axes) extent_a += std::abs(glm::dot(axis, half));
        for (const glm::dvec3& half : b.axes) extent_b += std::abs(glm::dot(axis, half));
        const double apart = std::abs(at_a - at_b);
        const bool in_plane = apart + extent_a + extent_b <= tolerance;
        coplanar = coplanar || in_plane;
        if (in_plane || apart - extent_a - extent_b < -tolerance) return false;
        result = relation_along_axis(at_a, extent_a, at_b, extent_b);
        return true;
    };
    const auto facing = [](const OrientedBox& box, std::size_t k) {
        return glm::cross(box.axes[(k + 1) % 3], box.axes[(k + 2) % 3]);
    };
    for (std::size_t k = 0; k < 3; ++k)
        if (try_axis(facing(a, k)) || try_axis(facing(b, k))) return result;
    for (std::size_t k = 0; k < 9; ++k)
        if (try_axis(glm::cross(a.axes[k / 3], b.axes[k % 3]))) return result;
    return coplanar ? DepthRelation::second_in_front : DepthRelation::unknown;
}

/// Which panes lie before which others, as the eye sees them.
class DepthOrderGraph {
public:
    DepthOrderGraph(std::span<const DrawItem> items, const View& view, TransparencyCache& shapes);

    /// False where too many overlap.
    bool compare_all();
    /// Panes by number, in groups that no order parts, from far to near.
    std::vector<std::vector<unsigned>> groups() const { return strong_components(behind_); }
    /// How many lie over each other on average, in the box around all that the picture shows of them.
    double depth() const;
    /// What drawing a group in some order could change.
    double risk(const std::vector<unsigned>& group) const;
    void sort_by_distance(std::vector<unsigned>& group) const;
    /// Says of the item how its triangles are to be drawn; true if it may show itself behind itself in an
    /// order that is not known, and that would be seen.
    bool needs_per_pixel_order(unsigned index, DrawItem& item) const;

private:
    bool are_comparable(std::span<const unsigned> from_left) const;
    DepthRelation compare(unsigned a, unsigned b);
    DepthRelation compare_triangles(unsigned a, unsigned b);
    /// Whether an item lies in one plane, so that no ray meets it twice.
    bool is_flat(unsigned index) const;
    const std::vector<FrontFacingTriangle>& facing(unsigned index);
    /// Of its facing triangles those that may lie before or behind something of the other.
    std::vector<FrontFacingTriangle> covering(unsigned index, const TransparentItem& other);
    const scene::Geometry& geometry(unsigned index) const {
        return scene_.geometries()[static_cast<std::size_t>(items_[index].geometry)];
    }

    std::span<const DrawItem> items_;
    const scene::Scene& scene_;
    TransparencyCache& shapes_;
    glm::dvec2 image_corner_;  ///< the upper right one of the picture, on the plane z = -1
    std::vector<TransparentItem> transparent_items_;
    std::vector<std::vector<unsigned>> behind_;  // for each those that lie behind it, or may
    std::vector<std::optional<std::vector<FrontFacingTriangle>>> facing_;
    std::size_t compared_ = 0;  // pairs of triangles
};

DepthOrderGraph::DepthOrderGraph(std::span<const DrawItem> items, const View& view, TransparencyCache& shapes)
    : items_(items),
      scene_(*view.scene->scene),
      shapes_(shapes),
      image_corner_(std::tan(view.camera.fov * scene::kRadiansPerDegree / 2) *
                    glm::dvec2(static_cast<double>(view.width) / view.height, 1)),
      behind_(items.size()),
      facing_(items.size()) {
    for (const DrawItem& item : items)
        transparent_items_.push_back(
            transparent_item_of(transformed(item.view_from_node, shapes.box(item.geometry)),
                                color_range(scene_.material(item.material), view.light)));
}

const std::vector<FrontFacingTriangle>& DepthOrderGraph::facing(unsigned index) {
    if (!facing_[index]) facing_[index] = front_facing_triangles(items_[index], geometry(index));
    return *facing_[index];
}

/// `a` has the lower id.
DepthRelation DepthOrderGraph::compare(unsigned a, unsigned b) {
    const TransparentItem &first = transparent_items_[a], &second = transparent_items_[b];
    if (items_[a].geometry == items_[b].geometry && items_[a].view_from_node == items_[b].view_from_node) {
        // Only where no triangle lies before another are all their depths equal, and the higher id in front.
        const bool tied = is_flat(a) || compare_triangles(a, b) == DepthRelation::apart;
        return tied ? DepthRelation::second_in_front : DepthRelation::unknown;
    }
    if (first.nearest < second.farthest) return DepthRelation::second_in_front;
    if (second.nearest < first.farthest) return DepthRelation::first_in_front;
    const DepthRelation order = depth_relation(first.box, second.box, first.radius + second.radius);
    return order == DepthRelation::unknown ? compare_triangles(a, b) : order;
}

DepthRelation DepthOrderGraph::compare_triangles(unsigned a, unsigned b) {
    const TransparentItem &first = transparent_items_[a], &second = transparent_items_[b];
    const std::size_t size_a = geometry(a).triangles.size(), size_b = geometry(b).triangles.size();
    if (std::max(size_a, size_b) > kMaxOrderedTriangles) return DepthRelation::unknown;
    // Looking for those that cover each other costs time as well.
    if ((compared_ += size_a + size_b) > 16 * kMaxComparedPairs) return DepthRelation::unknown;
    const auto mine = covering(a, second), others = covering(b, first);
    const std::size_t pairs = mine.size() * others.size();
    if (pairs > kMaxComparedPairs || (compared_ += pairs) > 16 * kMaxComparedPairs)
        return DepthRelation::unknown;
    return depth_relation(mine, others, kNegligible * (first.radius + second.radius));
}

bool DepthOrderGraph::is_flat(unsigned index) const {
    const auto& axes = transparent_items_[index].box.axes;
    const double thickness = std::min({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
    return is_flattened(items_[index].view_from_node) ||
           thickness <= kNegligible * transparent_items_[index].radius;
}

std::vector<FrontFacingTriangle> DepthOrderGraph::covering(unsigned index, const TransparentItem& other) {
    std::vector<FrontFacingTriangle> result;
    for (const FrontFacingTriangle& triangle : facing(index))
        if (triangle.low.x < other.high.x && other.low.x < triangle.high.x && triangle.low.y < other.high.y &&
            other.low.y < triangle.high.y)
            result.push_back(triangle);
    return result;
}

/// Counts pairs that overlap in the width of the screen, which takes far less than to compare them.
bool DepthOrderGraph::are_comparable(std::span<const unsigned> from_left) const {
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < from_left.size() && pairs <= kMaxOverlappingPairs; ++i) {
        const auto rest = from_left.subspan(i + 1);
        const auto end = std::upper_bound(
            rest.begin(), rest.end(), transparent_items_[from_left[i]].high.x,
            [&](double right, unsigned index) { return right < transparent_items_[index].low.x; });
        pairs += static_cast<std::size_t>(end - rest.begin());
    }
    return pairs <= kMaxOverlappingPairs;
}

bool DepthOrderGraph::compare_all() {
    std::vector<unsigned> from_left(transparent_items_.size());
    std::iota(from_left.begin(), from_left.end(), 0U);
    std::sort(from_left.begin(), from_left.end(), [&](unsigned a, unsigned b) {
        return std::tie(transparent_items_[a].low.x, a) < std::tie(transparent_items_[b].low.x, b);
    });
    if (!are_comparable(from_left)) return false;
    for (std::size_t i = 0; i < from_left.size(); ++i) {
        const TransparentItem& left = transparent_items_[from_left[i]];
        for (std::size_t k = i + 1; k < from_left.size(); ++k) {
            const TransparentItem& right = transparent_items_[from_left[k]];
            if (right.low.x > left.high.x) break;
            if (right.low.y > left.high.y || left.low.y > right.high.y) continue;
            const auto [a, b] = std::minmax(from_left[i], from_left[k]);
            const DepthRelation order = compare(a, b);
            if (order == DepthRelation::first_in_front || order == DepthRelation::unknown)
                behind_[a].push_back(b);
            if (order == DepthRelation::second_in_front || order == DepthRelation::unknown)
                behind_[b].push_back(a);
        }
    }
    return true;
}

double DepthOrderGraph::depth() const {
    const auto area = [](const glm::dvec2& low, const glm::dvec2& high) {
        return (high.x - low.x) * (high.y - low.y);
    };
    double sum = 0;
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const TransparentItem& transparent : transparent_items_) {
        const glm::dvec2 item_low = glm::clamp(transparent.low, -image_corner_, image_corner_);
        const glm::dvec2 item_high = glm::clamp(transparent.high, -image_corner_, image_corner_);
        sum += area(item_low, item_high);
        low = glm::min(low, item_low);
        high = glm::max(high, item_high);
    }
    const double all = area(low, high);
    return all > 0 ? sum / all : 0;
}

double DepthOrderGraph::risk(const std::vector<unsigned>& group) const {
    double sum = 0;
    for (const unsigned a : group)
        for (const unsigned b : behind_[a])
            if (std::binary_search(group.begin(), group.end(), b))
                sum += wrong_order_error(transparent_items_[a].colors, transparent_items_[b].colors);
    return sum;
}

void DepthOrderGraph::sort_by_distance(std::vector<unsigned>& group) const {
    const auto distance = [&](unsigned index) { return glm::length(transparent_items_[index].box.center); };
    std::stable_sort(group.begin(), group.end(),
                     [&](unsigned a, unsigned b) { return distance(a) > distance(b); });
}

/// Puts those of `all` that are in `last` behind the others, in the order of `last`.
void put_last(const std::vector<unsigned>& last, std::span<unsigned> all) {
    std::vector<unsigned> sorted = last;
    std::sort(sorted.begin(), sorted.end());
    const auto rest = std::remove_if(all.begin(), all.end(), [&](unsigned number) {
        return std::binary_search(sorted.begin(), sorted.end(), number);
    });
    std::copy(last.begin(), last.end(), rest);
}

bool DepthOrderGraph::needs_per_pixel_order(unsigned index, DrawItem& item) const {
    if (is_flattened(item.view_from_node)) return false;  // all of it in one plane
    const TriangleOrder& known = shapes_.order(item.geometry, item.cull_mode);
    item.order = known.back_to_front;
    const ColorRange& colors = transparent_items_[index].colors;
    if (known.cycles.empty() || wrong_order_error(colors, colors) <= kVisibleDifference) return false;
    std::vector<unsigned> order;
    if (known.back_to_front) {
        order = *known.back_to_front;
    } else {
        order.resize(geometry(index).triangles.size() * (item.cull_mode == CullMode::none ? 2 : 1));
        std::iota(order.begin(), order.end(), 0U);
    }
    for (const std::vector<unsigned>& cycle : known.cycles) {
        const auto facing = back_to_front(front_facing_triangles(item, geometry(index), cycle),
                                          kNegligible * transparent_items_[index].radius);
        if (!facing) return true;
        put_last(*facing, std::span(std::find(order.begin(), order.end(), cycle.front()), cycle.size()));
    }
    item.order = std::make_shared<const std::vector<unsigned>>(std::move(order));
    return false;
}

}  // namespace

std::vector<TransparentGroup> order_transparent(std::span<const DrawItem> items, const View& view,
                                                TransparencyCache& shapes) {
    if (view.methods.transparency == Methods::Transparency::per_pixel_lists)
        return {{{items.begin(), items.end()}, true}};
    DepthOrderGraph graph(items, view, shapes);
    std::vector<std::vector<unsigned>> order;
    const bool ordered = graph.compare_all(),
               sorted = view.methods.transparency == Methods::Transparency::sorted;
    const bool all_exact = !ordered && !sorted && graph.depth() <= kMaxMeanLayers;
    if (ordered) {
        order = graph.groups();
    } else {
        order.emplace_back(items.size());
        std::iota(order[0].begin(), order[0].end(), 0U);
    }
    std::vector<TransparentGroup> groups;
    const auto add = [&](const DrawItem& item, bool exact, bool alone) {
        if (alone || groups.empty() || groups.back().exact != exact) groups.push_back({{}, exact});
        groups.back().items.push_back(item);
    };
    for (std::vector<unsigned>& members : order) {
        const bool exact = all_exact || (ordered && !sorted && members.size() > 1 &&
                                         graph.risk(members) > kVisibleDifference);
        if (!exact) graph.sort_by_distance(members);
        for (const unsigned member : members) {
            DrawItem item = items[member];
            const bool exact_alone = !exact && graph.needs_per_pixel_order(member, item) && !sorted;
            add(item, exact || exact_alone, exact_alone || (exact && member == members.front()));
        }
    }
    return groups;
}

void mark_occluded_by_coincident(std::vector<DrawItem>& items, std::span<const DrawItem> others,
                                 const scene::Scene& scene) {
    // Compared by geometry and matrix: thousands of parts may share a geometry.
    const auto before = [](const DrawItem* a, const DrawItem* b) {
        if (a->geometry != b->geometry) return a->geometry < b->geometry;
        const double *p = glm::value_ptr(a->view_from_node), *q = glm::value_ptr(b->view_from_node);
        return std::lexicographical_compare(p, p + 16, q, q + 16);
    };
    const auto id = [&](const DrawItem& item) {
        return scene.nodes()[static_cast<std::size_t>(item.node)].id;
    };
    std::vector<DrawItem*> sorted_items;
    sorted_items.reserve(items.size());
    for (DrawItem& item : items) sorted_items.push_back(&item);
    std::sort(sorted_items.begin(), sorted_items.end(), before);
    for (const DrawItem& other : others) {
        const auto [first, last] = std::equal_range(sorted_items.begin(), sorted_items.end(), &other, before);
        for (auto match = first; match != last; ++match)
            if (id(other) > id(**match)) (*match)->occluded_by_coincident = true;
    }
}

}  // namespace vrut::plan
