#include "plan/draw_groups.hpp"

#include <algorithm>
#include <span>
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

/// Items that belong together, in runs whose boxes are tested first. All groups lie in a few arrays: memory
/// of their own would take longer than the tests.
class Groups {
public:
    Groups(std::span<const DrawItem> items, const scene::Scene& scene) : items_(items), scene_(scene) {
        next_.reserve(items.size());
        boxes_.reserve(items.size());
        runs_.reserve(items.size());
    }

    /// Adds the next item to the last group that it belongs to and behind which nothing overlaps it; else it
    /// begins a group.
    void add(const math::Bounds& box) {
        const std::size_t item = boxes_.size();
        boxes_.push_back(box);
        next_.push_back(kNone);
        std::size_t tests = kMostTests;
        for (std::size_t k = groups_.size(); k > 0; --k) {
            Group& group = groups_[k - 1];
            if (belong_together(items_[group.first], items_[item], scene_)) return append(group, item);
            if (may_overlap(group, box, tests)) break;
        }
        groups_.push_back({item, item, runs_.size(), runs_.size()});
        runs_.push_back({item, 1, box});
    }

    /// Calls `visit` for each item, group by group.
    template <class Visit>
    void for_each_item(const Visit& visit) const {
        for (const Group& group : groups_)
            for (std::size_t item = group.first; item != kNone; item = next_[item]) visit(item);
    }

private:
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

    struct Group {
        std::size_t first, last;  // items
        std::size_t first_run, last_run;
    };
    /// `count` items of a group from `first` on.
    struct Run {
        std::size_t first, count;
        math::Bounds box;
        std::size_t next = kNone;
    };

    void append(Group& group, std::size_t item) {
        next_[group.last] = item;
        group.last = item;
        if (runs_[group.last_run].count == kRunLength) {
            runs_[group.last_run].next = runs_.size();
            group.last_run = runs_.size();
            runs_.push_back({item, 0, {}});
        }
        Run& run = runs_[group.last_run];
        ++run.count;
        run.box.add(boxes_[item]);
    }

    /// Also true where `tests` do not suffice to find out.
    bool may_overlap(const Group& group, const math::Bounds& box, std::size_t& tests) const {
        for (std::size_t k = group.first_run; k != kNone; k = runs_[k].next) {
            if (tests == 0) return true;
            --tests;
            const Run& run = runs_[k];
            if (!overlap(run.box, box)) continue;
            std::size_t item = run.first;
            for (std::size_t i = 0; i < run.count; ++i, item = next_[item])
                if (overlap(boxes_[item], box)) return true;
        }
        return false;
    }

    std::span<const DrawItem> items_;
    const scene::Scene& scene_;
    std::vector<Group> groups_;
    std::vector<Run> runs_;
    std::vector<std::size_t> next_;  // of each item, the next one of its group
    std::vector<math::Bounds> boxes_;
};

}  // namespace

bool share_draw(const DrawItem& a, const DrawItem& b) {
    return a.texture == b.texture && a.colored == b.colored && !a.emissive && !b.emissive &&
           a.metallic_roughness == b.metallic_roughness && a.coated == b.coated && !is_mapped(a) &&
           !is_mapped(b) && a.environment == b.environment &&
           (a.cull_mode == CullMode::none) == (b.cull_mode == CullMode::none) &&
           a.clip_planes.size() == b.clip_planes.size() && a.clip_planes.size() <= 1;
}

void group_for_draws(std::vector<DrawItem>& items, const scene::PlacedScene& placed, const glm::dvec3& eye) {
    const scene::Scene& scene = *placed.scene;
    const auto differs = [&](const DrawItem& item) { return !belong_together(items.front(), item, scene); };
    if (std::ranges::none_of(items, differs)) return;
    Groups groups(items, scene);
    for (const DrawItem& item : items) groups.add(box_of(item, placed, eye));
    std::vector<DrawItem> grouped;
    grouped.reserve(items.size());
    groups.for_each_item([&](std::size_t item) { grouped.push_back(std::move(items[item])); });
    items = std::move(grouped);
}

}  // namespace vrut::plan
