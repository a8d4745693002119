// Scenes of any number of triangles.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "measure/experiments.hpp"

namespace vrut::server::measure {

namespace {

constexpr unsigned kAround = 100, kAcross = 100;  // of a ring: 20,000 triangles
constexpr double kRadius = 0.36, kThickness = 0.12;

scene::Geometry ring() {
    scene::Geometry geometry;
    geometry.id = 1;
    for (unsigned i = 0; i < kAround; ++i)
        for (unsigned k = 0; k < kAcross; ++k) {
            const double a = 2 * std::numbers::pi * i / kAround, b = 2 * std::numbers::pi * k / kAcross;
            const glm::dvec3 out(std::cos(a), 0, std::sin(a));
            const glm::dvec3 normal = out * std::cos(b) + glm::dvec3(0, std::sin(b), 0);
            geometry.positions.push_back(out * kRadius + normal * kThickness);
            geometry.normals.emplace_back(normal);
            geometry.bounds.add(geometry.positions.back());
            const unsigned i2 = (i + 1) % kAround, k2 = (k + 1) % kAcross;
            const unsigned corner[] = {i * kAcross + k, i * kAcross + k2, i2 * kAcross + k2,
                                       i2 * kAcross + k};
            geometry.triangles.emplace_back(corner[0], corner[1], corner[2]);
            geometry.triangles.emplace_back(corner[0], corner[2], corner[3]);
        }
    return geometry;
}

}  // namespace

std::vector<std::uint64_t> triangle_counts(std::uint64_t most) {
    std::vector<std::uint64_t> counts;
    for (const std::uint64_t count : {20'000u, 60'000u, 200'000u, 600'000u, 2'000'000u, 10'000'000u})
        if (counts.empty() || count <= most) counts.push_back(count);
    return counts;
}

std::shared_ptr<const scene::PlacedScene> rings(std::uint64_t triangles) {
    scene::SceneParts parts;
    parts.name = "Rings";
    parts.geometries.push_back(ring());
    const auto count = static_cast<unsigned>(triangles / parts.geometries.front().triangles.size());
    const auto in_row = static_cast<unsigned>(std::ceil(std::sqrt(count)));
    for (unsigned i = 0; i < count; ++i) {
        scene::SceneParts::PartNode part;
        part.node.id = i + 1;
        part.node.name = "Ring";
        part.node.type = scene::NodeType::geometry;
        part.node.matrix[3] = glm::dvec4(i % in_row, 0, i / in_row, 1);
        part.node.data = scene::GeometryData{0, scene::kNone};
        parts.nodes.push_back(std::move(part));
    }
    auto scene = scene::Scene::build(std::move(parts));
    if (!scene) throw std::logic_error(scene.error().message);
    return std::make_shared<const scene::PlacedScene>(scene::place(*std::move(scene)));
}

}  // namespace vrut::server::measure
