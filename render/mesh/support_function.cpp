#include "mesh/support_function.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vrut::mesh {

namespace {

/// Squares and sums of the points stay finite below it.
constexpr double kFarthest = 1e150;

/// An upper bound of the rounding error of d · p, relative to its largest term, for any order of the sum.
constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();

/// A part in a direction: d · (world p) = slope · (p − center) + middle.
struct Slope {
    Slope(const scene::Geometry& geometry, const glm::dmat4& world, const glm::dvec3& direction)
        : center(geometry.bounds.center()),
          slope(glm::transpose(glm::dmat3(world)) * direction),
          middle(glm::dot(direction, glm::dvec3(world * glm::dvec4(center, 1)))) {}

    double at(const glm::dvec3& position) const { return glm::dot(slope, position - center) + middle; }
    /// An upper bound of at() for points within `half` of the centre.
    double most(const glm::dvec3& half) const {
        const double reach = glm::dot(glm::abs(slope), half);
        return middle + reach + kRounding * (std::abs(middle) + reach);
    }

    glm::dvec3 center, slope;
    double middle;
};

/// The largest value of the triangles' corners, or `most` where that is larger.
double most_of(const scene::Geometry& geometry, const Bvh<float>* tree, const Slope& slope, double most) {
    const auto ask = [&](std::uint32_t number) {
        const glm::uvec3& triangle = geometry.triangles[number];
        for (int k = 0; k < 3; ++k) {
            const double value = slope.at(geometry.positions[triangle[k]]);
            if (value > most) most = value;  // asked so that a number that is not finite does not count
        }
    };
    if (!tree) {
        for (std::uint32_t i = 0; i < geometry.triangles.size(); ++i) ask(i);
        return most;
    }
    // The tree's visit looks for the least value.
    const glm::dvec3 in_tree = slope.slope * tree_scale(geometry);
    const auto lower_bound = [&](const Bvh<float>::Box& box) {
        const glm::dvec3 a = in_tree * glm::dvec3(box.min), b = in_tree * glm::dvec3(box.max);
        const glm::dvec3 high = glm::max(a, b);
        const double reach = high.x + high.y + high.z;
        const double slack = kRounding * (std::abs(slope.middle) + std::abs(in_tree.x) + std::abs(in_tree.y) +
                                          std::abs(in_tree.z));
        return -(slope.middle + reach + slack);
    };
    double least = -most;
    tree->visit(lower_bound, least, [&](std::uint32_t number) {
        ask(number);
        least = -most;
    });
    return most;
}

/// What a plane leaves of a polygon (Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974).
std::vector<glm::dvec3> clipped(const std::vector<glm::dvec3>& polygon, const glm::dvec4& equation) {
    std::vector<glm::dvec3> kept;
    kept.reserve(polygon.size() + 1);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double above_a = glm::dot(equation, glm::dvec4(a, 1));
        const double above_b = glm::dot(equation, glm::dvec4(b, 1));
        if (above_a >= 0) kept.push_back(a);
        if ((above_a < 0) != (above_b < 0)) kept.push_back(a + (b - a) * (above_a / (above_a - above_b)));
    }
    return kept;
}

/// Adds the corners of what planes leave of a geometry's triangles.
void add_kept(const scene::Geometry& geometry, const glm::dmat4& world, std::span<const glm::dvec4> equations,
              std::vector<glm::dvec3>& points) {
    const auto add = [&](const glm::dvec3& p) { points.emplace_back(world * glm::dvec4(p, 1)); };
    const auto is_kept = [&](const glm::dvec3& p) {
        return std::ranges::all_of(
            equations, [&](const glm::dvec4& equation) { return glm::dot(equation, glm::dvec4(p, 1)) >= 0; });
    };
    std::vector<bool> kept(geometry.positions.size());
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = is_kept(geometry.positions[i]);
    std::vector<bool> is_added(kept.size());
    for (const glm::uvec3& triangle : geometry.triangles) {
        std::vector<glm::dvec3> polygon;
        for (int k = 0; k < 3; ++k) {
            polygon.push_back(geometry.positions[triangle[k]]);
            if (!kept[triangle[k]] || is_added[triangle[k]]) continue;
            is_added[triangle[k]] = true;
            add(polygon.back());
        }
        if (kept[triangle.x] && kept[triangle.y] && kept[triangle.z]) continue;
        for (const glm::dvec4& equation : equations) polygon = clipped(polygon, equation);
        for (const glm::dvec3& p : polygon) add(p);
    }
}

}  // namespace

SupportFunction::SupportFunction(const scene::PlacedScene& placed, scene::Index node,
                                 const PickingTrees* trees, std::span<const scene::ClipPlane> clip_planes) {
    bool has_parts = false;
    const std::vector<bool> shown = scene::shown_nodes(placed, std::nullopt);
    const std::vector<bool> below = scene::subtree(*placed.scene, node);
    std::vector<Part> presentation;
    math::Bounds around_presentation;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto* data = std::get_if<scene::GeometryData>(&placed.scene->nodes()[i].data);
        if (!shown[i] || !below[i] || !data || data->geometry == scene::kNone) continue;
        const scene::Geometry& geometry =
            placed.scene->geometries()[static_cast<std::size_t>(data->geometry)];
        if (geometry.triangles.empty() || geometry.bounds.empty() || !scene::is_finite(placed.world[i]))
            continue;
        const math::Bounds box = math::transformed(placed.world[i], geometry.bounds);
        if (!(glm::length(box.min) < kFarthest && glm::length(box.max) < kFarthest)) continue;
        const bool presents = placed.scene->is_presentation(static_cast<scene::Index>(i));
        const Part part{&geometry, trees ? trees->of(data->geometry) : nullptr, placed.world[i]};
        if (presents) {
            around_presentation.add(box);
            presentation.push_back(part);
            continue;
        }
        has_parts = true;
        std::vector<glm::dvec4> crossing;
        scene::Side side = scene::Side::shown;
        for (const scene::ClipPlane& plane : clip_planes) {
            const glm::dvec4 equation = scene::clip_equation(plane, placed.world[i]);
            const scene::Side of_plane = scene::side_of(geometry.bounds, equation);
            if (of_plane == scene::Side::crossed) crossing.push_back(equation);
            if (of_plane == scene::Side::hidden) side = of_plane;
        }
        if (side == scene::Side::hidden) continue;
        if (!crossing.empty()) {
            add_kept(geometry, placed.world[i], crossing, cut_points_);
            continue;
        }
        bounds_.add(box);
        parts_.push_back(part);
    }
    for (const glm::dvec3& point : cut_points_) bounds_.add(point);
    if (has_parts) return;
    parts_ = std::move(presentation);
    bounds_ = around_presentation;
}

double SupportFunction::operator()(const glm::dvec3& direction) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const Part& part : parts_) {
        const Slope slope(*part.geometry, part.world, direction);
        if (slope.most(part.geometry->bounds.half_extent()) > most)
            most = most_of(*part.geometry, part.tree, slope, most);
    }
    for (const glm::dvec3& point : cut_points_) most = std::max(most, glm::dot(direction, point));
    return most;
}

}  // namespace vrut::mesh
