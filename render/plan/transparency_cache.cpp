#include "plan/transparency_cache.hpp"

#include <cmath>
#include <limits>

namespace vrut::plan {

namespace {

constexpr std::int64_t kBox = 20;  ///< of the smallest geometry, in units of DrawBudget

glm::dvec3 doubled_area(const scene::Geometry& geometry, const glm::uvec3& triangle) {
    const glm::dvec3& a = geometry.positions[triangle[0]];
    return glm::cross(geometry.positions[triangle[1]] - a, geometry.positions[triangle[2]] - a);
}

/// Mean direction of the faces by area, all turned like the largest; along y where there is none.
glm::dvec3 sheet_normal(const scene::Geometry& geometry) {
    glm::dvec3 largest(0), sum(0);
    for (const glm::uvec3& triangle : geometry.triangles)
        if (const glm::dvec3 area = doubled_area(geometry, triangle);
            glm::length(area) > glm::length(largest))
            largest = area;
    for (const glm::uvec3& triangle : geometry.triangles) {
        const glm::dvec3 area = doubled_area(geometry, triangle);
        sum += glm::dot(area, largest) < 0 ? -area : area;
    }
    const double length = glm::length(sum);
    return length > 0 && std::isfinite(length) ? sum / length : glm::dvec3(0, 1, 0);
}

/// At right angles to `normal`, along the way from the box's centre to the point that is furthest that way.
glm::dvec3 long_side(const scene::Geometry& geometry, const glm::dvec3& normal) {
    const glm::dvec3 center = geometry.bounds.center();
    glm::dvec3 longest(0);
    for (const glm::dvec3& position : geometry.positions) {
        const glm::dvec3 out = position - center, flat = out - glm::dot(out, normal) * normal;
        if (glm::length(flat) > glm::length(longest)) longest = flat;
    }
    if (!(glm::length(longest) > 0))
        longest = glm::cross(normal, std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
    return glm::normalize(longest);
}

OrientedBox box_along(const scene::Geometry& geometry, const std::array<glm::dvec3, 3>& directions) {
    const glm::dvec3 origin = geometry.bounds.center();
    OrientedBox box{origin, {}};
    for (std::size_t k = 0; k < 3; ++k) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const glm::dvec3& position : geometry.positions) {
            const double along = glm::dot(position - origin, directions[k]);
            low = std::min(low, along);
            high = std::max(high, along);
        }
        box.center += directions[k] * ((low + high) / 2);
        box.axes[k] = directions[k] * ((high - low) / 2);
    }
    return box;
}

double thinnest(const OrientedBox& box) {
    return std::min({glm::length(box.axes[0]), glm::length(box.axes[1]), glm::length(box.axes[2])});
}

}  // namespace

OrientedBox oriented_box(const scene::Geometry& geometry) {
    const OrientedBox upright =
        box_along(geometry, {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)});
    const glm::dvec3 normal = sheet_normal(geometry), side = long_side(geometry, normal);
    const OrientedBox turned = box_along(geometry, {normal, side, glm::cross(normal, side)});
    return thinnest(turned) < thinnest(upright) ? turned : upright;
}

OrientedBox transformed(const glm::dmat4& matrix, const OrientedBox& box) {
    OrientedBox result{glm::dvec3(matrix * glm::dvec4(box.center, 1)), {}};
    for (std::size_t k = 0; k < 3; ++k) result.axes[k] = glm::dmat3(matrix) * box.axes[k];
    return result;
}

std::int64_t TransparencyCache::find(const DrawItem& item) {
    const CacheEntry& shape = entries_[static_cast<std::size_t>(item.geometry)];
    const scene::Geometry& read = geometry(item.geometry);
    std::int64_t work = 1;
    if (!shape.box) work += kBox + static_cast<std::int64_t>(read.positions.size() + read.triangles.size());
    box(item.geometry);
    if (is_flattened(item.view_from_node)) return work;  // no order is asked for
    const std::size_t side_count = item.cull_mode == CullMode::none ? 2 : 1,
                      count = side_count * read.triangles.size();
    if (!shape.orders[side_count - 1] && count <= kMaxOrderedTriangles)
        work += static_cast<std::int64_t>(count * count);
    order(item.geometry, item.cull_mode);
    return work;
}

const OrientedBox& TransparencyCache::box(scene::Index index) {
    std::optional<OrientedBox>& box = entries_[static_cast<std::size_t>(index)].box;
    if (!box) box = oriented_box(geometry(index));
    return *box;
}

const TriangleOrder& TransparencyCache::order(scene::Index index, CullMode cull_mode) {
    std::optional<TriangleOrder>& order =
        entries_[static_cast<std::size_t>(index)].orders[cull_mode == CullMode::none ? 1 : 0];
    if (!order) order = order_triangles(geometry(index), cull_mode);
    return *order;
}

}  // namespace vrut::plan
