#include "plan/draw_groups.hpp"

#include <algorithm>
#include <utility>

namespace vrut::plan {

namespace {

constexpr double kMargin = 1e-4;         ///< of the distance from the eye: beyond float's rounding of depth
constexpr std::size_t kRunLength = 16;   ///< items
constexpr std::size_t kMostTests = 512;  ///< of boxes, for one item

bool overlap(const math::Bounds& a, const math::Bounds& b) {
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

/// What an item covers in world space, along whose axes most parts lie.
math::Bounds box_of(const DrawItem& item, const scene::PlacedScene& placed, const glm::dvec3& eye) {
    math::Bounds box =
        transformed(placed.world[static_cast<std::size_t>(item.node)],
                    placed.scene->geometries()[static_cast<std::size_t>(item.geometry)].bounds);
    const double margin = kMargin * glm::length(glm::max(glm::abs(box.min - eye), glm::abs(box.max - eye)));
    box.min -= margin;
    box.max += margin;
    return box;
}

bool is_small(const DrawItem& item, const scene::Scene& scene) {
    return triangle_count(item, scene) <= kMostTrianglesOfSmall;
}

/// Returns true if they are drawn faster one after the other.
bool belong_together(const DrawItem& a, const DrawItem& b, const scene::Scene& scene) {
    const bool small = is_small(a, scene);
    return small == is_small(b, scene) && (small || (a.material == b.material && a.mirrored == b.mirrored)) &&
           share_draw(a, b);
}

/// Items that belong together, in runs whose boxes are tested first.
class Group {
public:
    /// `first` must outlive it.
    explicit Group(const DrawItem& first) : first_(first) {}
    const DrawItem& first() const { return first_; }

    void add(std::size_t item, const math::Bounds& box) {
        if (items_.size() % kRunLength == 0) runs_.emplace_back();
        runs_.back().add(box);
        items_.push_back(item);
        boxes_.push_back(box);
    }
    /// Also true where `tests` do not suffice to find out.
    bool may_overlap(const math::Bounds& box, std::size_t& tests) const {
        for (std::size_t run = 0; run < runs_.size(); ++run) {
            if (tests == 0) return true;
            --tests;
            if (!overlap(runs_[run], box)) continue;
            const std::size_t end = std::min((run + 1) * kRunLength, boxes_.size());
            for (std::size_t i = run * kRunLength; i < end; ++i)
                if (overlap(boxes_[i], box)) return true;
        }
        return false;
    }
    const std::vector<std::size_t>& items() const { return items_; }

private:
    const DrawItem& first_;
    std::vector<std::size_t> items_;
    std::vector<math::Bounds> boxes_, runs_;
};

/// The last group that the item belongs to and behind which nothing overlaps it; null: there is none.
Group* group_for(std::vector<Group>& groups, const DrawItem& item, const math::Bounds& box,
                 const scene::Scene& scene) {
    std::size_t tests = kMostTests;
    for (std::size_t k = groups.size(); k > 0; --k) {
        Group& group = groups[k - 1];
        if (belong_together(group.first(), item, scene)) return &group;
        if (group.may_overlap(box, tests)) return nullptr;
    }
    return nullptr;
}

}  // namespace

bool share_draw(const DrawItem& a, const DrawItem& b) {
    return a.texture == b.texture && a.environment == b.environment &&
           (a.cull_mode == CullMode::none) == (b.cull_mode == CullMode::none) &&
           a.clip_plane.has_value() == b.clip_plane.has_value();
}

void group_for_draws(std::vector<DrawItem>& items, const scene::PlacedScene& placed, const glm::dvec3& eye) {
    const scene::Scene& scene = *placed.scene;
    const auto differs = [&](const DrawItem& item) { return !belong_together(items.front(), item, scene); };
    if (std::ranges::none_of(items, differs)) return;
    std::vector<Group> groups;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const math::Bounds box = box_of(items[i], placed, eye);
        Group* group = group_for(groups, items[i], box, scene);
        if (!group) group = &groups.emplace_back(items[i]);
        group->add(i, box);
    }
    std::vector<DrawItem> grouped;
    grouped.reserve(items.size());
    for (const Group& group : groups)
        for (const std::size_t i : group.items()) grouped.push_back(std::move(items[i]));
    items = std::move(grouped);
}

}  // namespace vrut::plan
