#include "mesh/triangulation.hpp"

#include <algorithm>
#include <cmath>

namespace vrut::mesh {

namespace {

/// Twice the area of a triangle; above 0 if it is counter-clockwise.
double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
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

/// Points of a plane by square cells, about one for each point.
class PointGrid {
public:
    explicit PointGrid(const std::vector<glm::dvec2>& points) : points_(points), min_(points[0]) {
        glm::dvec2 max = min_;
        for (const glm::dvec2& point : points) {
            min_ = glm::min(min_, point);
            max = glm::max(max, point);
        }
        side_ = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(points.size()))));
        const double extent = std::max(max.x - min_.x, max.y - min_.y);
        cells_per_unit_ = extent > 0 ? side_ / extent : 0;
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
    double cells_per_unit_ = 0;
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

    /// Every other corner is passed over, as far as that goes: triangles grow in both directions.
    std::vector<glm::uvec3> clip() {
        std::size_t left = corners_.size(), tried = 0;
        Rule rule = Rule::strict;
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
            rule = rule == Rule::strict ? Rule::touching : Rule::any;
            tried = 0;
        }
        return std::move(triangles_);
    }

private:
    struct Link {
        unsigned previous = 0, next = 0;
        bool cut = false;
        bool reflex = false;  ///< or straight
    };
    /// What an ear is: nothing touches it; others may touch its corners, and it may be flat; any three.
    enum class Rule { strict, touching, any };

    /// A convex corner stays convex whatever is cut off.
    void update(unsigned corner) {
        Link& link = links_[corner];
        link.reflex = area(corners_[link.previous], corners_[corner], corners_[link.next]) <= 0;
    }
    bool is_ear(unsigned corner, Rule rule) const {
        if (rule == Rule::any) return true;
        const Link& link = links_[corner];
        const glm::dvec2 &a = corners_[link.previous], &b = corners_[corner], &c = corners_[link.next];
        if (rule == Rule::strict ? link.reflex : area(a, b, c) < 0) return false;
        const auto is_in_the_way = [&](unsigned other) {
            if (links_[other].cut || !links_[other].reflex) return false;
            if (other == link.previous || other == link.next) return false;
            const glm::dvec2& p = corners_[other];
            if (rule == Rule::touching && (p == a || p == b || p == c)) return false;
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

    const std::vector<glm::dvec2> corners_;
    PointGrid reflex_grid_;
    std::vector<Link> links_;
    std::vector<glm::uvec3> triangles_;
};

}  // namespace

std::vector<glm::uvec3> triangulate(const std::vector<glm::dvec3>& corners) {
    return EarClipping(projected(corners)).clip();
}

}  // namespace vrut::mesh
