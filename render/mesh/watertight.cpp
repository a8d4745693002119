#include "mesh/watertight.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

#include "mesh/self_intersection.hpp"
#include "mesh/union_find.hpp"
#include "mesh/vertex_adjacency.hpp"

namespace vrut::mesh {

namespace {

/// Of the sum of what a volume is added up from: more than its rounding.
constexpr double kLeastVolume = 1e-9;

/// With the first corner of each position in the place of all.
std::vector<glm::uvec3> with_merged_positions(const scene::Geometry& geometry) {
    std::vector<glm::dvec3> positions = geometry.positions;
    for (glm::dvec3& position : positions) position += 0.0;  // no -0, whose bytes are others
    std::vector<unsigned> numbers(positions.size());
    meshopt_generateVertexRemap(numbers.data(), &geometry.triangles[0].x, geometry.triangles.size() * 3,
                                positions.data(), positions.size(), sizeof(glm::dvec3));
    std::vector<unsigned> first(positions.size());
    for (std::size_t i = positions.size(); i-- > 0;)
        if (numbers[i] < first.size()) first[numbers[i]] = static_cast<unsigned>(i);
    std::vector<glm::uvec3> triangles;
    triangles.reserve(geometry.triangles.size());
    for (const glm::uvec3& t : geometry.triangles) {
        const glm::uvec3 u(first[numbers[t.x]], first[numbers[t.y]], first[numbers[t.z]]);
        if (u.x != u.y && u.y != u.z && u.z != u.x) triangles.push_back(u);
    }
    return triangles;
}

/// An edge's other end, and the triangle on one of its sides.
struct HalfEdge {
    unsigned end, triangle;
    bool operator<(const HalfEdge& other) const { return end < other.end; }
};

/// The edges that leave a vertex and those that come to it, each in the triangle to its left.
struct IncidentHalfEdges {
    std::vector<HalfEdge> out, in;
    void gather(unsigned vertex, const VertexAdjacency& adjacency, std::span<const glm::uvec3> triangles) {
        out.clear();
        in.clear();
        for (const unsigned number : adjacency.of(vertex)) {
            const glm::uvec3& t = triangles[number];
            const int at = t.x == vertex ? 0 : t.y == vertex ? 1 : 2;
            out.push_back({t[(at + 1) % 3], number});
            in.push_back({t[(at + 2) % 3], number});
        }
        std::sort(out.begin(), out.end());
        std::sort(in.begin(), in.end());
    }
    /// Each of `out` is one of `in`, and none is there twice.
    bool are_paired() const {
        for (std::size_t i = 0; i < out.size(); ++i)
            if (out[i].end != in[i].end || (i > 0 && out[i].end == out[i - 1].end)) return false;
        return true;
    }
};

bool unite_across_edges(std::span<const glm::uvec3> triangles, std::size_t vertex_count,
                        UnionFind& components, const std::atomic<bool>& stop) {
    const VertexAdjacency adjacency(triangles, vertex_count);
    IncidentHalfEdges incident;
    for (unsigned vertex = 0; vertex < vertex_count; ++vertex) {
        incident.gather(vertex, adjacency, triangles);
        if (stop || !incident.are_paired()) return false;
        for (std::size_t i = 0; i < incident.out.size(); ++i)
            components.unite(incident.out[i].triangle, incident.in[i].triangle);
    }
    return true;
}

bool have_positive_volume(const scene::Geometry& geometry, std::span<const glm::uvec3> triangles,
                          UnionFind& components) {
    std::vector<double> sum(triangles.size()), magnitude(triangles.size());
    for (unsigned i = 0; i < triangles.size(); ++i) {
        const unsigned piece = components.find(i);
        const auto from_piece = [&](unsigned vertex) {
            return geometry.positions[vertex] - geometry.positions[triangles[piece].x];
        };
        const glm::uvec3& t = triangles[i];
        const double volume = glm::dot(from_piece(t.x), glm::cross(from_piece(t.y), from_piece(t.z)));
        sum[piece] += volume;
        magnitude[piece] += std::abs(volume);
    }
    for (unsigned i = 0; i < triangles.size(); ++i)
        if (components.find(i) == i && !(sum[i] > kLeastVolume * magnitude[i])) return false;
    return true;
}

}  // namespace

bool is_watertight(const scene::Geometry& geometry, const std::atomic<bool>& stop) {
    if (stop || geometry.triangles.empty()) return false;
    const std::vector<glm::uvec3> triangles = with_merged_positions(geometry);
    if (stop || triangles.empty()) return false;
    UnionFind components(triangles.size());
    if (!unite_across_edges(triangles, geometry.positions.size(), components, stop) ||
        !have_positive_volume(geometry, triangles, components))
        return false;
    std::vector<unsigned> component_of(triangles.size());
    for (unsigned i = 0; i < triangles.size(); ++i) component_of[i] = components.find(i);
    return !may_self_intersect(geometry.positions, triangles, component_of, stop);
}

}  // namespace vrut::mesh
