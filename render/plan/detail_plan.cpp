#include "plan/detail_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "mesh/detail_levels.hpp"

namespace vrut::plan {

namespace {

constexpr double kNearMargin = 1e-4;  ///< beyond float's rounding

/// Returns an upper bound of the matrix's largest singular value: the square root of Gershgorin's bound on
/// the eigenvalues of MᵀM. It is exact where the axes stay orthogonal.
double max_scale(const glm::dmat3& m) {
    const glm::dmat3 squares = glm::transpose(m) * m;
    double most = 0;
    for (int k = 0; k < 3; ++k)
        most = std::max(most, std::abs(squares[k].x) + std::abs(squares[k].y) + std::abs(squares[k].z));
    return std::sqrt(most);
}

class LevelSelector {
public:
    /// Levels that are made meanwhile wait for the next image: all of a geometry's items see the same.
    LevelSelector(FramePlan& plan, const View& view, const IsResident& is_resident)
        : plan_(plan), view_(view), scene_(*view.scene->scene), is_resident_(is_resident) {
        levels_.reserve(scene_.geometries().size());
        for (std::size_t i = 0; i < scene_.geometries().size(); ++i)
            levels_.push_back(view.levels->of(static_cast<scene::Index>(i)));
    }

    void select_in(DrawLists& lists) const {
        const FullDetailItems full_detail = full_detail_items(lists);
        for (DrawItem& item : lists.opaque) select(item, full_detail);
        for (MirrorItem& mirror : lists.mirrors) select(mirror.surface, full_detail);
        select_in_mirrors(lists);
        for (TransparentGroup& group : lists.transparent)
            for (DrawItem& item : group.items) {
                if (item.occluded_by_coincident) item.order = nullptr;  // nothing of it is seen
                if (!item.order || group.exact) select(item, full_detail);
            }
    }

    void select_in_mirrors(DrawLists& lists) const {
        for (MirrorItem& mirror : lists.mirrors) select_in(mirror.reflected);
    }

private:
    using FullDetailItems = std::multimap<scene::Index, glm::dmat4>;  ///< matrices by geometry

    bool has_levels(const DrawItem& item) const {
        return !levels_[static_cast<std::size_t>(item.geometry)].empty();
    }

    /// Collects the items that keep full detail: those with textures or colours at their vertices, since the
    /// error bound covers positions and not these, and glass with ordered triangles. Coincident items must
    /// keep it too, so that their depths are equal.
    FullDetailItems full_detail_items(const DrawLists& lists) const {
        FullDetailItems full_detail;
        const auto add_if_full_detail = [&](const DrawItem& item, bool ordered) {
            if ((item.texture != scene::kNone || item.emissive_texture != scene::kNone || item.colored ||
                 is_mapped(item) || ordered) &&
                has_levels(item))
                full_detail.emplace(item.geometry, item.view_from_node);
        };
        for (const DrawItem& item : lists.opaque) add_if_full_detail(item, false);
        for (const MirrorItem& mirror : lists.mirrors) add_if_full_detail(mirror.surface, false);
        for (const TransparentGroup& group : lists.transparent)
            for (const DrawItem& item : group.items)
                add_if_full_detail(item, item.order && !item.occluded_by_coincident && !group.exact);
        return full_detail;
    }

    void select(DrawItem& item, const FullDetailItems& full_detail) const {
        if (item.cut || !has_levels(item)) return;
        const auto [first, last] = full_detail.equal_range(item.geometry);
        const bool is_full_detail = !(view_.detail > 0) || std::any_of(first, last, [&](const auto& other) {
            return other.second == item.view_from_node;
        });
        const math::Bounds& box = scene_.geometries()[static_cast<std::size_t>(item.geometry)].bounds;
        const double most =
            is_full_detail ? 0 : view_.detail / max_screen_space_scale(item.view_from_node, box, view_);
        const mesh::DetailLevel* missing = nullptr;
        const std::span levels = levels_[static_cast<std::size_t>(item.geometry)];
        for (std::size_t k = levels.size(); k > 0; --k) {  // from the coarsest
            const mesh::DetailLevel& level = levels[k - 1];
            if (level.number != 0 && (is_full_detail || level.error > most)) continue;
            if (!is_resident_ || is_resident_(item.geometry, level)) {
                item.level = &level;
                break;
            }
            if (!missing) missing = &level;
        }
        if (missing) plan_.missing_levels.emplace_back(item.geometry, missing);
    }

    FramePlan& plan_;
    const View& view_;
    const scene::Scene& scene_;
    const IsResident& is_resident_;
    std::vector<std::span<const mesh::DetailLevel>> levels_;
};

/// Returns true if nothing in the box is cut by the near plane or reaches around the eye.
bool is_beyond_near_plane(const math::Bounds& in_view, const View& view) {
    const double near = near_distance(view) * (1 + kNearMargin);
    if (-in_view.max.z > near) return true;
    const math::Projection sides = projection_of(view);
    const double corner = near * glm::length(glm::dvec3(sides.right, sides.top, 1));
    return glm::length(glm::clamp(glm::dvec3(0), in_view.min, in_view.max)) > corner;
}

void cull_backfaces(DrawLists& lists, const View& view) {
    const scene::Scene& scene = *view.scene->scene;
    for (DrawItem& item : lists.opaque)
        if (item.cull_mode == CullMode::none && item.clip_planes.empty() &&
            view.levels->watertight(item.geometry).value_or(false) && !is_flattened(item.view_from_node) &&
            is_beyond_near_plane(
                transformed(item.view_from_node,
                            scene.geometries()[static_cast<std::size_t>(item.geometry)].bounds),
                view))
            item.cull_mode = CullMode::hidden_back;
    for (MirrorItem& mirror : lists.mirrors) cull_backfaces(mirror.reflected, view);
}

}  // namespace

double max_screen_space_scale(const glm::dmat4& view_from_node, const math::Bounds& box, const View& view) {
    const math::Bounds in_view = transformed(view_from_node, box);
    const double depth = -in_view.max.z;
    if (!(depth > 0)) return std::numeric_limits<double>::infinity();
    // A step s at depth z and at an angle a to the line of sight is seen no longer than s / (z cos a): it is
    // longest at right angles to the ray, in the plane of both.
    const math::Projection sides = projection_of(view);
    const glm::dvec2 corner(sides.right, sides.top);
    const glm::dvec2 aside = glm::min(
        glm::max(glm::abs(glm::dvec2(in_view.min)), glm::abs(glm::dvec2(in_view.max))) / depth, corner);
    const double obliquity = std::sqrt(1 + glm::dot(aside, aside));
    return max_scale(glm::dmat3(view_from_node)) * obliquity * view.height / (sides.height() * depth);
}

void select_levels(FramePlan& plan, const View& view, const IsResident& is_resident) {
    if (!view.levels || style_of(view).edges) return;
    if (view.levels->scene() != view.scene->scene) return;
    const LevelSelector selector(plan, view, is_resident);
    selector.select_in(plan.scene);
    selector.select_in_mirrors(plan.overlay);
}

void cull_backfaces(FramePlan& plan, const View& view) {
    if (!view.levels || view.levels->scene() != view.scene->scene) return;
    cull_backfaces(plan.scene, view);
    cull_backfaces(plan.overlay, view);
}

}  // namespace vrut::plan
