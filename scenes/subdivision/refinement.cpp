#include "refinement.hpp"

#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>
#include <tuple>

#include "vectors.hpp"

namespace vrut {

namespace {

constexpr double kShortestEdge = 2e-5;  // metres; nothing shorter is halved
constexpr double kNoError = 1e-7;       // metres; less is rounding
constexpr double kHardNormals = 0.035;  // about two degrees between normals: an edge shows
constexpr double kBend =
    1.0 / 6;  // an arc's height is an eighth of its length times its angle; shading asks more
constexpr double kTwist = 0.02;   // of that, for normals that turn about an edge: it limits triangles' length
constexpr double kNeedle = 0.03;  // sine of the smallest angle, below two degrees
constexpr double kBetter = 0.9;   // of an error: what is worth a swap
constexpr double kNothing = 0.1;  // of the error now being mended: errors below that are all the same
constexpr double kNearlyAsBad = 0.7;  // of an error: a shorter edge with that is halved before
constexpr double kShorter = 0.5;
constexpr int kMostSwaps = 12;  // after one halving

/// Of `point` from the line through `a` and `b`, the shortest way.
glm::dvec3 off_line(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 along = unit_or_zero(b - a), from_a = point - a;
    return from_a - glm::dot(from_a, along) * along;
}

}  // namespace

AdaptiveMesh::AdaptiveMesh(const Cage& cage, ErrorRule rule) : surface_(cage), rule_(std::move(rule)) {
    add_quads(cage);
    link_neighbours();
    for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
        for (std::size_t k = 0; k < 3; ++k)
            if (at(t).neighbours[k] < t) measure_edge(t, k);
        measure_own(at(t));
    }
}

LimitSurface::Point AdaptiveMesh::surface_at(int quad, int u, int v) const {
    return surface_.at(quad, static_cast<double>(u) / kUnit, static_cast<double>(v) / kUnit);
}

std::uint32_t AdaptiveMesh::add_corner(std::uint32_t vertex, int quad, int u, int v) {
    corners_.push_back({vertex, static_cast<std::uint16_t>(u), static_cast<std::uint16_t>(v),
                        glm::vec3(surface_at(quad, u, v).normal)});
    return static_cast<std::uint32_t>(corners_.size() - 1);
}

void AdaptiveMesh::add_quads(const Cage& cage) {
    constexpr std::array<std::array<int, 2>, 4> kPlaces = {{{0, 0}, {kUnit, 0}, {kUnit, kUnit}, {0, kUnit}}};
    constexpr std::uint32_t kNew = ~0U;
    std::vector<std::uint32_t> vertex_of(cage.points.size(), kNew);
    for (int quad = 0; quad < static_cast<int>(cage.quads.size()); ++quad) {
        std::array<std::uint32_t, 4> corners{};
        for (std::size_t k = 0; k < 4; ++k) {
            const auto [u, v] = kPlaces[k];
            std::uint32_t& vertex =
                vertex_of[static_cast<std::size_t>(cage.quads[static_cast<std::size_t>(quad)][k])];
            if (vertex == kNew) {
                const LimitSurface::Point point = surface_at(quad, u, v);
                vertex = static_cast<std::uint32_t>(vertices_.size());
                vertices_.push_back({point.position, glm::vec2(point.texcoord)});
            }
            corners[k] = add_corner(vertex, quad, u, v);
        }
        const auto fit = [&](std::size_t k) {
            const std::uint32_t p = corners[k], q = corners[(k + 1) % 4], r = corners[(k + 2) % 4],
                                s = corners[(k + 3) % 4];
            return Fit{chord_error(p, r, quad, false), std::min(shape(p, q, r), shape(p, r, s))};
        };
        const bool second = is_better(fit(1), fit(0), 0);
        const std::size_t s = second ? 1 : 0;
        const auto corner = [&](std::size_t k) { return corners[(k + s) % 4]; };
        triangles_.push_back({{corner(1), corner(2), corner(0)}, {-1, -1, -1}, quad, {}, 0});
        triangles_.push_back({{corner(3), corner(0), corner(2)}, {-1, -1, -1}, quad, {}, 0});
    }
}

void AdaptiveMesh::link_neighbours() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, std::size_t>> open;
    for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            Triangle& triangle = triangles_[static_cast<std::size_t>(t)];
            const std::uint32_t a = corners_[triangle.corners[(k + 1) % 3]].vertex,
                                b = corners_[triangle.corners[(k + 2) % 3]].vertex;
            const auto other = open.find({b, a});
            if (other == open.end()) {
                open[{a, b}] = {t, k};
                continue;
            }
            triangle.neighbours[k] = other->second.first;
            triangles_[static_cast<std::size_t>(other->second.first)].neighbours[other->second.second] = t;
            open.erase(other);
        }
}

LimitSurface::Point AdaptiveMesh::between(const Triangle& triangle, std::size_t a, std::size_t b,
                                          double share) const {
    const Corner &p = corners_[triangle.corners[a]], &q = corners_[triangle.corners[b]];
    return surface_.at(triangle.quad, glm::mix<double>(p.u, q.u, share) / kUnit,
                       glm::mix<double>(p.v, q.v, share) / kUnit);
}

bool AdaptiveMesh::is_feature(const Triangle& triangle, std::size_t edge) const {
    const int n = triangle.neighbours[edge];
    if (n < 0) return true;
    const Triangle& other = triangles_[static_cast<std::size_t>(n)];
    if (other.quad == triangle.quad) return false;
    for (std::size_t k = 1; k < 3; ++k) {
        const Corner& mine = corners_[triangle.corners[(edge + k) % 3]];
        for (const std::uint32_t c : other.corners)
            if (corners_[c].vertex == mine.vertex &&
                glm::distance(corners_[c].normal, mine.normal) > kHardNormals)
                return true;
    }
    return false;
}

/// How far the surface is from the straight edge between two corners of a quad. In its own surface an edge
/// may lie beside the curve that it stands for, unless that is seen as a line.
double AdaptiveMesh::chord_error(std::uint32_t a, std::uint32_t b, int quad, bool is_line) const {
    const Corner &from = corners_[a], &to = corners_[b];
    const glm::dvec3 &p = position(a), &q = position(b);
    const LimitSurface::Point middle = surface_at(quad, (from.u + to.u) / 2, (from.v + to.v) / 2);
    const glm::dvec3 off = off_line(middle.position, p, q), m = middle.position, n = middle.normal;
    const double height = is_line ? glm::length(off) : std::abs(glm::dot(off, n));
    // In halves, so that a wave is no straight line; together they are half the whole.
    const double bend = 2 * (std::abs(glm::dot(m - p, n - glm::dvec3(from.normal))) +
                             std::abs(glm::dot(q - m, glm::dvec3(to.normal) - n)));
    const double twist = kTwist * glm::distance(p, q) * glm::distance(from.normal, to.normal);
    return std::max(height, kBend * (bend + twist));
}

double AdaptiveMesh::with_rule(std::uint32_t a, std::uint32_t b, double curvature) const {
    const double error = rule_.edge ? rule_.edge(position(a), position(b), curvature) : curvature;
    return error > kNoError ? error : 0;
}

double AdaptiveMesh::edge_error(int t, std::size_t k) const {
    const Triangle& triangle = at(t);
    const std::uint32_t a = triangle.corners[(k + 1) % 3], b = triangle.corners[(k + 2) % 3];
    if (glm::distance(position(a), position(b)) < kShortestEdge || !can_be_halved(t, k)) return 0;
    const bool is_line = is_feature(triangle, k);
    double error = chord_error(a, b, triangle.quad, is_line);
    if (const int n = triangle.neighbours[k]; n >= 0 && is_line) {
        const Triangle& other = at(n);
        const std::size_t l = edge_of(n, t, b);
        error = std::max(
            error, chord_error(other.corners[(l + 1) % 3], other.corners[(l + 2) % 3], other.quad, true));
    }
    return with_rule(a, b, error);
}

void AdaptiveMesh::measure_edge(int t, std::size_t k) {
    const auto error = static_cast<float>(edge_error(t, k));
    at(t).errors[k] = error;
    if (const int n = at(t).neighbours[k]; n >= 0)
        at(n).errors[edge_of(n, t, at(t).corners[(k + 2) % 3])] = error;
}

std::size_t AdaptiveMesh::longest_edge(const Triangle& triangle) const {
    std::size_t longest = 0;
    double length = -1;
    for (std::size_t k = 0; k < 3; ++k)
        if (const double l = glm::distance(position(triangle.corners[(k + 1) % 3]),
                                           position(triangle.corners[(k + 2) % 3]));
            l > length) {
            longest = k;
            length = l;
        }
    return longest;
}

void AdaptiveMesh::measure_own(Triangle& triangle) const {
    const auto [a, b, c] = triangle.corners;
    double error = 0;
    if (rule_.triangle) error = rule_.triangle({position(a), position(b), position(c)});
    // Turned over, as a straight edge cuts off what a bent one would hold.
    if (shape(a, b, c) < 0) {
        const std::size_t k = longest_edge(triangle);
        error = std::max(error, chord_error(triangle.corners[(k + 1) % 3], triangle.corners[(k + 2) % 3],
                                            triangle.quad, true));
    }
    triangle.own_error = error > kNoError ? static_cast<float>(error) : 0;
}

float AdaptiveMesh::error(const Edge& edge) const {
    const Triangle& triangle = at(edge.triangle);
    const float error = triangle.errors[edge.opposite];
    if (triangle.own_error <= error || longest_edge(triangle) != edge.opposite ||
        !can_be_halved(edge.triangle, edge.opposite))
        return error;
    return triangle.own_error;
}

/// Which edge leads to a neighbour; it starts at the vertex of that corner.
std::size_t AdaptiveMesh::edge_of(int t, int neighbour, std::uint32_t first_corner) const {
    const Triangle& triangle = at(t);
    const std::uint32_t vertex = corners_[first_corner].vertex;
    for (std::size_t k = 0; k < 3; ++k)
        if (triangle.neighbours[k] == neighbour && corners_[triangle.corners[(k + 1) % 3]].vertex == vertex)
            return k;
    assert(false);
    return 0;
}

double AdaptiveMesh::shape(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const glm::dvec3 ab = position(b) - position(a), bc = position(c) - position(b),
                     ca = position(a) - position(c);
    std::array<double, 3> lengths = {glm::length(ab), glm::length(bc), glm::length(ca)};
    std::sort(lengths.begin(), lengths.end());
    const double longest = lengths[1] * lengths[2];
    const glm::dvec3 area = glm::cross(ab, bc),
                     normal(corners_[a].normal + corners_[b].normal + corners_[c].normal);
    return longest > 0 ? std::copysign(glm::length(area) / longest, glm::dot(area, normal)) : 0;
}

double AdaptiveMesh::area_in_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Corner &p = corners_[a], &q = corners_[b], &r = corners_[c];
    return double{1} * (q.u - p.u) * (r.v - p.v) - double{1} * (r.u - p.u) * (q.v - p.v);
}

bool AdaptiveMesh::can_be_halved(int t, std::size_t k) const {
    const Triangle& triangle = at(t);
    const Corner &a = corners_[triangle.corners[(k + 1) % 3]], &b = corners_[triangle.corners[(k + 2) % 3]];
    if ((a.u + b.u) % 2 == 0 && (a.v + b.v) % 2 == 0) return true;
    // Inside a quad the middle may be rounded, as long as nothing turns over.
    const int n = triangle.neighbours[k];
    if (n < 0 || at(n).quad != triangle.quad) return false;
    const int u = (a.u + b.u) / 2, v = (a.v + b.v) / 2;
    const auto area = [&](const Corner& p, const Corner& q) {
        return double{1} * (p.u - u) * (q.v - v) - double{1} * (q.u - u) * (p.v - v);
    };
    const Corner &left = corners_[triangle.corners[k]],
                 &right = corners_[at(n).corners[edge_of(n, t, triangle.corners[(k + 2) % 3])]];
    return area(b, left) > 0 && area(left, a) > 0 && area(a, right) > 0 && area(right, b) > 0;
}

/// The middle of an edge as a corner of the triangle, and as one of its neighbour.
std::array<std::uint32_t, 2> AdaptiveMesh::add_middle(int t, std::size_t k) {
    struct Place {
        int quad, u, v;
    };
    const auto place_in = [&](const Triangle& triangle, std::size_t edge) {
        const Corner &a = corners_[triangle.corners[(edge + 1) % 3]],
                     &b = corners_[triangle.corners[(edge + 2) % 3]];
        return Place{triangle.quad, (a.u + b.u) / 2, (a.v + b.v) / 2};
    };
    const Triangle& triangle = at(t);
    const int n = triangle.neighbours[k];
    const Place mine = place_in(triangle, k);
    const Place other = n < 0 ? mine : place_in(at(n), edge_of(n, t, triangle.corners[(k + 2) % 3]));
    const Place& first = other.quad < mine.quad ? other : mine;
    const LimitSurface::Point point = surface_at(first.quad, first.u, first.v);
    const auto vertex = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back({point.position, glm::vec2(point.texcoord)});
    const std::uint32_t corner = add_corner(vertex, mine.quad, mine.u, mine.v);
    if (n < 0 || other.quad == mine.quad) return {corner, corner};
    return {corner, add_corner(vertex, other.quad, other.u, other.v)};
}

/// (p; q, r) becomes (p; q, m) in its own place and (p; m, r) at the end.
int AdaptiveMesh::split(int t, std::size_t k, std::uint32_t middle) {
    const std::size_t q = (k + 1) % 3, r = (k + 2) % 3;
    const int added = static_cast<int>(triangles_.size());
    Triangle rest = at(t);
    if (const int beyond = rest.neighbours[q]; beyond >= 0)
        at(beyond).neighbours[edge_of(beyond, t, rest.corners[k])] = added;
    rest.corners[q] = middle;
    rest.neighbours[r] = t;
    Triangle& triangle = at(t);
    triangle.corners[r] = middle;
    triangle.neighbours[q] = added;
    triangles_.push_back(rest);
    return added;
}

void AdaptiveMesh::split_both(int t, std::size_t k, std::vector<int>& changed) {
    const int n = at(t).neighbours[k];
    const std::size_t l = n < 0 ? 0 : edge_of(n, t, at(t).corners[(k + 2) % 3]);
    const auto middles = add_middle(t, k);
    const int t2 = split(t, k, middles[0]);
    changed = {t, t2};
    if (n >= 0) {
        const int n2 = split(n, l, middles[1]);
        changed.insert(changed.end(), {n, n2});
        at(t).neighbours[k] = n2;
        at(n2).neighbours[l] = t;
        at(t2).neighbours[k] = n;
        at(n).neighbours[l] = t2;
        measure_edge(n, (l + 1) % 3);
    }
    measure_edge(t, k);
    measure_edge(t2, k);
    measure_edge(t, (k + 1) % 3);
}

/// `level`: the error now being mended.
bool AdaptiveMesh::is_better(const Fit& fit, const Fit& than, double level) const {
    if (fit.shape < kNeedle && fit.shape < kBetter * than.shape) return false;
    if (than.shape < kNeedle / 2 && fit.shape > kNeedle) return true;
    const double nothing = std::max(kNothing * level, kNoError), error = std::max(fit.error, nothing),
                 other = std::max(than.error, nothing);
    if (error < kBetter * other) return true;
    return kBetter * error <= other && kBetter * fit.shape > than.shape;
}

bool AdaptiveMesh::swap_if_better(int t, std::size_t k, double level) {
    const Triangle& triangle = at(t);
    const int n = triangle.neighbours[k];
    if (n < 0 || at(n).quad != triangle.quad) return false;
    const std::uint32_t p = triangle.corners[k], q = triangle.corners[(k + 1) % 3],
                        r = triangle.corners[(k + 2) % 3], s = at(n).corners[edge_of(n, t, r)];
    if (!(area_in_quad(p, q, s) > 0 && area_in_quad(p, s, r) > 0)) return false;
    const Fit now{triangle.errors[k], std::min(shape(p, q, r), shape(s, r, q))};
    Fit other{kBend *
                  std::abs(glm::dot(position(s) - position(p),
                                    glm::dvec3(corners_[s].normal - corners_[p].normal))) /
                  2,
              std::min(shape(p, q, s), shape(p, s, r))};
    if (!is_better(other, now, level)) return false;  // not even at a guess
    other.error = with_rule(p, s, chord_error(p, s, triangle.quad, false));
    if (!is_better(other, now, level)) return false;
    swap(t, k, other.error);
    return true;
}

/// (p; q, r) and (s; r, q) become (p, q, s) and (p, s, r).
void AdaptiveMesh::swap(int t, std::size_t k, double error) {
    const Triangle one = at(t);
    const int n = one.neighbours[k];
    const std::size_t q = (k + 1) % 3, r = (k + 2) % 3, s = edge_of(n, t, one.corners[r]);
    const Triangle two = at(n);
    const std::size_t after_s = (s + 1) % 3, before_s = (s + 2) % 3;
    const auto new_error = static_cast<float>(error);
    at(t) = {{one.corners[k], one.corners[q], two.corners[s]},
             {two.neighbours[after_s], n, one.neighbours[r]},
             one.quad,
             {two.errors[after_s], new_error, one.errors[r]},
             0};
    at(n) = {{one.corners[k], two.corners[s], one.corners[r]},
             {two.neighbours[before_s], one.neighbours[q], t},
             one.quad,
             {two.errors[before_s], one.errors[q], new_error},
             0};
    if (const int beyond = two.neighbours[after_s]; beyond >= 0)
        at(beyond).neighbours[edge_of(beyond, n, two.corners[s])] = t;
    if (const int beyond = one.neighbours[q]; beyond >= 0)
        at(beyond).neighbours[edge_of(beyond, t, one.corners[k])] = n;
}

/// Of the edges about this one that are nearly as much off, a shorter one: where the surface bends one way,
/// the edges askew to it are as bad as those across, and superfluous once those are halved.
AdaptiveMesh::Edge AdaptiveMesh::shorter_instead(Edge edge) const {
    const auto length = [&](const Edge& e) {
        const Triangle& triangle = at(e.triangle);
        return glm::distance(position(triangle.corners[(e.opposite + 1) % 3]),
                             position(triangle.corners[(e.opposite + 2) % 3]));
    };
    if (const Triangle& triangle = at(edge.triangle);
        rule_.edge &&
        error(edge) > 1.001 * chord_error(triangle.corners[(edge.opposite + 1) % 3],
                                          triangle.corners[(edge.opposite + 2) % 3], triangle.quad, false))
        return edge;  // it is not the bend that matters here
    const double least = kNearlyAsBad * error(edge);
    double shortest = length(edge);
    for (bool found = true; found;) {
        found = false;
        for (const int t : {edge.triangle, at(edge.triangle).neighbours[edge.opposite]})
            for (std::size_t k = 0; t >= 0 && k < 3; ++k)
                if (const Edge other{t, k};
                    at(t).errors[k] >= least && can_be_halved(t, k) && length(other) < kShorter * shortest) {
                    shortest = length(other);
                    edge = other;
                    found = true;
                }
    }
    return edge;
}

void AdaptiveMesh::halve(const Edge& asked, std::vector<int>& changed) {
    changed.clear();
    if (!can_be_halved(asked.triangle, asked.opposite)) {  // any more, for what has become of its neighbours
        at(asked.triangle).errors[asked.opposite] = 0;
        return;
    }
    const double level = error(asked);
    const Edge edge = shorter_instead(asked);
    split_both(edge.triangle, edge.opposite, changed);
    std::vector<int> doubtful = changed;
    for (int swaps = 0; !doubtful.empty() && swaps < kMostSwaps;) {
        const int t = doubtful.back();
        doubtful.pop_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const int n = at(t).neighbours[k];
            if (!swap_if_better(t, k, level)) continue;
            for (const int i : {n, t})
                for (std::vector<int>* list : {&changed, &doubtful})
                    if (std::find(list->begin(), list->end(), i) == list->end()) list->push_back(i);
            ++swaps;
            break;
        }
    }
    std::sort(changed.begin(), changed.end());
    for (const int t : changed) measure_own(at(t));
}

std::vector<int> AdaptiveMesh::order() const {
    // Along a Z curve through each quad.
    const auto spread = [](std::uint64_t x) {
        std::uint64_t result = 0;
        for (unsigned bit = 0; bit < 20; ++bit) result |= (x >> bit & 1) << (2 * bit);
        return result;
    };
    std::vector<std::tuple<int, std::uint64_t, int>> keys;
    keys.reserve(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        std::uint64_t u = 0, v = 0;
        for (const std::uint32_t c : triangles_[t].corners) {
            u += corners_[c].u;
            v += corners_[c].v;
        }
        keys.emplace_back(triangles_[t].quad, spread(u) | spread(v) << 1, static_cast<int>(t));
    }
    std::sort(keys.begin(), keys.end());
    std::vector<int> order;
    order.reserve(keys.size());
    for (const auto& key : keys) order.push_back(std::get<2>(key));
    return order;
}

Refinement::Refinement(std::span<RefinedPart> parts) : parts_(parts) {
    for (std::uint32_t p = 0; p < parts.size(); ++p) {
        std::vector<int> all(parts[p].mesh->triangles().size());
        std::iota(all.begin(), all.end(), 0);
        push(p, all);
    }
}

float Refinement::error_of(std::uint32_t part, const AdaptiveMesh::Edge& edge) const {
    return parts_[part].mesh->error(edge) / static_cast<float>(parts_[part].tolerance);
}

void Refinement::push(const Entry& entry) {
    heap_.push_back(entry);
    std::push_heap(heap_.begin(), heap_.end());
}

void Refinement::push(std::uint32_t part, const std::vector<int>& triangles) {
    for (const int t : triangles)
        for (std::size_t k = 0; k < 3; ++k)
            if (const float error = error_of(part, {t, k}); error > 0)
                push({error, part, 4 * static_cast<std::uint32_t>(t) + static_cast<std::uint32_t>(k)});
}

double Refinement::count() const {
    return std::accumulate(parts_.begin(), parts_.end(), 0.0, [](double sum, const RefinedPart& part) {
        return sum + part.weight * static_cast<double>(part.mesh->triangles().size());
    });
}

void Refinement::drop_outdated() {
    std::erase_if(heap_,
                  [&](const Entry& entry) { return error_of(entry.part, entry.edge()) != entry.error; });
    std::sort(heap_.begin(), heap_.end());
    heap_.erase(std::unique(heap_.begin(), heap_.end()), heap_.end());
    std::make_heap(heap_.begin(), heap_.end());
    room_ = std::max(room_, 2 * heap_.size());
}

void Refinement::refine_to(double target) {
    const auto counts = [](const RefinedPart& part) { return part.weight > 0; };
    if (std::none_of(parts_.begin(), parts_.end(), counts)) return;  // nothing shows, however fine
    std::vector<int> changed;
    double shown = count();
    while (shown < target && !heap_.empty()) {
        std::pop_heap(heap_.begin(), heap_.end());
        const Entry entry = heap_.back();
        heap_.pop_back();
        RefinedPart& part = parts_[entry.part];
        // An entry is out of date where the edge has been halved or swapped since.
        if (error_of(entry.part, entry.edge()) != entry.error) continue;
        reached_ = reached_ > 0 ? std::min<double>(reached_, entry.error) : entry.error;
        const std::size_t before = part.mesh->triangles().size();
        part.mesh->halve(entry.edge(), changed);
        shown += part.weight * static_cast<double>(part.mesh->triangles().size() - before);
        push(entry.part, changed);
        if (error_of(entry.part, entry.edge()) == entry.error) push(entry);  // another was halved instead
        if (heap_.size() > room_) drop_outdated();
    }
}

}  // namespace vrut
