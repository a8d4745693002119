#include "mesh/cut.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>

#include "mesh/edge_rows.hpp"
#include "mesh/triangulation.hpp"
#include "mesh/union_find.hpp"

namespace vrut::mesh {

namespace {

/// Squares and sums of coordinates stay finite below it.
constexpr double kMostCoordinate = 1e150;

/// Heights are above the plane where things are kept. They keep their digits far from the origin.
struct CuttingPlane {
    glm::dvec3 normal, center;
    double center_height;

    double height(const glm::dvec3& position) const {
        return glm::dot(normal, position - center) + center_height;
    }
};

std::optional<CuttingPlane> cutting_plane(const scene::Geometry& geometry, const glm::dvec4& equation) {
    const glm::dvec4 size = glm::abs(equation);
    const double largest = std::max({size.x, size.y, size.z});
    if (!(largest > 0 && largest + size.w < std::numeric_limits<double>::infinity())) return {};
    const glm::dvec3 scaled = glm::dvec3(equation) / largest;
    const double length = glm::length(scaled);
    glm::dvec3 center = geometry.bounds.empty() ? glm::dvec3(0) : geometry.bounds.center();
    if (!(glm::length(center) < kMostCoordinate)) center = glm::dvec3(0);
    const glm::dvec3 normal = scaled / length;
    const double center_height = glm::dot(normal, center) + equation.w / largest / length;
    if (!std::isfinite(center_height)) return {};
    return CuttingPlane{normal, center, center_height};
}

/// Where a corner is. Of a triangle that is crossed they add up to 1 or 2.
enum Side : std::uint8_t { kCutAway = 0, kKept = 1, kNotFinite = 4 };

/// The plane by value and the pointers: a byte that is written could be any of what is reached by reference.
std::vector<std::uint8_t> sides_of(const std::vector<glm::dvec3>& positions, const CuttingPlane plane) {
    const std::size_t count = positions.size();
    std::vector<std::uint8_t> result(count);
    const glm::dvec3* const points = positions.data();
    std::uint8_t* const sides = result.data();
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 p = points[i];
        const double size = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
        const std::uint8_t side = plane.height(p) > 0 ? kKept : kCutAway;
        sides[i] = size < kMostCoordinate ? side : std::uint8_t{kNotFinite};
    }
    return result;
}

/// By its ends, the lexicographically smaller one first: the same for both of its triangles.
struct CrossedEdge {
    glm::dvec3 a, b;

    CrossedEdge(const glm::dvec3& one, const glm::dvec3& other) : a(one + 0.0), b(other + 0.0) {  // no -0
        const bool swapped = a.x != b.x ? b.x < a.x : a.y != b.y ? b.y < a.y : b.z < a.z;
        if (swapped) std::swap(a, b);
    }
    bool operator==(const CrossedEdge& other) const { return a == other.a && b == other.b; }

    glm::dvec3 point(const CuttingPlane& plane) const {
        const double from = plane.height(a), to = plane.height(b);
        const double part = std::clamp(from / (from - to), 0.0, 1.0);
        if (part <= 0.5) return a + (b - a) * part;
        return b + (a - b) * std::clamp(to / (to - from), 0.0, 1.0);
    }
};

struct CrossedEdgeHash {
    std::size_t operator()(const CrossedEdge& edge) const {
        std::uint64_t hash = 0;
        for (const glm::dvec3& end : {edge.a, edge.b})
            for (int i = 0; i < 3; ++i) {
                hash = (hash ^ std::bit_cast<std::uint64_t>(end[i])) * 0x9E3779B97F4A7C15U;
                hash ^= hash >> 29U;
            }
        return static_cast<std::size_t>(hash);
    }
};

class ContourBuilder {
public:
    ContourBuilder(const scene::Geometry& geometry, const CuttingPlane& plane)
        : geometry_(geometry), plane_(plane), sides_(sides_of(geometry.positions, plane)) {}

    /// Points without lines are left out.
    Cut build() {
        add_lines();
        UnionFind places(points_.size());
        for (const glm::uvec2& line : lines_)
            if (points_[line.x] == points_[line.y]) places.unite(line.x, line.y);
        Cut cut;
        cut.contours.reserve(lines_.size());
        cut.points.reserve(points_.size());
        std::vector<unsigned> numbers(points_.size(), kNone);
        const auto number_of = [&](unsigned point) {
            unsigned& number = numbers[places.find(point)];
            if (number == kNone) {
                number = static_cast<unsigned>(cut.points.size());
                cut.points.push_back(points_[point]);
            }
            return number;
        };
        for (const glm::uvec2& line : lines_) {
            if (places.find(line.x) == places.find(line.y)) continue;
            const unsigned start = number_of(line.x), end = number_of(line.y);
            cut.contours.emplace_back(start, end);
        }
        return cut;
    }

private:
    static constexpr unsigned kNone = ~0U;

    void add_lines() {
        std::vector<std::uint32_t> crossed;
        const std::uint8_t* const sides = sides_.data();
        const glm::uvec3* const triangles = geometry_.triangles.data();
        const auto count = static_cast<std::uint32_t>(geometry_.triangles.size());
        for (std::uint32_t i = 0; i < count; ++i) {
            const unsigned sum =
                unsigned{sides[triangles[i].x]} + sides[triangles[i].y] + sides[triangles[i].z];
            if (sum - 1U < 2U) crossed.push_back(i);
        }
        lines_.reserve(crossed.size());
        points_.reserve(crossed.size());
        numbers_.reserve(crossed.size());
        for (const std::uint32_t i : crossed) add_line(geometry_.triangles[i]);
    }
    /// To the left of it, seen from beyond the plane, is the triangle's back: the inside.
    void add_line(const glm::uvec3& t) {
        const bool one_is_kept = sides_[t.x] + sides_[t.y] + sides_[t.z] == kKept;
        int alone = 0;
        while ((sides_[t[alone]] == kKept) != one_is_kept) ++alone;
        unsigned start = point_between(t[alone], t[(alone + 2) % 3]);
        unsigned end = point_between(t[alone], t[(alone + 1) % 3]);
        if (!one_is_kept) std::swap(start, end);
        if (start != end) lines_.emplace_back(start, end);
    }
    unsigned point_between(unsigned a, unsigned b) {
        const CrossedEdge edge(geometry_.positions[a], geometry_.positions[b]);
        const auto [at, is_new] = numbers_.try_emplace(edge, static_cast<unsigned>(points_.size()));
        if (is_new) points_.push_back(edge.point(plane_));
        return at->second;
    }

    const scene::Geometry& geometry_;
    CuttingPlane plane_;
    std::vector<std::uint8_t> sides_;
    std::unordered_map<CrossedEdge, unsigned, CrossedEdgeHash> numbers_;
    std::vector<glm::dvec3> points_;
    std::vector<glm::uvec2> lines_;
};

/// Lines by the points where they start.
class OutgoingLines {
public:
    OutgoingLines(const std::vector<glm::uvec2>& lines, std::size_t point_count)
        : first_(point_count + 1), ends_(lines.size()) {
        for (const glm::uvec2& line : lines) ++first_[line.x + 1];
        for (std::size_t i = 0; i < point_count; ++i) first_[i + 1] += first_[i];
        next_ = {first_.begin(), first_.end() - 1};
        for (const glm::uvec2& line : lines) ends_[next_[line.x]++] = line.y;
        next_.assign(first_.begin(), first_.end() - 1);
    }
    /// The end of a line from `point`, once for each.
    std::optional<unsigned> take(unsigned point) {
        if (next_[point] == first_[point + 1]) return {};
        return ends_[next_[point]++];
    }

private:
    std::vector<std::size_t> first_, next_;
    std::vector<unsigned> ends_;
};

/// Each line is in one loop, or in none; no loop passes a point twice.
std::vector<std::vector<unsigned>> closed_loops(const Cut& cut) {
    OutgoingLines lines(cut.contours, cut.points.size());
    std::vector<std::vector<unsigned>> loops;
    std::vector<unsigned> path;
    std::vector<std::size_t> place(cut.points.size());  // on the path, from 1
    for (const glm::uvec2& first : cut.contours) {
        path.assign(1, first.x);
        place[first.x] = 1;
        while (!path.empty()) {
            const std::optional<unsigned> next = lines.take(path.back());
            if (!next) {
                place[path.back()] = 0;
                path.pop_back();
            } else if (const std::size_t closes = place[*next]; closes > 0) {
                loops.emplace_back(path.begin() + static_cast<std::ptrdiff_t>(closes - 1), path.end());
                for (std::size_t i = closes; i < path.size(); ++i) place[path[i]] = 0;
                path.resize(closes);
            } else {
                path.push_back(*next);
                place[*next] = path.size();
            }
        }
    }
    return loops;
}

/// The plane in two of its axes, so that what is counter-clockwise seen from beyond is so in x and y.
std::vector<glm::dvec2> seen_from_beyond(const Cut& cut, const glm::dvec3& kept_normal) {
    const glm::dvec3 size = glm::abs(kept_normal);
    const int drop = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    int first = (drop + 1) % 3, second = (drop + 2) % 3;
    if (kept_normal[drop] > 0) std::swap(first, second);
    std::vector<glm::dvec2> flat;
    flat.reserve(cut.points.size());
    for (const glm::dvec3& point : cut.points) flat.emplace_back(point[first], point[second]);
    return flat;
}

struct ContourLoop {
    std::vector<unsigned> points;
    double area = 0;  ///< twice it; below 0 of a hole
    glm::dvec2 min{0}, max{0};
    glm::dvec2 longest_middle{0};      ///< of its longest side
    std::vector<std::size_t> holes{};  ///< within it and no smaller loop

    bool is_around(const ContourLoop& hole) const {
        return area > -hole.area && min.x <= hole.min.x && min.y <= hole.min.y && max.x >= hole.max.x &&
               max.y >= hole.max.y;
    }
};

ContourLoop contour_loop(std::vector<unsigned> points, const std::vector<glm::dvec2>& flat) {
    ContourLoop loop{.points = std::move(points)};
    const glm::dvec2 origin = loop.min = loop.max = flat[loop.points[0]];
    double longest = -1;
    for (std::size_t i = 0; i < loop.points.size(); ++i) {
        const glm::dvec2 &p = flat[loop.points[i]], &q = flat[loop.points[(i + 1) % loop.points.size()]];
        const glm::dvec2 from = p - origin, to = q - origin, side = q - p;
        loop.area += from.x * to.y - from.y * to.x;
        loop.min = glm::min(loop.min, p);
        loop.max = glm::max(loop.max, p);
        const double length = glm::dot(side, side);
        if (length <= longest) continue;
        longest = length;
        loop.longest_middle = p + side / 2.0;
    }
    return loop;
}

/// The triangles between closed loops.
class CapBuilder {
public:
    CapBuilder(const Cut& cut, const glm::dvec3& kept_normal) : flat_(seen_from_beyond(cut, kept_normal)) {
        for (std::vector<unsigned>& points : closed_loops(cut))
            if (points.size() >= 3) loops_.push_back(contour_loop(std::move(points), flat_));
    }

    std::vector<glm::uvec3> build() {
        place_holes();
        for (const ContourLoop& loop : loops_)
            if (loop.area > 0) add_triangles(loop);
        return std::move(triangles_);
    }

private:
    struct LoopSide {
        glm::dvec2 start, end;
        std::size_t loop;
    };

    /// A hole that no loop is around is left out.
    void place_holes() {
        if (std::none_of(loops_.begin(), loops_.end(), [](const auto& loop) { return loop.area < 0; }))
            return;
        std::vector<LoopSide> sides;
        sides.reserve(flat_.size());
        double min = std::numeric_limits<double>::infinity(), max = -min, sum = 0;
        for (std::size_t i = 0; i < loops_.size(); ++i) {
            if (!(loops_[i].area > 0)) continue;
            min = std::min(min, loops_[i].min.y);
            max = std::max(max, loops_[i].max.y);
            const std::vector<unsigned>& points = loops_[i].points;
            for (std::size_t k = 0; k < points.size(); ++k) {
                sides.push_back({flat_[points[k]], flat_[points[(k + 1) % points.size()]], i});
                sum += std::abs(sides.back().end.y - sides.back().start.y);
            }
        }
        if (sides.empty()) return;
        EdgeRows rows(min, max, sides.size(), sum);
        for (std::size_t i = 0; i < sides.size(); ++i)
            rows.add(static_cast<unsigned>(i), sides[i].start.y, sides[i].end.y);
        for (std::size_t i = 0; i < loops_.size(); ++i)
            if (loops_[i].area < 0)
                if (const auto around = loop_around(loops_[i], sides, rows))
                    loops_[*around].holes.push_back(i);
    }
    /// Of the loops around the middle of its longest side the smallest. Where solids overlap, some of these
    /// cross the hole: one that is around the most of its sides goes first.
    std::optional<std::size_t> loop_around(const ContourLoop& hole, const std::vector<LoopSide>& sides,
                                           const EdgeRows& rows) {
        around_.clear();
        add_loops_around(hole.longest_middle, hole, sides, rows);
        if (around_.empty()) return {};
        if (around_.size() > 1)
            for (std::size_t i = 0; i < hole.points.size(); ++i) {
                const unsigned next = hole.points[(i + 1) % hole.points.size()];
                add_loops_around((flat_[hole.points[i]] + flat_[next]) / 2.0, hole, sides, rows);
            }
        std::sort(around_.begin(), around_.end());
        std::size_t best = around_[0], most = 0;
        for (std::size_t i = 0, end = 0; i < around_.size(); i = end) {
            while (end < around_.size() && around_[end] == around_[i]) ++end;
            const std::size_t count = end - i;
            if (count < most || (count == most && loops_[around_[i]].area >= loops_[best].area)) continue;
            best = around_[i];
            most = count;
        }
        return best;
    }
    /// Adds the loops that have an odd number of sides to the left of a point.
    void add_loops_around(const glm::dvec2& p, const ContourLoop& hole, const std::vector<LoopSide>& sides,
                          const EdgeRows& rows) {
        crossed_.clear();
        for (const unsigned number : rows.at(p.y)) {
            const auto& [start, end, loop] = sides[number];
            if ((start.y > p.y) == (end.y > p.y) || !loops_[loop].is_around(hole)) continue;
            if (start.x + (end.x - start.x) * ((p.y - start.y) / (end.y - start.y)) < p.x)
                crossed_.push_back(loop);
        }
        std::sort(crossed_.begin(), crossed_.end());
        for (std::size_t i = 0, end = 0; i < crossed_.size(); i = end) {
            while (end < crossed_.size() && crossed_[end] == crossed_[i]) ++end;
            if ((end - i) % 2 == 1) around_.push_back(crossed_[i]);
        }
    }

    void add_triangles(const ContourLoop& outer) {
        std::vector<unsigned> points = outer.points, hole_starts;
        hole_starts.reserve(outer.holes.size());
        for (const std::size_t hole : outer.holes) {
            hole_starts.push_back(static_cast<unsigned>(points.size()));
            points.insert(points.end(), loops_[hole].points.begin(), loops_[hole].points.end());
        }
        std::vector<glm::dvec2> corners;
        corners.reserve(points.size());
        for (const unsigned point : points) corners.push_back(flat_[point]);
        for (const glm::uvec3& t : triangulate(corners, hole_starts)) {
            const glm::uvec3 u(points[t.x], points[t.y], points[t.z]);
            if (u.x != u.y && u.y != u.z && u.z != u.x) triangles_.push_back(u);
        }
    }

    std::vector<glm::dvec2> flat_;
    std::vector<ContourLoop> loops_;
    std::vector<std::size_t> crossed_, around_;
    std::vector<glm::uvec3> triangles_;
};

/// Axes of a plane that change smoothly with its normal, but at z = 0 (T. Duff et al., "Building an
/// Orthonormal Basis, Revisited", 2017).
std::array<glm::dvec3, 2> axes_across(const glm::dvec3& n) {
    const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    return {glm::dvec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            glm::dvec3(b, sign + n.y * n.y * a, -n.y)};
}

/// Parallel lines in the geometry's space: at `level` = whole numbers.
struct HatchingLines {
    glm::dvec3 origin{0};            ///< near the cut
    glm::dvec3 across{0}, along{0};  ///< per unit of the geometry
    double origin_level = 0;
    bool mirrored = false;

    double level(const glm::dvec3& point) const { return glm::dot(across, point - origin) + origin_level; }
};

/// Where a line meets a contour.
struct HatchingCrossing {
    double level, along;
    int turn;  ///< 1 into the solid, -1 out of it
    glm::dvec3 point;

    bool operator<(const HatchingCrossing& other) const {
        if (level != other.level) return level < other.level;
        return along != other.along ? along < other.along : turn > other.turn;
    }
};

std::optional<HatchingLines> hatching_lines(const Cut& cut, const glm::dmat4& world_from_node,
                                            const scene::ClipPlane& plane, double spacing, bool other_way) {
    const auto [u, v] = axes_across(plane.normal);
    const glm::dvec3 along = (other_way ? u - v : u + v) * std::sqrt(0.5);
    const glm::dvec3 across = glm::cross(plane.normal, along);
    HatchingLines lines;
    lines.origin = cut.points[cut.contours[0].x];
    const double from_world_origin =
        glm::dot(across, glm::dvec3(world_from_node * glm::dvec4(lines.origin, 1)));
    const glm::dmat3 linear(world_from_node);
    const glm::dvec3 across_in_node = glm::transpose(linear) * across;
    lines.along = glm::transpose(linear) * along;
    lines.mirrored = glm::determinant(linear) < 0;

    double least = 0, most = 0, sum = 0;  // of the distances from the line through the origin
    for (const glm::uvec2& line : cut.contours) {
        const double start = glm::dot(across_in_node, cut.points[line.x] - lines.origin);
        const double end = glm::dot(across_in_node, cut.points[line.y] - lines.origin);
        least = std::min({least, start, end});
        most = std::max({most, start, end});
        sum += std::abs(end - start);
    }
    if (!std::isfinite(sum + from_world_origin)) return {};
    while ((most - least) / spacing >= kMostHatchingLines || sum / spacing >= kMostHatchingCrossings)
        spacing *= 2;
    lines.across = across_in_node / spacing;
    lines.origin_level = std::fmod(from_world_origin, spacing) / spacing;
    if (!std::isfinite(glm::dot(lines.across, lines.across)) || !std::isfinite(lines.origin_level)) return {};
    return lines;
}

std::vector<HatchingCrossing> hatching_crossings(const Cut& cut, const HatchingLines& lines) {
    std::vector<HatchingCrossing> crossings;
    for (const glm::uvec2& line : cut.contours) {
        const glm::dvec3 &a = cut.points[line.x], &b = cut.points[line.y];
        const double start = lines.level(a), end = lines.level(b);
        const double least = std::min(start, end), most = std::max(start, end);
        const int turn = (end < start) != lines.mirrored ? 1 : -1;
        for (double level = std::ceil(least); level < most; ++level) {
            const glm::dvec3 point = a + (b - a) * ((level - start) / (end - start));
            crossings.push_back({level, glm::dot(lines.along, point - lines.origin), turn, point});
        }
    }
    std::sort(crossings.begin(), crossings.end());
    return crossings;
}

}  // namespace

Cut cut_of(const scene::Geometry& geometry, const glm::dvec4& equation, bool cap) {
    const std::optional<CuttingPlane> plane = cutting_plane(geometry, equation);
    if (!plane) return {};
    Cut cut = ContourBuilder(geometry, *plane).build();
    if (cap && !cut.contours.empty()) cut.triangles = CapBuilder(cut, plane->normal).build();
    return cut;
}

void add_hatching(Cut& cut, const glm::dmat4& world_from_node, const scene::ClipPlane& plane, double spacing,
                  bool other_way) {
    if (cut.triangles.empty() || !(spacing > 0 && std::isfinite(spacing))) return;
    const auto lines = hatching_lines(cut, world_from_node, plane, spacing, other_way);
    if (!lines) return;
    const std::vector<HatchingCrossing> crossings = hatching_crossings(cut, *lines);
    int winding = 0;
    const HatchingCrossing* entered = nullptr;
    for (const HatchingCrossing& crossing : crossings) {
        if (entered && entered->level != crossing.level) entered = nullptr;
        if (&crossing == &crossings[0] || (&crossing)[-1].level != crossing.level) winding = 0;
        winding += crossing.turn;
        if (winding == 1 && crossing.turn == 1) entered = &crossing;
        if (winding != 0 || !entered || crossing.turn == 1) continue;
        if (crossing.along > entered->along) {
            const auto first = static_cast<unsigned>(cut.points.size());
            cut.points.push_back(entered->point);
            cut.points.push_back(crossing.point);
            cut.hatching.emplace_back(first, first + 1);
        }
        entered = nullptr;
    }
}

}  // namespace vrut::mesh
