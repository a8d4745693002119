#include "mesh/self_intersection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "math/bounds.hpp"

namespace vrut::mesh {

namespace {

/// Of the radius: what lies closer together touches.
constexpr double kTouching = 1e-10;
/// Of the largest coordinate: what rounding to double may have moved together, or through each other.
constexpr double kCoordinateRounding = 4 * std::numeric_limits<double>::epsilon();
/// Squared sine of the angle between two neighbours that lie folded on each other.
constexpr double kFolded = 1e-18;
/// So few triangles are compared pair by pair.
constexpr std::size_t kLeaf = 16;
/// Boxes sorted and pairs compared for each triangle, and besides: what takes more counts as crossing. An
/// ordinary surface of a million triangles takes less than a tenth.
constexpr std::uint64_t kBudgetPerTriangle = 512, kBudget = std::uint64_t{1} << 20;

struct Triangle {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 normal;  ///< unit; zero without area

    double distance(const glm::dvec3& point) const { return glm::dot(normal, point - corners[0]); }
    bool holds(const glm::dvec3& point_on_plane, double touching) const {
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
            const double beside = glm::dot(glm::cross(edge, point_on_plane - corners[i]), normal);
            if (beside < -touching * glm::length(edge)) return false;
        }
        return true;
    }
    bool has_area() const { return normal != glm::dvec3(0); }
};

Triangle triangle_of(std::span<const glm::dvec3> positions, const glm::uvec3& t) {
    Triangle triangle{{positions[t.x], positions[t.y], positions[t.z]}, glm::dvec3(0)};
    const glm::dvec3 cross =
        glm::cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
    if (const double length = glm::length(cross); length > 0) triangle.normal = cross / length;
    return triangle;
}

/// Returns true if a segment goes from one side of a triangle to the other. Both ends in its plane are on one
/// side.
bool pierces(const glm::dvec3& p, const glm::dvec3& q, const Triangle& triangle, double touching) {
    const double at_p = triangle.distance(p), at_q = triangle.distance(q);
    if ((at_p >= -touching) == (at_q >= -touching)) return false;
    return triangle.holds(glm::mix(p, q, std::clamp(at_p / (at_p - at_q), 0.0, 1.0)), touching);
}

/// Returns true if two triangles in one plane share more than their border (separating axes).
bool overlap_in_plane(const Triangle& a, const Triangle& b, double touching) {
    for (const glm::dvec3& corner : b.corners)
        if (std::abs(a.distance(corner)) > touching) return false;
    for (const Triangle* from : {&a, &b})
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 axis =
                glm::normalize(glm::cross(a.normal, from->corners[(i + 1) % 3] - from->corners[i]));
            const auto extent = [&](const Triangle& triangle) {
                const auto [low, high] =
                    std::minmax({glm::dot(axis, triangle.corners[0]), glm::dot(axis, triangle.corners[1]),
                                 glm::dot(axis, triangle.corners[2])});
                return std::pair(low, high);
            };
            const auto [low_a, high_a] = extent(a);
            const auto [low_b, high_b] = extent(b);
            if (high_a - low_b <= touching || high_b - low_a <= touching) return false;
        }
    return true;
}

/// Of two triangles with a common edge, given by their third corners.
bool is_folded(const glm::dvec3& start, const glm::dvec3& end, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 edge = glm::normalize(end - start);
    const auto across = [&](const glm::dvec3& corner) {
        return (corner - start) - edge * glm::dot(edge, corner - start);
    };
    const glm::dvec3 u = across(a), v = across(b), cross = glm::cross(u, v);
    return glm::dot(u, v) > 0 && glm::dot(cross, cross) <= kFolded * glm::dot(u, u) * glm::dot(v, v);
}

class SelfIntersectionSearch {
public:
    SelfIntersectionSearch(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                           std::span<const unsigned> components, const std::atomic<bool>& stop)
        : positions_(positions), triangles_(triangles), components_(components), stop_(stop) {
        math::Bounds bounds;
        boxes_.reserve(triangles.size());
        for (const glm::uvec3& t : triangles) {
            math::Bounds& box = boxes_.emplace_back();
            for (int k = 0; k < 3; ++k) box.add(positions[t[k]]);
            bounds.add(box);
        }
        const glm::dvec3 farthest = glm::max(glm::abs(bounds.min), glm::abs(bounds.max));
        touching_ = std::max(kTouching * bounds.radius(),
                             kCoordinateRounding * std::max({farthest.x, farthest.y, farthest.z}));
        budget_ = kBudgetPerTriangle * triangles.size() + kBudget;
    }

    bool found() {
        std::vector<std::vector<unsigned>> waiting(1);
        waiting[0].resize(triangles_.size());
        std::iota(waiting[0].begin(), waiting[0].end(), 0U);
        while (!waiting.empty()) {
            std::vector<unsigned> numbers = std::move(waiting.back());
            waiting.pop_back();
            if (stop_ || !spend(numbers.size())) return true;
            auto [low, high] = halves(numbers);
            const bool divided = std::max(low.size(), high.size()) < numbers.size();
            if (!divided && search_pairs(numbers)) return true;
            if (!divided) continue;
            waiting.push_back(std::move(high));
            waiting.push_back(std::move(low));
        }
        return false;
    }

private:
    /// Those on either side of a plane, and those on it in both; none of few.
    std::pair<std::vector<unsigned>, std::vector<unsigned>> halves(std::vector<unsigned>& numbers) const {
        if (numbers.size() <= kLeaf) return {numbers, {}};
        math::Bounds centers;
        for (const unsigned number : numbers) centers.add(boxes_[number].center());
        const glm::dvec3 spread = centers.max - centers.min;
        const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
        const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
        std::nth_element(numbers.begin(), middle, numbers.end(), [&](unsigned a, unsigned b) {
            return boxes_[a].center()[axis] < boxes_[b].center()[axis];
        });
        const double plane = boxes_[*middle].center()[axis];
        std::vector<unsigned> low, high;
        for (const unsigned number : numbers) {
            if (boxes_[number].min[axis] <= plane + touching_) low.push_back(number);
            if (boxes_[number].max[axis] >= plane - touching_) high.push_back(number);
        }
        return {std::move(low), std::move(high)};
    }

    bool search_pairs(const std::vector<unsigned>& numbers) {
        if (!spend(numbers.size() * numbers.size() / 2)) return true;
        for (std::size_t i = 0; i < numbers.size(); ++i)
            for (std::size_t k = i + 1; k < numbers.size(); ++k)
                if (cross(numbers[i], numbers[k])) return true;
        return false;
    }

    bool cross(unsigned first, unsigned second) const {
        if (components_[first] != components_[second]) return false;
        const math::Bounds &box = boxes_[first], &other = boxes_[second];
        if (glm::any(glm::greaterThan(box.min, other.max + touching_)) ||
            glm::any(glm::greaterThan(other.min, box.max + touching_)))
            return false;
        glm::uvec3 a = triangles_[first], b = triangles_[second];
        const Triangle mine = triangle_of(positions_, a), others = triangle_of(positions_, b);
        // Their neighbours cover what has no area.
        if (!mine.has_area() || !others.has_area()) return false;
        const int shared = shared_corners_first(a, b);
        const auto at = [&](unsigned number) { return positions_[number]; };
        if (shared == 3) return true;
        if (shared == 2) return is_folded(at(a.x), at(a.y), at(a.z), at(b.z));
        // Where one corner is shared, the line in which they cross ends on an edge that does not have it.
        for (int i = 0; i < 3; ++i) {
            if (shared == 1 && i != 1) continue;
            const int next = (i + 1) % 3;
            if (pierces(at(a[i]), at(a[next]), others, touching_) ||
                pierces(at(b[i]), at(b[next]), mine, touching_))
                return true;
        }
        return overlap_in_plane(mine, others, touching_);
    }

    /// Reorders the corners so that both have the shared ones first; returns how many these are.
    static int shared_corners_first(glm::uvec3& a, glm::uvec3& b) {
        int shared = 0;
        for (int i = 0; i < 3; ++i)
            for (int k = shared; k < 3; ++k)
                if (a[i] == b[k]) {
                    std::swap(a[i], a[shared]);
                    std::swap(b[k], b[shared]);
                    ++shared;
                    break;
                }
        return shared;
    }

    bool spend(std::uint64_t steps) {
        if (steps > budget_) return false;
        budget_ -= steps;
        return true;
    }

    std::span<const glm::dvec3> positions_;
    std::span<const glm::uvec3> triangles_;
    std::span<const unsigned> components_;
    const std::atomic<bool>& stop_;
    std::vector<math::Bounds> boxes_;  // one for each triangle
    double touching_ = 0;
    std::uint64_t budget_ = 0;
};

}  // namespace

bool may_self_intersect(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                        std::span<const unsigned> components, const std::atomic<bool>& stop) {
    return SelfIntersectionSearch(positions, triangles, components, stop).found();
}

}  // namespace vrut::mesh
