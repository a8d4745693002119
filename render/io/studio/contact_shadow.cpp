#include "io/studio/contact_shadow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "math/bounds.hpp"

namespace vrut::io {

namespace {

using Corners = std::array<glm::dvec3, 3>;

/// Calls `use` with the corners of each triangle, or of one of each k where they are too many, transformed by
/// `to` · world. Triangles with corners that are not finite are left out.
template <class Use>
void for_each_triangle(std::span<const PlacedGeometry> geometries, const glm::dmat4& to, const Use& use) {
    constexpr std::size_t kMaxTriangles = 2'000'000;
    std::size_t count = 0;
    for (const PlacedGeometry& placed : geometries) count += placed.geometry->triangles.size();
    // Of each stratum another one, by a golden ratio sequence: geometries repeat themselves.
    const std::uint64_t stratum = 1 + count / kMaxTriangles;
    const auto pick = [stratum](std::uint64_t k) {
        return k * stratum + ((k * 0x9E3779B9 & 0xFFFFFFFF) * stratum >> 32);
    };
    std::uint64_t picked = 0, first = 0;  // of all triangles
    for (const PlacedGeometry& placed : geometries) {
        const scene::Geometry& geometry = *placed.geometry;
        const glm::dmat4 matrix = to * placed.world;
        const std::uint64_t end = first + geometry.triangles.size();
        for (std::uint64_t i = pick(picked); i < end; i = pick(++picked)) {
            const glm::uvec3& triangle = geometry.triangles[i - first];
            Corners corners;
            for (int k = 0; k < 3; ++k)
                corners[static_cast<std::size_t>(k)] =
                    matrix * glm::dvec4(geometry.positions[triangle[k]], 1);
            const glm::dvec3 sum = corners[0] + corners[1] + corners[2];
            if (std::isfinite(sum.x + sum.y + sum.z)) use(placed, corners);
        }
        first = end;
    }
}

/// Empty too where it reaches so far that the sheet around it could leave the range of coordinates, ±1e15.
math::Bounds bounds_of_triangles(std::span<const PlacedGeometry> geometries) {
    constexpr double kFarthest = 4e14;
    math::Bounds bounds;
    for_each_triangle(geometries, glm::dmat4(1), [&](const PlacedGeometry&, const Corners& corners) {
        for (const glm::dvec3& corner : corners) bounds.add(corner);
    });
    const auto is_near = [](const glm::dvec3& point) {
        return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) < kFarthest;
    };
    return is_near(bounds.min) && is_near(bounds.max) ? bounds : math::Bounds();
}

/// A grid of squares on the ground, with a margin around what stands there.
struct Grid {
    int width = 0, depth = 0;  ///< squares along x and z
    double side = 0;           ///< of a square
    glm::dvec2 low{0};         ///< the corner, x and z
    double margin = 0;
};

Grid grid_around(const math::Bounds& bounds) {
    constexpr double kSquares = 40'000;
    constexpr int kMaxSquares = 1024;  // along a side
    const glm::dvec3 size = bounds.max - bounds.min;
    const double widest = std::max(size.x, size.z);
    Grid grid;
    grid.margin = std::clamp(0.25 * size.y, 0.05 * widest, std::max(0.5 * widest, 0.05 * size.y));
    const double width = size.x + 2 * grid.margin, depth = size.z + 2 * grid.margin;
    grid.side = std::max(std::sqrt(width) * std::sqrt(depth) / std::sqrt(kSquares),
                         std::max(width, depth) / kMaxSquares);
    const auto squares = [&](double length) {
        constexpr double kRounding = 1e-6;
        return std::clamp(static_cast<int>(std::ceil(length / grid.side - kRounding)), 3, kMaxSquares);
    };
    grid.width = squares(width);
    grid.depth = squares(depth);
    const glm::dvec3 center = bounds.center();
    grid.low = glm::dvec2(center.x, center.z) - grid.side / 2 * glm::dvec2(grid.width, grid.depth);
    return grid;
}

/// For each square of a grid the lowest and the highest point over it, above the ground, in squares' sides.
class ColumnMap {
public:
    explicit ColumnMap(const Grid& grid)
        : width_(grid.width),
          depth_(grid.depth),
          lowest_(squares(), std::numeric_limits<float>::infinity()),
          highest_(squares(), -std::numeric_limits<float>::infinity()) {}

    std::size_t squares() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(depth_);
    }

    /// Of corners in squares' sides from the grid's low corner and the ground.
    void add(const Corners& corners) {
        if (points_left_ < 0) return;
        std::size_t longest = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (steps(corners[k], corners[(k + 1) % 3]) > steps(corners[longest], corners[(longest + 1) % 3]))
                longest = k;
        const glm::dvec3 &a = corners[longest], &b = corners[(longest + 1) % 3],
                         &c = corners[(longest + 2) % 3];
        add_line(a, b);
        add_line(b, c);
        add_line(c, a);
        if (steps(a, b) == 1) return;
        const double doubled_area = std::abs((b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x));
        const double rows = std::ceil(kPointsPerSide * doubled_area / length(a, b));
        for (double row = 1; row < rows; ++row)
            add_line(glm::mix(a, c, row / rows), glm::mix(b, c, row / rows));
    }

    /// 1 in the squares whose columns have something between two heights, else 0.
    std::vector<float> section(double low, double high) const {
        std::vector<float> section(squares());
        for (std::size_t i = 0; i < section.size(); ++i)
            section[i] = lowest_[i] <= high && highest_[i] >= low ? 1.0F : 0.0F;
        return section;
    }

private:
    // Points 2/3 of a side apart, along and across, miss no square.
    static constexpr double kPointsPerSide = 1.5;

    /// On the ground: along x or z, whichever is more.
    static double length(const glm::dvec3& a, const glm::dvec3& b) {
        return std::max(std::abs(b.x - a.x), std::abs(b.z - a.z));
    }
    static double steps(const glm::dvec3& a, const glm::dvec3& b) {
        return std::max(1.0, std::ceil(kPointsPerSide * length(a, b)));
    }
    /// Without its end.
    void add_line(const glm::dvec3& a, const glm::dvec3& b) {
        const double parts = steps(a, b);
        points_left_ -= parts;
        const glm::dvec3 step = (b - a) / parts;
        for (double i = 0; i < parts; ++i) add_point(a + i * step);
    }
    void add_point(const glm::dvec3& point) {
        const int x = std::clamp(static_cast<int>(point.x), 0, width_ - 1),
                  z = std::clamp(static_cast<int>(point.z), 0, depth_ - 1);
        const auto i =
            static_cast<std::size_t>(z) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
        const auto height = static_cast<float>(point.y);
        lowest_[i] = std::min(lowest_[i], height);
        highest_[i] = std::max(highest_[i], height);
    }

    int width_, depth_;
    double points_left_ = 5e7;
    std::vector<float> lowest_, highest_;
};

/// Replaces each value of a row by the mean of those up to `radius` away; beyond the row they are 0.
void blur_row(float* values, std::size_t count, std::size_t stride, std::size_t radius,
              std::vector<double>& sums) {
    sums.resize(count + 1);
    for (std::size_t i = 0; i < count; ++i) sums[i + 1] = sums[i] + double{values[i * stride]};
    for (std::size_t i = 0; i < count; ++i)
        values[i * stride] =
            static_cast<float>((sums[std::min(i + radius + 1, count)] - sums[i - std::min(i, radius)]) /
                               static_cast<double>(2 * radius + 1));
}

/// Three box filters along each axis: nearly a Gaussian, with σ² = radius (radius + 1).
void blur(std::vector<float>& values, const Grid& grid, std::size_t radius) {
    const auto width = static_cast<std::size_t>(grid.width), depth = static_cast<std::size_t>(grid.depth);
    std::vector<double> sums;
    for (int pass = 0; pass < 3; ++pass) {
        for (std::size_t z = 0; z < depth; ++z) blur_row(&values[z * width], width, 1, radius, sums);
        for (std::size_t x = 0; x < width; ++x) blur_row(&values[x], depth, width, radius, sums);
    }
}

/// For each square how much of the sky is blocked, 0 to 1; see contact_shadow(). `height`: of all, in
/// squares' sides.
std::vector<float> sky_occlusion(const ColumnMap& columns, const Grid& grid, double height) {
    // A horizontal sheet at height h blocks h² / (π (r² + h²)²) of the sky for each unit of area at distance
    // r. Half of that lies within r = h, and half of a Gaussian within 1.18 σ.
    constexpr double kSigmaOfHeight = 0.85, kFalloff = 1.5;
    std::vector<float> most(columns.squares());
    const auto largest = static_cast<std::size_t>(std::max(grid.width, grid.depth));
    double low = 0;
    for (std::size_t radius = 1; low <= height && radius < largest;
         radius += std::max<std::size_t>(1, radius / 2)) {
        const double high = (static_cast<double>(radius) + 0.5) / kSigmaOfHeight;
        const double weight = std::exp(-kFalloff * low / height);
        std::vector<float> section = columns.section(low, high);
        blur(section, grid, radius);
        for (std::size_t i = 0; i < most.size(); ++i)
            most[i] = std::max(most[i], static_cast<float>(weight) * section[i]);
        low = high;
    }
    return most;
}

/// From 0 in the first and the last square of a row to 1 where the margin ends.
double fade(int square, int count, double margin) {
    const double t = std::clamp(std::min(square, count - 1 - square) / margin, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

scene::Image shadow_image(const std::vector<float>& occlusion, const Grid& grid) {
    constexpr double kDarkest = 0.6;
    scene::Image image;
    image.resize(grid.width, grid.depth);
    const double margin = std::max(1.0, grid.margin / grid.side);
    std::size_t i = 0;
    for (int z = 0; z < grid.depth; ++z)
        for (int x = 0; x < grid.width; ++x, ++i) {
            const double alpha = kDarkest * std::min(1.0, double{occlusion[i]}) *
                                 fade(x, grid.width, margin) * fade(z, grid.depth, margin);
            image.rgba[4 * i + 3] = static_cast<std::uint8_t>(std::lround(255 * alpha));
        }
    return image;
}

}  // namespace

std::optional<ContactShadow> contact_shadow(std::span<const PlacedGeometry> geometries) {
    constexpr double kLeastHeight = 1e-30;
    const math::Bounds bounds = bounds_of_triangles(geometries);
    const glm::dvec3 size = bounds.max - bounds.min;
    if (bounds.empty() || !(size.y > kLeastHeight)) return std::nullopt;
    const Grid grid = grid_around(bounds);
    glm::dmat4 squares_from_world(1 / grid.side);
    squares_from_world[3] = {-glm::dvec3(grid.low.x, bounds.min.y, grid.low.y) / grid.side, 1};
    ColumnMap columns(grid);
    for_each_triangle(geometries, squares_from_world,
                      [&](const PlacedGeometry& placed, const Corners& corners) {
                          if (placed.casts_shadow) columns.add(corners);
                      });
    // Just below the ground, so that flat undersides are not at its depth.
    const double y = bounds.min.y - 1e-4 * std::max({size.x, size.y, size.z});
    const glm::dvec2 high = grid.low + grid.side * glm::dvec2(grid.width, grid.depth);
    return ContactShadow{{grid.low.x, y, grid.low.y},
                         {high.x, y, high.y},
                         shadow_image(sky_occlusion(columns, grid, size.y / grid.side), grid)};
}

}  // namespace vrut::io
