#include "shapes.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <stdexcept>

namespace vrut {

namespace {

void measure(scene::Geometry& geometry) {
    geometry.bounds = {};
    for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
}

}  // namespace

std::shared_ptr<const scene::PlacedScene> scene_of(const std::vector<Part>& given,
                                                   std::vector<scene::Texture> textures) {
    scene::SceneParts parts;
    parts.textures = std::move(textures);
    for (const Part& part : given) {
        const auto index = static_cast<scene::Index>(parts.nodes.size());
        parts.materials.push_back(part.material);
        parts.geometries.push_back(part.geometry);
        parts.nodes.push_back({scene::Node{part.id,
                                           {},
                                           scene::NodeType::geometry,
                                           scene::kNone,
                                           {},
                                           true,
                                           part.matrix,
                                           scene::GeometryData{index, index}},
                               0});
    }
    auto scene = scene::Scene::build(std::move(parts));
    if (!scene) throw std::logic_error(scene.error().message);
    return std::make_shared<scene::PlacedScene>(scene::place(*std::move(scene)));
}

std::shared_ptr<const scene::PlacedScene> coincident_scene(const scene::Geometry& geometry,
                                                           std::vector<scene::Material> materials,
                                                           const glm::dmat4& matrix) {
    scene::SceneParts parts;
    parts.geometries = {geometry};
    parts.materials = std::move(materials);
    for (scene::Index i = 0; i < static_cast<scene::Index>(parts.materials.size()); ++i)
        parts.nodes.push_back({scene::Node{i + 1,
                                           {},
                                           scene::NodeType::geometry,
                                           scene::kNone,
                                           {},
                                           true,
                                           matrix,
                                           scene::GeometryData{0, i}},
                               0});
    auto scene = scene::Scene::build(std::move(parts));
    if (!scene) throw std::logic_error(scene.error().message);
    return std::make_shared<scene::PlacedScene>(scene::place(*std::move(scene)));
}

scene::Material material_of(const glm::dvec3& diffuse, const glm::dvec3& specular, double shininess) {
    scene::Material material;
    material.diffuse = {diffuse, 1};
    material.specular = {specular, 1};
    material.shininess = shininess;
    return material;
}

scene::Geometry quad(double half, bool normals) {
    scene::Geometry geometry;
    geometry.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
    geometry.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (normals) geometry.normals.assign(4, glm::vec3(0, 0, 1));
    measure(geometry);
    return geometry;
}

scene::Geometry box(const glm::dvec3& half) {
    scene::Geometry geometry;
    for (const glm::dvec3& corner : math::corners({-half, half})) geometry.positions.push_back(corner);
    geometry.triangles = {{1, 3, 7}, {1, 7, 5}, {0, 4, 6}, {0, 6, 2}, {2, 6, 7}, {2, 7, 3},
                          {0, 1, 5}, {0, 5, 4}, {4, 5, 7}, {4, 7, 6}, {0, 2, 3}, {0, 3, 1}};
    measure(geometry);
    return geometry;
}

scene::Geometry sphere(double radius, int rings, bool normals) {
    scene::Geometry geometry;
    const int columns = 2 * rings;
    for (int ring = 0; ring <= rings; ++ring)
        for (int column = 0; column <= columns; ++column) {
            const double down = std::numbers::pi * ring / rings,
                         around = 2 * std::numbers::pi * column / columns;
            const glm::dvec3 out{std::sin(down) * std::sin(around), std::cos(down),
                                 std::sin(down) * std::cos(around)};
            geometry.positions.push_back(out * radius);
            if (normals) geometry.normals.emplace_back(out);
        }
    for (int ring = 0; ring < rings; ++ring)
        for (int column = 0; column < columns; ++column) {
            const auto at = static_cast<unsigned>(ring * (columns + 1) + column);
            const auto below = at + static_cast<unsigned>(columns) + 1;
            if (ring > 0) geometry.triangles.emplace_back(at, below, at + 1);
            if (ring < rings - 1) geometry.triangles.emplace_back(at + 1, below, below + 1);
        }
    measure(geometry);
    return geometry;
}

scene::Geometry surface(unsigned columns, unsigned rows,
                        const std::function<glm::dvec3(double u, double v)>& at) {
    scene::Geometry geometry;
    for (unsigned row = 0; row <= rows; ++row)
        for (unsigned column = 0; column <= columns; ++column) {
            geometry.positions.push_back(at(1.0 * column / columns, 1.0 * row / rows));
            if (row == rows || column == columns) continue;
            const unsigned here = row * (columns + 1) + column, above = here + columns + 1;
            geometry.triangles.emplace_back(here, here + 1, above + 1);
            geometry.triangles.emplace_back(here, above + 1, above);
        }
    measure(geometry);
    return geometry;
}

scene::Geometry mapped(scene::Geometry geometry, double scale, const glm::dvec3& offset) {
    for (glm::dvec3& position : geometry.positions) position = position * scale + offset;
    measure(geometry);
    return geometry;
}

scene::Geometry welded(scene::Geometry geometry) {
    for (glm::dvec3& position : geometry.positions) position = glm::round(position * 0x1p30) / 0x1p30;
    measure(geometry);
    return geometry;
}

scene::Geometry turned_inside_out(scene::Geometry geometry) {
    for (glm::uvec3& triangle : geometry.triangles) std::swap(triangle.y, triangle.z);
    return geometry;
}

glm::dmat4 moved_by(const glm::dvec3& offset) { return glm::translate(glm::dmat4(1), offset); }
glm::dmat4 scaled_by(const glm::dvec3& factors) { return glm::scale(glm::dmat4(1), factors); }
glm::dmat4 turned_by(double degrees, const glm::dvec3& axis) {
    return glm::rotate(glm::dmat4(1), glm::radians(degrees), axis);
}

}  // namespace vrut
