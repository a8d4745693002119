#include "mesh/simplification.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/deviation.hpp"
#include "mesh/normal_deviation.hpp"

namespace vrut::mesh {

namespace {

constexpr std::size_t kFewest = 32;  ///< triangles of a level worth drawing instead
constexpr float kCoarsest = 0.1F;    ///< quadric error, of the extent

// Between the points that are measured the surface may lie further away than at any of them.
constexpr float kBetweenSamples = 1.25F;
// Of the radius: a fiftieth of a pixel where the geometry fills an image of 4000, and beyond float's
// rounding.
constexpr float kNegligible = 1e-5F;

/// Relative to the centre and in radii, so that float has room for any geometry.
std::vector<glm::vec3> normalized_positions(const scene::Geometry& geometry) {
    const glm::dvec3 center = geometry.bounds.center();
    const double radius = geometry.bounds.radius();
    std::vector<glm::vec3> result;
    result.reserve(geometry.positions.size());
    for (const glm::dvec3& position : geometry.positions)
        result.push_back(glm::vec3((position - center) / radius) + 0.0F);  // no -0, whose bytes are others
    return result;
}

constexpr unsigned kUnused = ~0U;

/// Numbers for vertices, the same for those that are equal in all streams, kUnused for those of no triangle;
/// sets how many numbers there are.
std::vector<unsigned> numbered(std::span<const meshopt_Stream> streams, const scene::Geometry& geometry,
                               std::size_t& count) {
    std::vector<unsigned> numbers(geometry.positions.size());
    count = meshopt_generateVertexRemapMulti(numbers.data(), &geometry.triangles[0].x,
                                             geometry.triangles.size() * 3, numbers.size(), streams.data(),
                                             streams.size());
    return numbers;
}

/// What is simplified: vertices that differ, each with the number of its position and of a vertex of the
/// geometry.
struct WorkingMesh {
    std::vector<glm::vec3> points;  ///< positions that differ
    std::vector<unsigned> point_of, vertex_of;
    std::vector<glm::uvec3> triangles;
};

WorkingMesh mesh_of(const scene::Geometry& geometry) {
    const std::vector<glm::vec3> positions = normalized_positions(geometry);
    std::vector<meshopt_Stream> streams{{positions.data(), sizeof(glm::vec3), sizeof(glm::vec3)}};
    std::size_t points = 0, vertices = 0;
    const std::vector<unsigned> point = numbered(streams, geometry, points);
    if (!geometry.normals.empty())
        streams.push_back({geometry.normals.data(), sizeof(glm::vec3), sizeof(glm::vec3)});
    if (!geometry.texcoords.empty())
        streams.push_back({geometry.texcoords.data(), sizeof(glm::vec2), sizeof(glm::vec2)});
    if (!geometry.colors.empty())
        streams.push_back({geometry.colors.data(), sizeof(glm::vec3), sizeof(glm::vec3)});
    const std::vector<unsigned> vertex = numbered(streams, geometry, vertices);

    WorkingMesh mesh{
        std::vector<glm::vec3>(points), std::vector<unsigned>(vertices), std::vector<unsigned>(vertices), {}};
    for (std::size_t i = positions.size(); i-- > 0;) {
        if (point[i] == kUnused) continue;
        mesh.points[point[i]] = positions[i];
        mesh.point_of[vertex[i]] = point[i];
        mesh.vertex_of[vertex[i]] = static_cast<unsigned>(i);
    }
    for (const glm::uvec3& t : geometry.triangles)
        if (point[t.x] != point[t.y] && point[t.y] != point[t.z] && point[t.z] != point[t.x])
            mesh.triangles.emplace_back(vertex[t.x], vertex[t.y], vertex[t.z]);
    return mesh;
}

/// Leaves out the vertices that are not used and orders the others as they are met.
void compact(WorkingMesh& mesh) {
    auto* indices = &mesh.triangles[0].x;
    const std::size_t count = mesh.triangles.size() * 3;
    std::vector<unsigned> remap(mesh.point_of.size());
    const std::size_t used = meshopt_optimizeVertexFetchRemap(remap.data(), indices, count, remap.size());
    for (std::vector<unsigned>* numbers : {&mesh.point_of, &mesh.vertex_of}) {
        meshopt_remapVertexBuffer(numbers->data(), numbers->data(), numbers->size(), sizeof(unsigned),
                                  remap.data());
        numbers->resize(used);
    }
    meshopt_remapIndexBuffer(indices, indices, count, remap.data());
}

std::vector<glm::uvec3> renamed(const std::vector<glm::uvec3>& triangles,
                                const std::vector<unsigned>& names) {
    std::vector<glm::uvec3> result;
    result.reserve(triangles.size());
    for (const glm::uvec3& t : triangles) result.emplace_back(names[t.x], names[t.y], names[t.z]);
    return result;
}

/// For each corner of the triangles, where the geometry has normals.
std::vector<glm::vec3> corner_normals(const WorkingMesh& mesh, const scene::Geometry& geometry) {
    std::vector<glm::vec3> result;
    if (geometry.normals.empty()) return result;
    result.reserve(mesh.triangles.size() * 3);
    for (const glm::uvec3& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) result.push_back(geometry.normals[mesh.vertex_of[t[k]]]);
    return result;
}

/// Leaves half the triangles, or as few as can be.
void halve(WorkingMesh& mesh) {
    std::vector<glm::vec3> positions;
    positions.reserve(mesh.point_of.size());
    for (const unsigned point : mesh.point_of) positions.push_back(mesh.points[point]);
    auto* indices = &mesh.triangles[0].x;
    const std::size_t count = mesh.triangles.size();
    const std::size_t left =
        meshopt_simplify(indices, indices, count * 3, &positions[0].x, positions.size(), sizeof(glm::vec3),
                         count / 2 * 3, kCoarsest, meshopt_SimplifyLockBorder, nullptr) /
        3;
    mesh.triangles.resize(left);
}

}  // namespace

std::vector<DetailLevel> simplify(const scene::Geometry& geometry, const std::atomic<bool>& stop) {
    std::vector<DetailLevel> levels;
    const double radius = geometry.bounds.radius();
    if (geometry.triangles.size() < 2 * kFewest || !(radius > 0) || !std::isfinite(radius)) return levels;
    WorkingMesh mesh = mesh_of(geometry);
    if (stop || mesh.triangles.empty()) return levels;
    compact(mesh);
    if (stop) return levels;
    const std::vector<glm::uvec3> original = renamed(mesh.triangles, mesh.point_of);
    std::vector<glm::uvec3> before = original;
    SurfaceDeviation deviation(mesh.points, original, kNegligible, stop);
    const NormalDeviation normal_deviation(mesh.points, original, corner_normals(mesh, geometry));
    float error = 0;
    while (!stop && before.size() >= 2 * kFewest) {
        halve(mesh);
        if (stop || mesh.triangles.empty() || 4 * mesh.triangles.size() > 3 * before.size()) break;
        compact(mesh);
        auto* indices = &mesh.triangles[0].x;
        if (stop) break;
        meshopt_optimizeVertexCache(indices, indices, mesh.triangles.size() * 3, mesh.point_of.size());
        std::vector<glm::uvec3> after = renamed(mesh.triangles, mesh.point_of);
        const auto moved = deviation.measure(before, after);
        if (!moved) break;
        error = std::max({error, *moved * kBetweenSamples,
                          normal_deviation.measure(deviation, after, corner_normals(mesh, geometry))});
        levels.push_back(
            {static_cast<int>(levels.size()) + 1, error * radius, renamed(mesh.triangles, mesh.vertex_of)});
        before = std::move(after);
    }
    return levels;
}

scene::Geometry geometry_of(const scene::Geometry& geometry, const DetailLevel& level) {
    scene::Geometry result;
    result.id = geometry.id;
    result.bounds = geometry.bounds;
    std::vector<unsigned> numbers(geometry.positions.size(), kUnused);
    result.triangles = level.triangles;
    for (glm::uvec3& triangle : result.triangles)
        for (int k = 0; k < 3; ++k) {
            const unsigned vertex = triangle[k];
            if (numbers[vertex] == kUnused) {
                numbers[vertex] = static_cast<unsigned>(result.positions.size());
                result.positions.push_back(geometry.positions[vertex]);
                if (!geometry.normals.empty()) result.normals.push_back(geometry.normals[vertex]);
                if (!geometry.texcoords.empty()) result.texcoords.push_back(geometry.texcoords[vertex]);
                if (!geometry.colors.empty()) result.colors.push_back(geometry.colors[vertex]);
            }
            triangle[k] = numbers[vertex];
        }
    return result;
}

}  // namespace vrut::mesh
