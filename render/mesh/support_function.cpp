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

}  // namespace

SupportFunction::SupportFunction(const scene::PlacedScene& placed, scene::Index node,
                                 const PickingTrees* trees) {
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
        (presents ? around_presentation : bounds_).add(box);
        (presents ? presentation : parts_)
            .push_back({&geometry, trees ? trees->of(data->geometry) : nullptr, placed.world[i]});
    }
    if (!parts_.empty()) return;
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
    return most;
}

}  // namespace vrut::mesh
