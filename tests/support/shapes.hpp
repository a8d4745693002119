#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "scene/scene.hpp"

namespace vrut {

/// A geometry node to be: what the small scenes of tests and measurements are made of.
struct Part {
    scene::Id id = 0;
    scene::Geometry geometry;
    scene::Material material;
    glm::dmat4 matrix{1};
};

/// All parts under the root, in the order given; their materials may name the textures by their places.
std::shared_ptr<const scene::PlacedScene> scene_of(const std::vector<Part>& parts,
                                                   std::vector<scene::Texture> textures = {});

/// Nodes of one geometry under one matrix, one for each material, by rising id.
std::shared_ptr<const scene::PlacedScene> coincident_scene(const scene::Geometry& geometry,
                                                           std::vector<scene::Material> materials,
                                                           const glm::dmat4& matrix = glm::dmat4(1));

scene::Material material_of(const glm::dvec3& diffuse, const glm::dvec3& specular = glm::dvec3(0),
                            double shininess = 0);
inline const scene::Material kBronze = material_of({0.7, 0.5, 0.3});

/// In the plane z = 0, facing +z, from -half to half; `normals` are all +z.
scene::Geometry quad(double half, bool normals = true);
/// Around the origin, without normals, so that its faces are flat.
scene::Geometry box(const glm::dvec3& half);
/// Triangles between points of the sphere around the origin, with the sphere's normals there.
scene::Geometry sphere(double radius, int rings, bool normals = true);

/// A grid over the unit square, bent to where `at` has its points, without normals; its front is where the
/// cross product of the directions of u and v points.
scene::Geometry surface(unsigned columns, unsigned rows,
                        const std::function<glm::dvec3(double u, double v)>& at);

/// The same triangles, with every position moved: what the file would hold, not what a node does.
scene::Geometry mapped(scene::Geometry geometry, double scale, const glm::dvec3& offset);
/// The same triangles, with positions rounded to 2^-30, so that a sphere's seam and poles meet to the last
/// bit.
scene::Geometry welded(scene::Geometry geometry);
/// The same triangles seen from behind.
scene::Geometry turned_inside_out(scene::Geometry geometry);

glm::dmat4 moved_by(const glm::dvec3& offset);
glm::dmat4 scaled_by(const glm::dvec3& factors);
glm::dmat4 turned_by(double degrees, const glm::dvec3& axis);

}  // namespace vrut
