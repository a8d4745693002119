#include "transparency_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace vrut {

namespace {

constexpr double kVisible = 1.0 / 255;

/// Between which colours a material can be seen under a light, whatever its normals.
struct ColorRange {
    glm::dvec3 low{0}, high{1};
    double alpha = 1;
};

ColorRange color_range(const Material& material, const Light& light) {
    if (material.reflectivity > 0) return {glm::dvec3(0), glm::dvec3(1), material.diffuse.a};
    const glm::dvec3 diffuse = material.texture == kNone ? glm::dvec3(material.diffuse) : glm::dvec3(1);
    const double brightest = light.attenuation == glm::dvec3(0) ? 1 : 1 / std::max(light.attenuation.x, 1e-6);
    const glm::dvec3 unlit = glm::dvec3(material.emission) + glm::dvec3(material.ambient);
    const glm::dvec3 lit = (diffuse + glm::dvec3(material.specular)) * glm::dvec3(light.color) * brightest;
    return {glm::clamp(unlit, 0.0, 1.0), glm::clamp(unlit + lit, 0.0, 1.0), material.diffuse.a};
}

/// How much a colour can change where two surfaces are drawn in the wrong order: a₁ a₂ |c₁ - c₂|.
double swapped_difference(const ColorRange& a, const ColorRange& b) {
    const glm::dvec3 most = glm::max(glm::abs(a.high - b.low), glm::abs(b.high - a.low));
    return a.alpha * b.alpha * std::max({most.x, most.y, most.z});
}

/// An item as the order sees it: in view space, the eye at the origin, looking along -z.
struct Pane {
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

Pane pane_of(OrientedBox box, const ColorRange& colors) {
    thicken(box);
    constexpr double kEverywhere = std::numeric_limits<double>::infinity();
    Pane pane{box, 0, -kEverywhere, kEverywhere, glm::dvec2(kEverywhere), glm::dvec2(-kEverywhere), colors};
    for (unsigned corner = 0; corner < 8; ++corner) {
        glm::dvec3 at = box.center;
        for (unsigned k = 0; k < 3; ++k) at += corner >> k & 1 ? box.axes[k] : -box.axes[k];
        pane.radius = std::max(pane.radius, glm::distance(at, box.center));
        pane.nearest = std::max(pane.nearest, at.z);
        pane.farthest = std::min(pane.farthest, at.z);
        pane.low = glm::min(pane.low, glm::dvec2(at) / -at.z);
        pane.high = glm::max(pane.high, glm::dvec2(at) / -at.z);
    }
    if (pane.farthest < 0 && pane.nearest >= 0) {
        pane.low = glm::dvec2(-kEverywhere);
        pane.high = glm::dvec2(kEverywhere);
    }
    return pane;
}

enum class Order { apart, first_in_front, second_in_front, unknown };

/// What a plane at right angles to `axis` tells of two boxes whose extents along it are these: it lies
/// between them, and the eye, at 0, is on the side of the one in front.
Order told_by(double first, double first_extent, double second, double second_extent) {
    const bool upwards = first < second;
    const double below = upwards ? first + first_extent : second + second_extent;
    const double above = upwards ? second - second_extent : first - first_extent;
    if (below < 0 && above > 0) return Order::apart;  // the plane holds the eye
    return ((below + above) / 2 > 0) == upwards ? Order::first_in_front : Order::second_in_front;
}

/// Of two boxes by a plane that parts them, for which fifteen directions come into question: those of their
/// axes and at right angles to two of them. Coplanar ones have the second in front.
Order order_of(const OrientedBox& a, const OrientedBox& b, double size) {
    const double tolerance = 1e-6 * size;
    bool coplanar = false;
    Order result = Order::unknown;
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
        result = told_by(at_a, extent_a, at_b, extent_b);
        return true;
    };
    const auto facing = [](const OrientedBox& box, std::size_t k) {
        return glm::cross(box.axes[(k + 1) % 3], box.axes[(k + 2) % 3]);
    };
    for (std::size_t k = 0; k < 3; ++k)
        if (try_axis(facing(a, k)) || try_axis(facing(b, k))) return result;
    for (std::size_t k = 0; k < 9; ++k)
        if (try_axis(glm::cross(a.axes[k / 3], b.axes[k % 3]))) return result;
    return coplanar ? Order::second_in_front : Order::unknown;
}

/// Which panes lie before which others, as the eye sees them.
class Stack {
public:
    explicit Stack(std::vector<Pane> panes) : panes_(std::move(panes)), behind_(panes_.size()) {}

    /// False where too many overlap.
    bool compare_all(std::span<const DrawItem> items);
    /// Panes by number, in groups that no order parts, from far to near.
    std::vector<std::vector<std::size_t>> groups() const;
    /// What drawing a group in some order could change.
    double risk(const std::vector<std::size_t>& group) const;
    void sort_by_distance(std::vector<std::size_t>& group) const;

private:
    Order compare(std::size_t a, std::size_t b, std::span<const DrawItem> items) const;

    std::vector<Pane> panes_;
    std::vector<std::vector<std::size_t>> behind_;  // for each those that lie behind it, or may
};

/// `a` has the lower id.
Order Stack::compare(std::size_t a, std::size_t b, std::span<const DrawItem> items) const {
    const Pane &first = panes_[a], &second = panes_[b];
    if (items[a].geometry == items[b].geometry && items[a].view_from_node == items[b].view_from_node)
        return Order::second_in_front;
    if (first.nearest < second.farthest) return Order::second_in_front;
    if (second.nearest < first.farthest) return Order::first_in_front;
    return order_of(first.box, second.box, first.radius + second.radius);
}

bool Stack::compare_all(std::span<const DrawItem> items) {
    std::vector<std::size_t> from_left(panes_.size());
    std::iota(from_left.begin(), from_left.end(), std::size_t{0});
    std::sort(from_left.begin(), from_left.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(panes_[a].low.x, a) < std::tie(panes_[b].low.x, b);
    });
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < from_left.size(); ++i) {
        const Pane& left = panes_[from_left[i]];
        for (std::size_t k = i + 1; k < from_left.size(); ++k) {
            const Pane& right = panes_[from_left[k]];
            if (right.low.x > left.high.x) break;
            if (right.low.y > left.high.y || left.low.y > right.high.y) continue;
            if (++pairs > kMostPairs) return false;
            const auto [a, b] = std::minmax(from_left[i], from_left[k]);
            const Order order = compare(a, b, items);
            if (order == Order::first_in_front || order == Order::unknown) behind_[a].push_back(b);
            if (order == Order::second_in_front || order == Order::unknown) behind_[b].push_back(a);
        }
    }
    return true;
}

/// Strongly connected components (Tarjan 1972, without recursion). A component is complete only after all
/// that it leads to, which is what lies behind it.
std::vector<std::vector<std::size_t>> Stack::groups() const {
    constexpr std::size_t kUnseen = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> number(panes_.size(), kUnseen), lowest(panes_.size()), next(panes_.size(), 0);
    std::vector<bool> open(panes_.size(), false);
    std::vector<std::size_t> path, pending;
    std::vector<std::vector<std::size_t>> result;
    std::size_t count = 0;
    for (std::size_t start = 0; start < panes_.size(); ++start) {
        if (number[start] != kUnseen) continue;
        path.push_back(start);
        while (!path.empty()) {
            const std::size_t at = path.back();
            if (number[at] == kUnseen) {
                number[at] = lowest[at] = count++;
                pending.push_back(at);
                open[at] = true;
            }
            if (next[at] < behind_[at].size()) {
                const std::size_t to = behind_[at][next[at]++];
                if (number[to] == kUnseen)
                    path.push_back(to);
                else if (open[to])
                    lowest[at] = std::min(lowest[at], number[to]);
                continue;
            }
            path.pop_back();
            if (!path.empty()) lowest[path.back()] = std::min(lowest[path.back()], lowest[at]);
            if (lowest[at] != number[at]) continue;
            std::vector<std::size_t>& group = result.emplace_back();
            do {
                group.push_back(pending.back());
                open[pending.back()] = false;
                pending.pop_back();
            } while (group.back() != at);
            std::sort(group.begin(), group.end());
        }
    }
    return result;
}

double Stack::risk(const std::vector<std::size_t>& group) const {
    double sum = 0;
    for (const std::size_t a : group)
        for (const std::size_t b : behind_[a])
            if (std::binary_search(group.begin(), group.end(), b))
                sum += swapped_difference(panes_[a].colors, panes_[b].colors);
    return sum;
}

void Stack::sort_by_distance(std::vector<std::size_t>& group) const {
    const auto distance = [&](std::size_t pane) { return glm::length(panes_[pane].box.center); };
    std::stable_sort(group.begin(), group.end(),
                     [&](std::size_t a, std::size_t b) { return distance(a) > distance(b); });
}

}  // namespace

std::vector<TransparentGroup> order_transparent(std::span<const DrawItem> items, const Scene& scene,
                                                const Light& light, GlassShapes& shapes) {
    std::vector<Pane> panes;
    for (const DrawItem& item : items)
        panes.push_back(pane_of(transformed(item.view_from_node, shapes.of(scene, item.geometry).box),
                                color_range(scene.material(item.material), light)));
    Stack stack(std::move(panes));
    std::vector<std::vector<std::size_t>> order;
    const bool ordered = stack.compare_all(items);
    if (ordered) {
        order = stack.groups();
    } else {
        order.emplace_back(items.size());
        std::iota(order[0].begin(), order[0].end(), std::size_t{0});
    }
    std::vector<TransparentGroup> groups;
    for (std::vector<std::size_t>& members : order) {
        const bool exact = ordered && members.size() > 1 && stack.risk(members) > kVisible;
        if (!exact) stack.sort_by_distance(members);
        if (exact || groups.empty() || groups.back().exact) groups.push_back({{}, exact});
        for (const std::size_t member : members) groups.back().items.push_back(items[member]);
    }
    return groups;
}

void mark_hidden_twins(std::vector<DrawItem>& items, std::span<const DrawItem> others, const Scene& scene) {
    const auto id = [&](const DrawItem& item) {
        return scene.nodes()[static_cast<std::size_t>(item.node)].id;
    };
    std::multimap<Index, const DrawItem*> by_geometry;
    for (const DrawItem& other : others) by_geometry.emplace(other.geometry, &other);
    for (DrawItem& item : items) {
        const auto [first, last] = by_geometry.equal_range(item.geometry);
        item.behind_twin = std::any_of(first, last, [&](const auto& entry) {
            const DrawItem& other = *entry.second;
            return other.view_from_node == item.view_from_node && id(other) > id(item);
        });
    }
}

}  // namespace vrut
