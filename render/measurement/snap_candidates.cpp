#include "measurement/snap_candidates.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <unordered_set>
#include <utility>

#include "measurement/chain_shapes.hpp"
#include "measurement/edge_loop.hpp"
#include "measurement/feature_graph.hpp"
#include "measurement/vectors.hpp"

namespace vrut::measurement {

namespace {

constexpr double kCoarse = 4;          // edges longer than so many radii of the cone
constexpr double kCoplanar = 1e-6;     // sine of the angle between normals
constexpr double kMostRounded = 0.05;  // the same, however thin triangles are
constexpr std::size_t kMostCoplanar = 64;
constexpr double kSimilarity = 1e-9;
constexpr std::size_t kMostRoundEdges = 512, kMostRoundSteps = 8 * kMostRoundEdges;
constexpr std::size_t kMostArcEdges = 256;  // on each side of the nearest one
/// Of coordinates: what files hold is often float. Of parts far from their origin it is less.
constexpr double kFloatRounding = 1.2e-7, kFarthestInExtents = 1e3;

double rounding_of(const std::vector<glm::dvec3>& points) {
    double size = 0, extent = 0;
    for (const glm::dvec3& point : points) {
        size = std::max(size, largest(point));
        extent = std::max(extent, largest(point - points[0]));
    }
    return kFloatRounding * std::min(size, kFarthestInExtents * extent);
}

/// True if it keeps all angles.
bool is_similarity(const glm::dmat3& matrix) {
    const glm::dmat3 square = glm::transpose(matrix) * matrix;
    const double scale = square[0][0];
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(square[column][row] - (row == column ? scale : 0)) <= kSimilarity * scale))
                return false;
    return true;
}

/// The points in the node's space if angles there are those in the world, else from the first one in the
/// world.
std::vector<glm::dvec3> undistorted(std::vector<glm::dvec3> chain, const glm::dmat3& world_from_node) {
    if (is_similarity(world_from_node)) return chain;
    const glm::dvec3 origin = chain[0];
    for (glm::dvec3& point : chain) point = world_from_node * (point - origin);
    return chain;
}

/// What is a circle in the world, in the node's space.
std::optional<CirclePoints> circle_in_world(const std::vector<glm::dvec3>& chain,
                                            const glm::dmat3& world_from_node) {
    auto circle = fit_circle(undistorted(chain, world_from_node));
    if (!circle || is_similarity(world_from_node)) return circle;
    const glm::dmat3 back = glm::inverse(world_from_node);
    for (glm::dvec3& point : *circle) point = chain[0] + back * point;
    return circle;
}

/// The indices of a chain's points around the edge from one to the next, in order, each point once.
std::vector<std::size_t> indices_around(std::size_t edge, const std::vector<glm::dvec3>& chain) {
    const bool is_closed = chain.front() == chain.back();
    const std::size_t count = is_closed ? chain.size() - 1 : chain.size();
    const std::size_t half = is_closed ? std::min(kMostArcEdges, count / 2) : kMostArcEdges;
    std::vector<std::size_t> indices;
    for (std::size_t k = 0; k < 2 * half; ++k) {
        const std::size_t beyond = edge + 1 + k;  // by `half`
        if (is_closed)
            indices.push_back((beyond + count - half) % count);
        else if (beyond >= half && beyond - half < count)
            indices.push_back(beyond - half);
    }
    return indices;
}

/// Returns the vertices of the loop around a smooth face, its first one again at the end. Empty if it was
/// tried, has too many edges, or turns by more than 40 degrees in the world, as at a corner.
std::vector<unsigned> loop_without_corners(const Neighborhood& around, unsigned half_edge,
                                           std::unordered_set<unsigned>& tried) {
    std::vector<unsigned> loop;
    const auto turns_at_last = [&](unsigned next) {
        const std::size_t n = loop.size();
        if (n < 2) return false;
        const glm::dvec3 at = around.relative(loop[n - 1]);
        const glm::dvec3 before = unit(at - around.relative(loop[n - 2]));
        return glm::dot(before, unit(around.relative(next) - at)) < kCornerCosine;
    };
    LoopWalk walk(around.edges(), half_edge, kMostRoundSteps);
    do {
        if (!tried.insert(walk.half_edge()).second || loop.size() == kMostRoundEdges) return {};
        if (turns_at_last(walk.vertex())) return {};
        loop.push_back(walk.vertex());
        if (!walk.advance()) return {};
    } while (!walk.is_back());
    if (loop.size() < 3 || turns_at_last(loop[0])) return {};
    loop.push_back(loop[0]);
    return turns_at_last(loop[1]) ? std::vector<unsigned>() : loop;
}

class CandidateSearch {
public:
    CandidateSearch(const Neighborhood& around, const std::vector<Snap>& to)
        : around_(around), mesh_(around.edges().mesh()), to_(to) {}

    std::vector<Candidate> found() {
        const auto triangle = around_.hit_triangle();
        if (!around_.is_dense()) add_features(triangle);
        if (triangle && accepts(Snap::plane)) add_plane(*triangle);
        if (accepts(Snap::point)) add(Rank::point, Snap::point, glm::dvec3(0), {around_.hit()});
        return std::move(found_);
    }

private:
    bool accepts(Snap snap) const {
        return to_.empty() ? snap != Snap::loop : std::find(to_.begin(), to_.end(), snap) != to_.end();
    }
    /// What `to` names needs no length.
    double coarse_length() const { return to_.empty() ? kCoarse * around_.radius() : 0; }
    double length(unsigned from, unsigned to) const {
        return safe_length(around_.relative(to) - around_.relative(from));
    }

    void add(Rank rank, Snap snap, const glm::dvec3& seen, std::vector<glm::dvec3> points) {
        found_.push_back({rank, snap, around_.offset(seen), around_.depth(seen), seen, std::move(points)});
    }

    void add_features(const std::optional<unsigned>& hit_triangle) {
        if (accepts(Snap::midpoint) || accepts(Snap::center) || accepts(Snap::edge))
            for (const std::size_t index : around_.chains()) add_chain(around_.edges().chain(index));
        if (accepts(Snap::vertex)) add_vertices();
        if (hit_triangle && accepts(Snap::loop)) add_loops(*hit_triangle);
    }

    void add_vertices() {
        std::map<unsigned, double> shortest_edges;  // by vertex
        for (const unsigned triangle : around_.triangles()) {
            const glm::uvec3& t = mesh_.triangles()[triangle];
            for (int k = 0; k < 3; ++k) {
                if (!around_.is_near(around_.relative(t[k]))) continue;
                const double edge = std::min(length(t[k], t[(k + 1) % 3]), length(t[k], t[(k + 2) % 3]));
                double& shortest = shortest_edges.emplace(t[k], edge).first->second;
                shortest = std::min(shortest, edge);
            }
        }
        for (const auto& [vertex, shortest] : shortest_edges) add_vertex(vertex, shortest);
    }
    void add_vertex(unsigned vertex, double shortest_edge) {
        const bool is_corner =
            !to_.empty() || (around_.edges().is_corner(vertex) && !is_on_round_loop(vertex));
        if (is_corner || shortest_edge > coarse_length())
            add(is_corner ? Rank::corner : Rank::vertex, Snap::vertex, around_.relative(vertex),
                {mesh_.positions()[vertex]});
    }

    std::vector<glm::dvec3> points_of(std::span<const unsigned> vertices) const {
        std::vector<glm::dvec3> points;
        points.reserve(vertices.size());
        for (const unsigned vertex : vertices) points.push_back(mesh_.positions()[vertex]);
        return points;
    }

    void add_chain(std::span<const unsigned> vertices) {
        const bool is_open = vertices.front() != vertices.back();
        if (accepts(Snap::center) && is_open && is_any_near(vertices) && add_round_loop(vertices)) return;
        const std::vector<glm::dvec3> points = points_of(vertices);
        if (accepts(Snap::center))
            if (const auto circle = circle_in_world(points, around_.world_from_node()))
                return add_center(points, *circle);
        const std::vector<bool> is_round =
            accepts(Snap::center) ? add_arc(points) : std::vector<bool>(points.size());
        if (!accepts(Snap::midpoint) && !accepts(Snap::edge)) return;
        for (const Run& run : straight_runs(points, rounding_of(points)))
            if (!is_round[run.first] || !is_round[run.last - 1])
                add_straight_edge(points[run.first], points[run.last],
                                  ends_at(points, run, false) && ends_at(points, run, true));
    }

    bool is_any_near(std::span<const unsigned> chain) const {
        for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
            const glm::dvec3 a = around_.relative(chain[i]), b = around_.relative(chain[i + 1]);
            const glm::dvec3 nearest = glm::mix(a, b, around_.closest_to_ray(a, b));
            if (around_.is_near(a) || around_.is_near(nearest) || around_.is_near(b)) return true;
        }
        return false;
    }
    bool is_on_round_loop(unsigned vertex) const {
        const auto edge = round_edges_.lower_bound({vertex, 0});
        return edge != round_edges_.end() && edge->first == vertex;
    }
    /// Half-edges of the smooth faces on both sides of an edge.
    std::vector<unsigned> sides_of(unsigned start, unsigned end) const {
        const glm::dvec3 &a = mesh_.positions()[start], &b = mesh_.positions()[end];
        std::vector<unsigned> sides;
        for (const auto& half_edge : {mesh_.find_half_edge(a, b), mesh_.find_half_edge(b, a)})
            if (half_edge) sides.push_back(*half_edge);
        if (sides.size() == 1 && mesh_.twin(sides[0]) != WeldedMesh::kNone)
            sides.push_back(mesh_.twin(sides[0]));
        return sides;
    }
    /// The circle that the loop on either side of a chain is. False if neither is one.
    bool add_round_loop(std::span<const unsigned> chain) {
        if (round_edges_.contains({chain[0], chain[1]})) return true;
        for (const unsigned side : sides_of(chain[0], chain[1])) {
            const std::vector<unsigned> loop = loop_without_corners(around_, side, tried_);
            if (loop.empty()) continue;
            const std::vector<glm::dvec3> points = points_of(loop);
            const auto circle = circle_in_world(points, around_.world_from_node());
            if (!circle) continue;
            for (std::size_t i = 0; i + 1 < loop.size(); ++i)
                round_edges_.insert({{loop[i], loop[i + 1]}, {loop[i + 1], loop[i]}});
            add_center(points, *circle);
            return true;
        }
        return false;
    }

    glm::dvec3 closest(const glm::dvec3& a, const glm::dvec3& b) const {
        return glm::mix(a, b, around_.closest_to_ray(around_.relative(a), around_.relative(b)));
    }

    struct Nearest {
        std::size_t edge;
        glm::dvec3 seen;  ///< its point nearest to the ray, relative to the hit
    };
    std::optional<Nearest> nearest_edge(const std::vector<glm::dvec3>& chain) const {
        std::optional<Nearest> best;
        for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
            const glm::dvec3 seen = around_.relative(closest(chain[i], chain[i + 1]));
            if (around_.is_near(seen) && (!best || around_.offset(seen) < around_.offset(best->seen)))
                best = {i, seen};
        }
        return best;
    }

    void add_center(const std::vector<glm::dvec3>& rim, const CirclePoints& circle) {
        if (const auto nearest = nearest_edge(rim))
            add(Rank::center, Snap::center, nearest->seen, {circle.begin(), circle.end()});
    }

    /// The circle of the arc at the chain's edge that is nearest to the ray. Returns which edges are the
    /// arc's.
    std::vector<bool> add_arc(const std::vector<glm::dvec3>& chain) {
        std::vector<bool> is_round(chain.size());
        const auto nearest = chain.size() > 2 ? nearest_edge(chain) : std::nullopt;
        if (!nearest) return is_round;
        const std::vector<std::size_t> indices = indices_around(nearest->edge, chain);
        std::vector<glm::dvec3> points, arc;
        for (const std::size_t index : indices) points.push_back(chain[index]);
        const auto edge = std::find(indices.begin(), indices.end(), nearest->edge) - indices.begin();
        const auto run =
            arc_around_edge(undistorted(points, around_.world_from_node()), static_cast<std::size_t>(edge));
        if (!run) return is_round;
        for (std::size_t k = run->first; k <= run->last; ++k) arc.push_back(points[k]);
        for (std::size_t k = run->first; k < run->last; ++k) is_round[indices[k]] = true;
        if (const auto circle = circle_in_world(arc, around_.world_from_node())) add_center(arc, *circle);
        return is_round;
    }

    /// Returns true if a straight run of a chain ends for all to see: at the chain's end, or if the chain
    /// turns within a quarter of the run's length behind it. The pieces of what is not quite straight do not
    /// end so, nor those of a curve.
    bool ends_at(const std::vector<glm::dvec3>& chain, const Run& run, bool forwards) const {
        constexpr double kTurn = 10 * std::numbers::pi / 180;
        const std::size_t count = chain.size() - 1;  // of edges
        const bool is_closed = chain.front() == chain.back();
        const glm::dvec3 along = around_.relative(chain[run.last]) - around_.relative(chain[run.first]);
        double behind = 0;
        for (std::size_t i = 0; i < count && behind <= glm::length(along) / 4; ++i) {
            const std::size_t edge = forwards ? run.last + i : run.first + count - 1 - i;
            if (!is_closed && (forwards ? edge >= count : edge < count)) return true;
            const glm::dvec3 next =
                around_.relative(chain[edge % count + 1]) - around_.relative(chain[edge % count]);
            if (std::atan2(glm::length(glm::cross(along, next)), glm::dot(along, next)) > kTurn) return true;
            behind += glm::length(next);
        }
        return false;
    }

    /// `has_middle`: its ends can be seen.
    void add_straight_edge(const glm::dvec3& a, const glm::dvec3& b, bool has_middle) {
        const glm::dvec3 middle = a + (b - a) * 0.5, seen_middle = around_.relative(middle);
        const double length = safe_length(around_.relative(b) - around_.relative(a));
        const bool counts = !to_.empty() || (has_middle && length > coarse_length());
        if (accepts(Snap::midpoint) && counts && around_.is_near(seen_middle))
            add(Rank::midpoint, Snap::midpoint, seen_middle, {middle});
        const glm::dvec3 point = closest(a, b), seen = around_.relative(point);
        if (accepts(Snap::edge) && around_.is_near(seen)) add(Rank::edge, Snap::edge, seen, {point, a, b});
    }

    /// At most `limit` triangles that hang together with one, which is the first; `is_joined(half-edge)`
    /// tells across which edges that have a twin.
    template <typename IsJoined>
    std::vector<unsigned> region(unsigned triangle, const IsJoined& is_joined, std::size_t limit) const {
        std::vector<unsigned> region{triangle};
        std::unordered_set<unsigned> known{triangle};
        for (std::size_t next = 0; next < region.size(); ++next)
            for (unsigned half_edge = 3 * region[next]; half_edge < 3 * region[next] + 3; ++half_edge) {
                const unsigned twin = mesh_.twin(half_edge);
                if (twin == WeldedMesh::kNone || !is_joined(half_edge)) continue;
                if (known.contains(twin / 3)) continue;
                if (region.size() == limit) return region;
                known.insert(twin / 3);
                region.push_back(twin / 3);
            }
        return region;
    }

    /// Of the smooth region that was hit.
    void add_loops(unsigned hit_triangle) {
        const MeshEdges& edges = around_.edges();
        const std::vector<unsigned>& near = around_.triangles();
        const auto is_smooth = [&](unsigned half_edge) {
            return !edges.is_feature(half_edge) &&
                   std::binary_search(near.begin(), near.end(), mesh_.twin(half_edge) / 3);
        };
        for (const unsigned triangle : region(hit_triangle, is_smooth, near.size()))
            for (unsigned half_edge = 3 * triangle; half_edge < 3 * triangle + 3; ++half_edge)
                if (edges.is_feature(half_edge)) add_loop(half_edge);
    }
    void add_loop(unsigned half_edge) {
        const glm::dvec3& start = mesh_.positions()[mesh_.start_of(half_edge)];
        const glm::dvec3& end = mesh_.positions()[mesh_.end_of(half_edge)];
        const glm::dvec3 point = closest(start, end), seen = around_.relative(point);
        if (around_.is_near(seen)) add(Rank::loop, Snap::loop, seen, {point, start, end});
    }

    glm::dvec3 area(unsigned triangle) const {
        const glm::uvec3& t = mesh_.triangles()[triangle];
        const glm::dvec3& a = mesh_.positions()[t.x];
        return glm::cross(mesh_.positions()[t.y] - a, mesh_.positions()[t.z] - a);
    }
    std::vector<unsigned> coplanar(unsigned hit_triangle) const {
        const glm::dvec3& normal = mesh_.normal(hit_triangle);
        const auto is_coplanar = [&](unsigned half_edge) {
            const glm::dvec3& other = mesh_.normal(mesh_.twin(half_edge) / 3);
            const double rounded =
                rounding_of_normal(hit_triangle) + rounding_of_normal(mesh_.twin(half_edge) / 3);
            return mesh_.agrees_with_twin(half_edge) && glm::dot(normal, other) > 0 &&
                   sine(normal, other) <= std::min(kCoplanar + rounded, kMostRounded);
        };
        return region(hit_triangle, is_coplanar, kMostCoplanar);
    }
    /// By how much positions that are floats turn the normal of a triangle, in radians: slivers by much.
    double rounding_of_normal(unsigned triangle) const {
        const glm::uvec3& t = mesh_.triangles()[triangle];
        const std::vector<glm::dvec3> corners{mesh_.positions()[t.x], mesh_.positions()[t.y],
                                              mesh_.positions()[t.z]};
        const glm::dvec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0];
        const double longest =
            std::max({glm::length(ab), glm::length(ac), glm::distance(corners[1], corners[2])});
        const double height = glm::length(glm::cross(ab, ac)) / longest;
        return height > 0 ? rounding_of(corners) / height : kMostRounded;
    }
    bool is_large(unsigned triangle) const {
        const glm::uvec3& t = mesh_.triangles()[triangle];
        return std::min({length(t.x, t.y), length(t.y, t.z), length(t.z, t.x)}) > coarse_length();
    }
    void add_plane(unsigned hit_triangle) {
        const std::vector<unsigned> flat = coplanar(hit_triangle);
        if (flat.size() < 2 && !is_large(hit_triangle)) return;
        const unsigned widest = *std::max_element(flat.begin(), flat.end(), [&](unsigned a, unsigned b) {
            return safe_length(area(a)) < safe_length(area(b));
        });
        const glm::uvec3& t = mesh_.triangles()[widest];
        const std::vector<glm::dvec3>& positions = mesh_.positions();
        const glm::dvec3& normal = mesh_.normal(widest);
        const glm::dvec3 ab = positions[t.y] - positions[t.x], ac = positions[t.z] - positions[t.x];
        const glm::dvec3 point = around_.hit() - normal * glm::dot(normal, around_.hit() - positions[t.x]);
        if (sine(ab, ac) > kCoplanar)
            add(Rank::plane, Snap::plane, glm::dvec3(0), {point, point + ab, point + ac});
    }

    const Neighborhood& around_;
    const WeldedMesh& mesh_;
    const std::vector<Snap>& to_;
    std::unordered_set<unsigned> tried_;                   // half-edges whose loops are known
    std::set<std::pair<unsigned, unsigned>> round_edges_;  // of loops that are circles, in both directions
    std::vector<Candidate> found_;
};

}  // namespace

std::vector<Candidate> snap_candidates(const Neighborhood& around, const std::vector<Snap>& to) {
    return CandidateSearch(around, to).found();
}

}  // namespace vrut::measurement
