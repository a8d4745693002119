#include "mesh/triangulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "mesh/edge_rows.hpp"

namespace vrut::mesh {

namespace {

/// A number as the sum of doubles that do not overlap, smaller ones first (J. Shewchuk, "Adaptive Precision
/// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997).
class ExactSum {
public:
    void add(double value) {
        for (std::size_t i = 0; i < size_; ++i) {
            const double sum = value + parts_[i], part = sum - value;
            parts_[i] = (value - (sum - part)) + (parts_[i] - part);
            value = sum;
        }
        parts_[size_++] = value;
    }
    void add_product(double a, double b) {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }
    /// Nearly its value; its sign is exact.
    double value() const {
        for (std::size_t i = size_; i-- > 0;)
            if (parts_[i] != 0) return parts_[i];
        return 0;
    }

private:
    std::array<double, 12> parts_{};
    std::size_t size_ = 0;
};

/// Twice the area of a triangle; above 0 if it is counter-clockwise, and 0 if it is straight. The sign is
/// exact: else a point on an edge could be on neither side of it.
double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const double left = (b.x - a.x) * (c.y - a.y), right = (c.x - a.x) * (b.y - a.y);
    constexpr double kMostRounding = 2 * std::numeric_limits<double>::epsilon();  // 1.5 and a bit would do
    if (std::abs(left - right) >= kMostRounding * (std::abs(left) + std::abs(right))) return left - right;
    ExactSum sum;
    for (const auto& [p, q] : {std::pair(&a, &b), std::pair(&b, &c), std::pair(&c, &a)}) {
        sum.add_product(p->x, q->y);
        sum.add_product(-p->y, q->x);
    }
    return sum.value();
}

/// The polygon in the plane of two axes, counter-clockwise, by the area vector of M. Newell (1972).
std::vector<glm::dvec2> projected(const std::vector<glm::dvec3>& corners) {
    glm::dvec3 normal(0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        normal += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    const glm::dvec3 size = glm::abs(normal);
    const int drop = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    int first = (drop + 1) % 3, second = (drop + 2) % 3;
    if (normal[drop] < 0) std::swap(first, second);
    std::vector<glm::dvec2> flat;
    flat.reserve(corners.size());
    for (const glm::dvec3& corner : corners) flat.emplace_back(corner[first], corner[second]);
    return flat;
}

/// Points of a plane by cells, about one for each point, in the proportions of all.
class PointGrid {
public:
    explicit PointGrid(const std::vector<glm::dvec2>& points) : points_(points), min_(points[0]) {
        glm::dvec2 max = min_;
        for (const glm::dvec2& point : points) {
            min_ = glm::min(min_, point);
            max = glm::max(max, point);
        }
        side_ = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(points.size()))));
        const glm::dvec2 extent = max - min_;
        cells_per_unit_ = {extent.x > 0 ? side_ / extent.x : 0, extent.y > 0 ? side_ / extent.y : 0};
        cells_.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
    }
    void add(unsigned point) { cell(cell_of(points_[point])).push_back(point); }

    /// True if `test` is for one of the points in the cells of a box.
    template <class Test>
    bool any_of(const glm::dvec2& min, const glm::dvec2& max, Test test) const {
        const glm::ivec2 first = cell_of(min), last = cell_of(max);
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const auto& points = cells_[index_of({x, y})];
                if (std::any_of(points.begin(), points.end(), test)) return true;
            }
        return false;
    }

private:
    glm::ivec2 cell_of(const glm::dvec2& point) const {
        return glm::clamp(glm::ivec2((point - min_) * cells_per_unit_), 0, side_ - 1);
    }
    std::size_t index_of(const glm::ivec2& at) const {
        return static_cast<std::size_t>(at.y) * static_cast<std::size_t>(side_) +
               static_cast<std::size_t>(at.x);
    }
    std::vector<unsigned>& cell(const glm::ivec2& at) { return cells_[index_of(at)]; }

    const std::vector<glm::dvec2>& points_;
    glm::dvec2 min_;
    int side_ = 1;
    glm::dvec2 cells_per_unit_{0};
    std::vector<std::vector<unsigned>> cells_;
};

class EarClipping {
public:
    explicit EarClipping(std::vector<glm::dvec2> corners)
        : corners_(std::move(corners)), reflex_grid_(corners_), links_(corners_.size()) {
        const auto count = static_cast<unsigned>(corners_.size());
        for (unsigned i = 0; i < count; ++i) links_[i] = {(i + count - 1) % count, (i + 1) % count};
        for (unsigned i = 0; i < count; ++i) update(i);
        for (unsigned i = 0; i < count; ++i)
            if (links_[i].reflex) reflex_grid_.add(i);
    }

    /// Every other corner is passed over, as far as that goes: triangles grow in both directions. Where no
    /// corner is an ear, the polygon crosses itself, most often by rounding: the smallest corner goes.
    std::vector<glm::uvec3> clip(bool bridged = false) {
        triangles_.reserve(corners_.size());
        std::size_t left = corners_.size(), tried = 0, forced = 0;
        Rule rule = bridged ? Rule::touching : Rule::strict;
        for (unsigned at = 0; left >= 3;) {
            const unsigned next = links_[at].next;
            if (left == 3 || is_ear(at, rule)) {
                cut(at);
                --left;
                tried = 0;
                at = links_[next].next;
                continue;
            }
            at = next;
            if (++tried < left) continue;
            tried = 0;
            if (rule != Rule::flat) {
                rule = rule == Rule::strict ? Rule::touching : Rule::flat;
                continue;
            }
            at = cut_smallest(at);
            --left;
            if (++forced == kMostForced) rule = Rule::any;
        }
        return std::move(triangles_);
    }

private:
    struct Link {
        unsigned previous = 0, next = 0;
        bool cut = false;
        bool reflex = false;  ///< or straight
    };
    /// What an ear is: nothing touches it; others may touch its corners; it may be flat, too; any three.
    enum class Rule { strict, touching, flat, any };
    static constexpr std::size_t kMostForced = 32;  ///< each takes the time to look at all corners

    /// A convex corner stays convex whatever is cut off.
    void update(unsigned corner) {
        Link& link = links_[corner];
        link.reflex = area(corners_[link.previous], corners_[corner], corners_[link.next]) <= 0;
    }
    bool is_ear(unsigned corner, Rule rule) const {
        if (rule == Rule::any) return true;
        const Link& link = links_[corner];
        const glm::dvec2 &a = corners_[link.previous], &b = corners_[corner], &c = corners_[link.next];
        if (rule == Rule::flat ? area(a, b, c) < 0 : link.reflex) return false;
        const auto is_in_the_way = [&](unsigned other) {
            if (links_[other].cut || !links_[other].reflex) return false;
            if (other == link.previous || other == link.next) return false;
            const glm::dvec2& p = corners_[other];
            if (rule != Rule::strict && (p == a || p == b || p == c)) return false;
            return other != corner && area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
        };
        return !reflex_grid_.any_of(glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)), is_in_the_way);
    }
    void cut(unsigned corner) {
        Link& link = links_[corner];
        triangles_.emplace_back(link.previous, corner, link.next);
        link.cut = true;
        links_[link.previous].next = link.next;
        links_[link.next].previous = link.previous;
        update(link.previous);
        update(link.next);
    }

    /// Returns the corner after it.
    unsigned cut_smallest(unsigned at) {
        unsigned smallest = at;
        double least = std::numeric_limits<double>::infinity();
        unsigned corner = at;
        do {
            const Link& link = links_[corner];
            const double size =
                std::abs(area(corners_[link.previous], corners_[corner], corners_[link.next]));
            if (size < least) {
                least = size;
                smallest = corner;
            }
            corner = link.next;
        } while (corner != at);
        cut(smallest);
        return links_[smallest].next;
    }

    const std::vector<glm::dvec2> corners_;
    PointGrid reflex_grid_;
    std::vector<Link> links_;
    std::vector<glm::uvec3> triangles_;
};

/// Makes one polygon of a polygon with holes: two edges that lie on each other, a bridge, lead to each hole.
/// Corners to which bridges lead are there several times, each with an angle of its own.
class HoleBridging {
public:
    HoleBridging(std::span<const glm::dvec2> corners, std::span<const unsigned> hole_starts)
        : corners_(with_room(corners, hole_starts.size())), grid_(corners_), rows_(rows_for(corners)) {
        const auto count = static_cast<unsigned>(corners.size());
        const std::size_t most = count + 2 * hole_starts.size();
        for (auto* numbers : {&previous_, &next_, &source_}) numbers->reserve(most);
        joined_.reserve(most);
        for (std::size_t i = 0; i <= hole_starts.size(); ++i) {
            const unsigned first = i > 0 ? hole_starts[i - 1] : 0;
            const unsigned end = i < hole_starts.size() ? hole_starts[i] : count;
            for (unsigned k = first; k < end; ++k) {
                previous_.push_back(k > first ? k - 1 : end - 1);
                next_.push_back(k + 1 < end ? k + 1 : first);
                source_.push_back(k);
                joined_.push_back(i == 0);
            }
            if (i > 0 && first < end) left_corners_.push_back(left_corner(first, end));
        }
        for (unsigned k = 0; k < count; ++k) {
            grid_.add(k);
            rows_.add(k, corners_[k].y, corners_[next_[k]].y);
            slack_ = std::max({slack_, kSlack * std::abs(corners_[k].x), kSlack * std::abs(corners_[k].y)});
        }
    }

    /// The corners of the one polygon.
    std::vector<unsigned> bridge() {
        std::sort(left_corners_.begin(), left_corners_.end(), [&](unsigned a, unsigned b) {
            const glm::dvec2 &p = corners_[a], &q = corners_[b];
            return p.x != q.x ? p.x < q.x : p.y < q.y;
        });
        for (const unsigned hole : left_corners_)
            if (const std::optional<unsigned> to = bridge_end(hole)) join(*to, hole);
        std::vector<unsigned> polygon;
        polygon.reserve(source_.size());
        unsigned at = 0;
        do {
            polygon.push_back(source_[at]);
            at = next_[at];
        } while (at != 0);
        return polygon;
    }

private:
    static constexpr double kSlack = 4 * std::numeric_limits<double>::epsilon();

    static std::vector<glm::dvec2> with_room(std::span<const glm::dvec2> corners, std::size_t holes) {
        std::vector<glm::dvec2> room;
        room.reserve(corners.size() + 2 * holes);
        room.assign(corners.begin(), corners.end());
        return room;
    }
    static EdgeRows rows_for(std::span<const glm::dvec2> corners) {
        double min = corners[0].y, max = min, sum = 0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            min = std::min(min, corners[i].y);
            max = std::max(max, corners[i].y);
            if (i > 0) sum += std::abs(corners[i].y - corners[i - 1].y);
        }
        return {min, max, corners.size(), sum};
    }
    unsigned left_corner(unsigned first, unsigned end) const {
        unsigned left = first;
        for (unsigned k = first; k < end; ++k) {
            const glm::dvec2 &p = corners_[k], &q = corners_[left];
            if (p.x < q.x || (p.x == q.x && p.y < q.y)) left = k;
        }
        return left;
    }

    /// True if a line from a corner towards `point` starts within the polygon.
    bool is_locally_inside(unsigned corner, const glm::dvec2& point) const {
        const glm::dvec2 &a = corners_[previous_[corner]], &b = corners_[corner],
                         &c = corners_[next_[corner]];
        const bool left_of_first = area(a, b, point) >= 0, left_of_second = area(b, c, point) >= 0;
        return area(a, b, c) > 0 ? left_of_first && left_of_second : left_of_first || left_of_second;
    }

    /// The corner that a hole's left corner sees: in its own place, or on its left.
    std::optional<unsigned> bridge_end(unsigned hole) const {
        const glm::dvec2& p = corners_[hole];
        std::optional<unsigned> best;
        grid_.any_of(p, p, [&](unsigned corner) {
            if (joined_[corner] && corners_[corner] == p && is_locally_inside(corner, corners_[next_[hole]]))
                best = corner;
            return best.has_value();
        });
        if (best) return best;
        double x = -std::numeric_limits<double>::infinity();
        std::optional<unsigned> edge;
        for (const unsigned start : rows_.at(p.y)) {
            const glm::dvec2 &a = corners_[start], &b = corners_[next_[start]];
            if (!joined_[start] || a.y < p.y || b.y > p.y || a.y == b.y) continue;
            const double here = a.x + (b.x - a.x) * ((a.y - p.y) / (a.y - b.y));
            if (here > p.x + slack_ || here <= x) continue;
            x = here;
            edge = start;
        }
        if (!edge) return {};
        const unsigned end = corners_[*edge].x < corners_[next_[*edge]].x ? *edge : next_[*edge];
        return first_in_the_way(p, std::min(x, p.x), end);
    }

    /// Of the corners in the triangle between `p`, the point of an edge on its left, and that edge's end, the
    /// one that is seen from `p`: that of the least slope.
    unsigned first_in_the_way(const glm::dvec2& p, double x, unsigned end) const {
        const glm::dvec2 at(x, p.y), &m = corners_[end];
        const bool above = m.y > p.y;
        const glm::dvec2 &second = above ? m : at, &third = above ? at : m;
        unsigned best = end;
        double least = std::numeric_limits<double>::infinity();
        grid_.any_of(glm::min(m, at), glm::max(p, m), [&](unsigned corner) {
            const glm::dvec2& q = corners_[corner];
            if (!joined_[corner] || q.x >= p.x) return false;
            if (area(p, second, q) < 0 || area(second, third, q) < 0 || area(third, p, q) < 0) return false;
            const double slope = std::abs(q.y - p.y) / (p.x - q.x);
            if (slope > least || (slope == least && q.x <= corners_[best].x)) return false;
            if (!is_locally_inside(corner, p)) return false;
            best = corner;
            least = slope;
            return false;
        });
        return best;
    }

    /// The given corners keep the edges that start in them.
    void join(unsigned to, unsigned hole) {
        for (unsigned k = hole; !joined_[k]; k = next_[k]) joined_[k] = true;
        const unsigned before = previous_[to], last = previous_[hole];
        const unsigned there = copy(to), back = copy(hole);
        link(before, there);
        link(there, hole);
        link(last, back);
        link(back, to);
        rows_.add(there, corners_[there].y, corners_[hole].y);
        rows_.add(back, corners_[back].y, corners_[to].y);
    }
    unsigned copy(unsigned corner) {
        const auto number = static_cast<unsigned>(corners_.size());
        corners_.push_back(glm::dvec2(corners_[corner]));
        previous_.push_back(0);
        next_.push_back(0);
        source_.push_back(source_[corner]);
        joined_.push_back(true);
        grid_.add(number);
        return number;
    }
    void link(unsigned a, unsigned b) {
        next_[a] = b;
        previous_[b] = a;
    }

    std::vector<glm::dvec2> corners_;
    PointGrid grid_;
    EdgeRows rows_;  ///< by their first corners
    std::vector<unsigned> previous_, next_, source_, left_corners_;
    std::vector<bool> joined_;  ///< with the outer loop
    double slack_ = 0;
};

}  // namespace

std::vector<glm::uvec3> triangulate(const std::vector<glm::dvec3>& corners) {
    return EarClipping(projected(corners)).clip();
}

std::vector<glm::uvec3> triangulate(std::span<const glm::dvec2> corners,
                                    std::span<const unsigned> hole_starts) {
    if (corners.size() < 3 || (!hole_starts.empty() && hole_starts[0] < 3)) return {};
    if (hole_starts.empty()) return EarClipping({corners.begin(), corners.end()}).clip();
    const std::vector<unsigned> polygon = HoleBridging(corners, hole_starts).bridge();
    std::vector<glm::dvec2> points;
    points.reserve(polygon.size());
    for (const unsigned corner : polygon) points.push_back(corners[corner]);
    std::vector<glm::uvec3> triangles = EarClipping(std::move(points)).clip(true);
    for (glm::uvec3& t : triangles) t = {polygon[t.x], polygon[t.y], polygon[t.z]};
    return triangles;
}

}  // namespace vrut::mesh
