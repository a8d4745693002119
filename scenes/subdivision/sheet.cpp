#include "sheet.hpp"

#include <cmath>
#include <numeric>
#include <tuple>

#include "vectors.hpp"

namespace vrut {

namespace {

constexpr double kMicrometre = 1e6;  // in a metre
constexpr double kLeast = 0.18;    // cosine of about 80 degrees, between a corner's normal and its triangle's
constexpr double kNoArea = 1e-12;  // square metres, twice
constexpr double kNormalSteps = 1e4;  // of a normal's coordinate: a hundredth of a degree
constexpr double kAlikeNormals = 0.035;

}  // namespace

SharedCorners::SharedCorners(const AdaptiveMesh& mesh)
    : first(mesh.corners().size()), normals(mesh.corners().size()) {
    constexpr std::uint32_t kNoCorner = ~0U;
    const auto& corners = mesh.corners();
    std::vector<std::uint32_t> head(mesh.vertices().size(), kNoCorner), next(corners.size(), kNoCorner);
    for (std::uint32_t c = 0; c < corners.size(); ++c) {
        std::uint32_t* link = &head[corners[c].vertex];
        while (*link != kNoCorner && glm::distance(corners[*link].normal, corners[c].normal) > kAlikeNormals)
            link = &next[*link];
        if (*link == kNoCorner) *link = c;
        first[c] = *link;
        normals[*link] += glm::dvec3(corners[c].normal);
    }
    for (glm::dvec3& normal : normals) normal = unit_or_zero(normal);
}

std::size_t GeometryBuilder::Hash::operator()(const Key& key) const {
    std::size_t hash = key.number;
    for (const int n : key.normal) hash = hash * 0x9E3779B97F4A7C15U + static_cast<std::size_t>(n);
    return hash ^ (hash >> 29);
}

unsigned GeometryBuilder::number_of(const Vertex& vertex) {
    const glm::dvec3 steps = glm::round(vertex.normal * kNormalSteps);
    const Key key{vertex.number,
                  {static_cast<int>(steps.x), static_cast<int>(steps.y), static_cast<int>(steps.z)}};
    const auto [found, is_new] = numbers_.emplace(key, static_cast<unsigned>(geometry_.positions.size()));
    if (is_new) {
        geometry_.positions.push_back(vertex.position);
        geometry_.bounds.add(vertex.position);
        geometry_.normals.push_back(glm::vec3((steps + 0.0) / kNormalSteps));
        if (textured_) geometry_.texcoords.push_back(glm::round(vertex.texcoord * 1e5F) / 1e5F);
    }
    return found->second;
}

void GeometryBuilder::add(const std::array<Vertex, 3>& corners) {
    std::array<Vertex, 3> placed = corners;
    for (Vertex& vertex : placed)
        vertex.position = glm::round(vertex.position * kMicrometre) / kMicrometre + 0.0;  // and no -0
    const glm::dvec3 area =
        glm::cross(placed[1].position - placed[0].position, placed[2].position - placed[0].position);
    if (!(glm::length(area) > kNoArea)) return;
    // A limit surface that folds within a triangle has a normal there that looks away from the triangle.
    const glm::dvec3 face = glm::normalize(area);
    for (Vertex& vertex : placed)
        if (glm::dot(vertex.normal, face) < kLeast) vertex.normal = face;
    geometry_.triangles.emplace_back(number_of(placed[0]), number_of(placed[1]), number_of(placed[2]));
}

scene::Geometry geometry_of(const AdaptiveMesh& mesh, bool textured) {
    const SharedCorners shared(mesh);
    GeometryBuilder builder(textured);
    for (const int t : mesh.order()) {
        const auto& triangle = mesh.triangles()[static_cast<std::size_t>(t)];
        std::array<GeometryBuilder::Vertex, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.corners()[triangle.corners[k]].vertex;
            corners[k] = {vertex, mesh.vertices()[vertex].position,
                          shared.normals[shared.first[triangle.corners[k]]],
                          mesh.vertices()[vertex].texcoord};
        }
        builder.add(corners);
    }
    return builder.take();
}

}  // namespace vrut
