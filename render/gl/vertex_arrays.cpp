#include "gl/vertex_arrays.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace vrut::gl {

namespace {

/// For each position the lowest index of one that is the same, so that corners with normals of their own are
/// known as one.
std::vector<unsigned> first_with_same_position(const std::vector<glm::dvec3>& positions) {
    std::vector<unsigned> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto before = [&](unsigned a, unsigned b) {
        const glm::dvec3 &p = positions[a], &q = positions[b];
        return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
    };
    std::sort(order.begin(), order.end(), before);
    std::vector<unsigned> first(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

}  // namespace

VertexArrays make_arrays(const scene::Geometry& geometry, const glm::dvec3& origin) {
    const auto position = [&](unsigned i) { return glm::vec3(geometry.positions[i] - origin); };
    // Unit, so that float can square them.
    const auto normal = [&](unsigned i) {
        const glm::dvec3 given = geometry.normals.empty() ? glm::dvec3(0) : glm::dvec3(geometry.normals[i]);
        const double length = glm::length(given);
        return length > 0 ? glm::vec3(given / length) : glm::vec3(0);
    };

    VertexArrays arrays;
    bool all = !geometry.normals.empty();
    if (all) {
        arrays.vertices.reserve(geometry.positions.size());
        for (unsigned i = 0; i < geometry.positions.size(); ++i) {
            arrays.vertices.push_back({position(i), normal(i)});
            all = all && arrays.vertices.back().normal != glm::vec3(0);
        }
        arrays.corners.resize(arrays.vertices.size());
        std::iota(arrays.corners.begin(), arrays.corners.end(), 0U);
    }
    if (all) return arrays;
    arrays.triangles = geometry.triangles;
    for (glm::uvec3& triangle : arrays.triangles) {
        const glm::uvec3 corners = triangle;
        for (int k = 0; k < 3; ++k) {
            if (normal(corners[k]) != glm::vec3(0)) continue;
            const glm::dvec3& a = geometry.positions[corners[0]];
            const glm::dvec3 cross =
                glm::cross(geometry.positions[corners[1]] - a, geometry.positions[corners[2]] - a);
            const double length = glm::length(cross);
            triangle[k] = static_cast<unsigned>(arrays.vertices.size());
            arrays.vertices.push_back(
                {position(corners[k]), length > 0 ? glm::vec3(cross / length) : glm::vec3(0)});
            arrays.corners.push_back(corners[k]);
        }
    }
    return arrays;
}

const std::vector<glm::uvec3>& triangles_of(const VertexArrays& arrays, const scene::Geometry& geometry) {
    return arrays.triangles.empty() ? geometry.triangles : arrays.triangles;
}

std::vector<glm::vec2> texcoords_of(const std::vector<unsigned>& corners, const scene::Geometry& geometry) {
    std::vector<glm::vec2> result;
    result.reserve(corners.size());
    for (const unsigned corner : corners) result.push_back(geometry.texcoords[corner]);
    return result;
}

std::vector<glm::vec3> colors_of(const std::vector<unsigned>& corners, const scene::Geometry& geometry) {
    std::vector<glm::vec3> result;
    result.reserve(corners.size());
    for (const unsigned corner : corners) result.push_back(geometry.colors[corner]);
    return result;
}

std::vector<glm::vec3> low_positions_of(const std::vector<unsigned>& corners, const scene::Geometry& geometry,
                                        const glm::dvec3& origin) {
    std::vector<glm::vec3> low;
    low.reserve(corners.size());
    for (const unsigned corner : corners) {
        const glm::dvec3 position = geometry.positions[corner] - origin;
        low.emplace_back(position - glm::dvec3(glm::vec3(position)));
    }
    return low;
}

std::vector<glm::uvec2> unique_edges(const scene::Geometry& geometry,
                                     const std::vector<glm::uvec3>& vertices) {
    struct EdgeCandidate {
        glm::uvec2 corners;  // known as one, the lower first
        std::size_t number;
        glm::uvec2 vertices;
    };
    const std::vector<unsigned> representative = first_with_same_position(geometry.positions);
    std::vector<EdgeCandidate> edges;
    edges.reserve(vertices.size() * 3);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            const int next = (k + 1) % 3;
            const unsigned a = representative[geometry.triangles[i][k]],
                           b = representative[geometry.triangles[i][next]];
            if (a == b) continue;
            edges.push_back(
                {{std::min(a, b), std::max(a, b)}, edges.size(), {vertices[i][k], vertices[i][next]}});
        }
    const auto key = [](const EdgeCandidate& edge) {
        return std::tie(edge.corners.x, edge.corners.y, edge.number);
    };
    std::sort(edges.begin(), edges.end(),
              [&](const EdgeCandidate& a, const EdgeCandidate& b) { return key(a) < key(b); });
    std::vector<glm::uvec2> result;
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (i == 0 || edges[i].corners != edges[i - 1].corners) result.push_back(edges[i].vertices);
    return result;
}

}  // namespace vrut::gl
