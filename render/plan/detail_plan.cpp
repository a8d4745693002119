#include "plan/detail_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "mesh/detail_levels.hpp"

namespace vrut {

namespace {

constexpr double kNearMargin = 1e-4;  ///< beyond float's rounding

/// No vector grows by more under the matrix: the root of Gershgorin's bound on the eigenvalues of MᵀM, which
/// is exact where the axes stay at right angles.
double largest_scale(const glm::dmat3& m) {
    const glm::dmat3 squares = glm::transpose(m) * m;
    double most = 0;
    for (int k = 0; k < 3; ++k)
        most = std::max(most, std::abs(squares[k].x) + std::abs(squares[k].y) + std::abs(squares[k].z));
    return std::sqrt(most);
}

class Choice {
public:
    /// Levels that are made meanwhile wait for the next picture: all of a geometry's items see the same.
    explicit Choice(const View& view) : view_(view), scene_(*view.scene->scene) {
        for (std::size_t i = 0; i < scene_.geometries().size(); ++i)
            levels_.push_back(view.levels->of(static_cast<Index>(i)));
    }

    void choose_in(Layers& layers) const {
        const Whole whole = kept_whole(layers);
        for (DrawItem& item : layers.opaque) choose(item, whole);
        for (MirrorItem& mirror : layers.mirrors) choose(mirror.surface, whole);
        choose_in_mirrors(layers);
        for (TransparentGroup& group : layers.transparent)
            for (DrawItem& item : group.items) {
                if (item.behind_twin) item.order = nullptr;  // nothing of it is seen
                if (!item.order || group.exact) choose(item, whole);
            }
    }

    void choose_in_mirrors(Layers& layers) const {
        for (MirrorItem& mirror : layers.mirrors) choose_in(mirror.reflected);
    }

private:
    using Whole = std::multimap<Index, glm::dmat4>;  ///< matrices by geometry

    bool has_levels(const DrawItem& item) const {
        return !levels_[static_cast<std::size_t>(item.geometry)].empty();
    }

    /// What keeps every triangle: textured parts, since the bound is of places and not of what is painted on
    /// them, and glass whose triangles have an order. What stands in the same place has to as well, so that
    /// their depths are equal.
    Whole kept_whole(const Layers& layers) const {
        Whole whole;
        const auto look_at = [&](const DrawItem& item, bool ordered) {
            if ((item.texture != kNone || ordered) && has_levels(item))
                whole.emplace(item.geometry, item.view_from_node);
        };
        for (const DrawItem& item : layers.opaque) look_at(item, false);
        for (const MirrorItem& mirror : layers.mirrors) look_at(mirror.surface, false);
        for (const TransparentGroup& group : layers.transparent)
            for (const DrawItem& item : group.items)
                look_at(item, item.order && !item.behind_twin && !group.exact);
        return whole;
    }

    void choose(DrawItem& item, const Whole& whole) const {
        if (!has_levels(item)) return;
        const auto [first, last] = whole.equal_range(item.geometry);
        const bool every = !(view_.detail > 0) || std::any_of(first, last, [&](const auto& twin) {
            return twin.second == item.view_from_node;
        });
        const Bounds& box = scene_.geometries()[static_cast<std::size_t>(item.geometry)].bounds;
        const double most = view_.detail / most_pixels(item.view_from_node, box, view_);
        for (const DetailLevel& level : levels_[static_cast<std::size_t>(item.geometry)])
            if (level.number == 0 || (!every && level.error <= most)) item.level = &level;
    }

    const View& view_;
    const Scene& scene_;
    std::vector<std::span<const DetailLevel>> levels_;
};

/// Whether nothing in the box is cut by the near plane or reaches around the eye.
bool is_seen_whole(const Bounds& in_view, const View& view) {
    const double near = fit_clip_range(view.camera, view.scene->bounds).near * (1 + kNearMargin);
    if (-in_view.max.z > near) return true;
    const double half = std::tan(view.camera.fov * kRadiansPerDegree / 2);
    const double aspect = static_cast<double>(view.width) / view.height;
    const double corner = near * std::sqrt(1 + half * half * (1 + aspect * aspect));
    return glm::length(glm::clamp(glm::dvec3(0), in_view.min, in_view.max)) > corner;
}

void leave_out_backs(Layers& layers, const View& view) {
    const Scene& scene = *view.scene->scene;
    for (DrawItem& item : layers.opaque)
        if (item.sides == Sides::both && !item.kept && view.levels->closed(item.geometry) &&
            !is_flattened(item.view_from_node) &&
            is_seen_whole(transformed(item.view_from_node,
                                      scene.geometries()[static_cast<std::size_t>(item.geometry)].bounds),
                          view))
            item.sides = Sides::closed;
    for (MirrorItem& mirror : layers.mirrors) leave_out_backs(mirror.reflected, view);
}

}  // namespace

double most_pixels(const glm::dmat4& view_from_node, const Bounds& box, const View& view) {
    const Bounds in_view = transformed(view_from_node, box);
    const double depth = -in_view.max.z;
    if (!(depth > 0)) return std::numeric_limits<double>::infinity();
    // A step s at depth z and at an angle a to the line of sight is seen no longer than s / (z cos a): it is
    // longest at right angles to the ray, in the plane of both.
    const double half = std::tan(view.camera.fov * kRadiansPerDegree / 2);
    const glm::dvec2 corner = half * glm::dvec2(static_cast<double>(view.width) / view.height, 1);
    const glm::dvec2 aside = glm::min(
        glm::max(glm::abs(glm::dvec2(in_view.min)), glm::abs(glm::dvec2(in_view.max))) / depth, corner);
    const double slant = std::sqrt(1 + glm::dot(aside, aside));
    return largest_scale(glm::dmat3(view_from_node)) * slant * view.height / (2 * half * depth);
}

void choose_levels(FramePlan& plan, const View& view) {
    if (!view.levels || view.mode != DrawMode::realistic || view.wireframe) return;
    if (view.levels->scene() != view.scene->scene) return;
    const Choice choice(view);
    choice.choose_in(plan.scene);
    choice.choose_in_mirrors(plan.over);
}

void leave_out_backs(FramePlan& plan, const View& view) {
    if (!view.levels || view.levels->scene() != view.scene->scene) return;
    leave_out_backs(plan.scene, view);
    leave_out_backs(plan.over, view);
}

}  // namespace vrut
