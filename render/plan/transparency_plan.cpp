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

/// The range of colours that an item can have under a light, for all normals; 0 to 1.
struct ColorRange {
    glm::dvec3 low{0}, high{1};
    double alpha = 1;
};

ColorRange color_range(const DrawItem& item, const scene::Material& material, const scene::Light& light) {
    if (material.reflectivity > 0 || item.emissive || item.metallic_roughness)
        return {glm::dvec3(0), glm::dvec3(1), material.diffuse.a};
    const glm::dvec3 diffuse =
        material.texture == scene::kNone ? glm::dvec3(material.diffuse) : glm::dvec3(1);
    const double brightest = light.attenuation == glm::dvec3(0) ? 1 : 1 / std::max(light.attenuation.x, 1e-6);
    const glm::dvec3 unlit = glm::dvec3(material.emission) + glm::dvec3(material.ambient);
    const glm::dvec3 lit = (diffuse + glm::dvec3(material.specular)) * glm::dvec3(light.color) * brightest;
    const glm::dvec3 least = item.colored ? glm::dvec3(material.emission) : unlit;
    return {glm::clamp(least, 0.0, 1.0), glm::clamp(unlit + lit, 0.0, 1.0), material.diffuse.a};
}

/// Returns the largest error of a channel, 0 to 1, if two surfaces are blended in the wrong order:
/// a₁ a₂ |c₁ - c₂|.
double wrong_order_error(const ColorRange& a, const ColorRange& b) {
    const glm::dvec3 most = glm::max(glm::abs(a.high - b.low), glm::abs(b.high - a.low));
    return a.alpha * b.alpha * std::max({most.x, most.y, most.z});
}

/// What decides an item's order, in view space: the eye is the origin and looks along -z.
struct TransparentItem {
    OrientedBox box;
    double radius = 0;
    double nearest = 0, farthest = 0;  ///< the range of z
    glm::dvec2 low{0}, high{0};        ///< bounds of the projection on the plane z = -1
    ColorRange colors;
};

/// Gives a flat box a negligible thickness, so that each of its sides has a normal.
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

/// Returns the order of two boxes that a plane perpendicular to an axis separates, from their centres and
/// half extents along that axis. The eye lies at 0. The box on its side of the plane is in front.
DepthRelation relation_along_axis(double first, double first_extent, double second, double second_extent) {
    const bool upwards = first < second;
    const double below = upwards ? first + first_extent : second + second_extent;
    const double above = upwards ? second - second_extent : first - first_extent;
    if (below < 0 && above > 0) return DepthRelation::apart;  // a plane through the eye separates them
    return ((below + above) / 2 > 0) == upwards ? DepthRelation::first_in_front
                                                : DepthRelation::second_in_front;
}

/// Returns the order of two boxes by a plane that separates them. Candidates are the fifteen axes of the
/// separating axis test: the faces' normals of both and the cross products of their axes. Of coplanar boxes
/// the second is in front. Source: Gottschalk, Lin, Manocha, "OBBTree", SIGGRAPH 1996.
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

/// The graph of transparent items with an edge from each item to those that lie, or may lie, behind it.
class DepthOrderGraph {
public:
    DepthOrderGraph(std::span<const DrawItem> items, const View& view, TransparencyCache& shapes);

    /// Compares all pairs that overlap on the screen. Returns false, and compares none, if too many overlap.
    bool compare_all();
    /// Returns the strongly connected components, from far to near: items whose order is not known.
    std::vector<std::vector<unsigned>> groups() const { return strong_components(behind_); }
    /// Returns the mean number of items over each other, in the bounds of their visible projections.
    double depth() const;
    /// Returns an upper bound of the error of a channel, 0 to 1, if a group is drawn in any order.
    double risk(const std::vector<unsigned>& group) const;
    void sort_by_distance(std::vector<unsigned>& group) const;
    /// Sets the order in which the item's triangles are drawn. Returns true if they overlap in an unknown
    /// order and a wrong one would be visible.
    bool needs_per_pixel_order(unsigned index, DrawItem& item);

private:
    bool are_comparable(std::span<const unsigned> from_left) const;
    DepthRelation compare(unsigned a, unsigned b);
    DepthRelation compare_triangles(unsigned a, unsigned b);
    /// Returns true if an item lies in one plane, so that no ray hits it twice.
    bool is_flat(unsigned index) const;
    const std::vector<FrontFacingTriangle>& facing(unsigned index);
    /// Returns those with the given numbers.
    std::vector<FrontFacingTriangle> facing(unsigned index, const std::vector<unsigned>& numbers);
    /// Returns the item's front-facing triangles whose projections overlap the bounds of the other's.
    std::vector<FrontFacingTriangle> covering(unsigned index, const TransparentItem& other);
    const scene::Geometry& geometry(unsigned index) const {
        return scene_.geometries()[static_cast<std::size_t>(items_[index].geometry)];
    }

    std::span<const DrawItem> items_;
    const scene::Scene& scene_;
    TransparencyCache& shapes_;
    math::Projection projection_;
    std::vector<TransparentItem> transparent_items_;
    std::vector<std::vector<unsigned>> behind_;  // for each item those that may lie behind it
    std::vector<std::optional<std::vector<FrontFacingTriangle>>> facing_;
    std::size_t compared_ = 0;  // pairs of triangles so far
};

DepthOrderGraph::DepthOrderGraph(std::span<const DrawItem> items, const View& view, TransparencyCache& shapes)
    : items_(items),
      scene_(*view.scene->scene),
      shapes_(shapes),
      projection_(projection_of(view)),
      behind_(items.size()),
      facing_(items.size()) {
    for (const DrawItem& item : items)
        transparent_items_.push_back(
            transparent_item_of(transformed(item.view_from_node, shapes.box(item.geometry)),
                                color_range(item, scene_.material(item.material), view.light)));
}

const std::vector<FrontFacingTriangle>& DepthOrderGraph::facing(unsigned index) {
    if (!facing_[index]) facing_[index] = front_facing_triangles(items_[index], geometry(index));
    return *facing_[index];
}

std::vector<FrontFacingTriangle> DepthOrderGraph::facing(unsigned index,
                                                         const std::vector<unsigned>& numbers) {
    const std::vector<FrontFacingTriangle>& all = facing(index);
    std::vector<bool> wanted(2 * geometry(index).triangles.size());
    for (const unsigned number : numbers) wanted[number] = true;
    std::vector<FrontFacingTriangle> result;
    std::ranges::copy_if(all, std::back_inserter(result),
                         [&](const FrontFacingTriangle& triangle) { return wanted[triangle.number]; });
    return result;
}

/// Returns the order of two items; `a` has the lower id.
DepthRelation DepthOrderGraph::compare(unsigned a, unsigned b) {
    const TransparentItem &first = transparent_items_[a], &second = transparent_items_[b];
    if (items_[a].geometry == items_[b].geometry && items_[a].view_from_node == items_[b].view_from_node) {
        // If no triangle covers another, all depths are equal: the higher id is in front.
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
    // The search for triangles that cover each other counts too.
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

/// Returns false if more than kMaxOverlappingPairs pairs overlap in x. Counting takes much less time than
/// comparing.
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
    const glm::dvec2 image_low = projection_.at({-1, -1}), image_high = projection_.at({1, 1});
    double sum = 0;
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const TransparentItem& transparent : transparent_items_) {
        const glm::dvec2 item_low = glm::clamp(transparent.low, image_low, image_high);
        const glm::dvec2 item_high = glm::clamp(transparent.high, image_low, image_high);
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

/// Moves the elements of `all` that are in `last` to the end, in the order of `last`.
void put_last(const std::vector<unsigned>& last, std::span<unsigned> all) {
    std::vector<unsigned> sorted = last;
    std::sort(sorted.begin(), sorted.end());
    const auto rest = std::remove_if(all.begin(), all.end(), [&](unsigned number) {
        return std::binary_search(sorted.begin(), sorted.end(), number);
    });
    std::copy(last.begin(), last.end(), rest);
}

bool DepthOrderGraph::needs_per_pixel_order(unsigned index, DrawItem& item) {
    if (is_flattened(item.view_from_node)) return false;  // it lies in one plane
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
        const auto sorted =
            back_to_front(facing(index, cycle), kNegligible * transparent_items_[index].radius);
        if (!sorted) return true;
        put_last(*sorted, std::span(std::find(order.begin(), order.end(), cycle.front()), cycle.size()));
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
    // Thousands of parts may share a geometry, so they are sorted by geometry and matrix.
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
        if (other.cut) continue;
        const auto [first, last] = std::equal_range(sorted_items.begin(), sorted_items.end(), &other, before);
        for (auto match = first; match != last; ++match)
            if (id(other) > id(**match)) (*match)->occluded_by_coincident = true;
    }
}

}  // namespace vrut::plan
