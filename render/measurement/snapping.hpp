#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "measurement/feature.hpp"
#include "measurement/mesh_edges.hpp"
#include "mesh/picking.hpp"
#include "scene/clip_plane.hpp"
#include "scene/scene.hpp"

namespace vrut::measurement {

struct SnapOptions {
    /// What is at most this far from the ray, in its distance along the ray, counts: the tangent of half a
    /// cone's angle.
    double radius = 0;
    std::vector<Snap> to = {};                           ///< empty: all but loops
    std::span<const scene::ClipPlane> clip_planes = {};  ///< what lies beyond is not found, and hides nothing
};

/// What a ray comes close to.
struct Snapped {
    Feature feature;
    glm::dvec3 point{0};  ///< the feature's first point, in the world
    /// At most 64 points in the world: the ends of an edge; a circle or a loop, closed; else none.
    std::vector<glm::dvec3> line;
    double offset = 0;  ///< from the ray to what is seen of the feature, in its distance along the ray
};

/// Returns the best feature of the part that was hit, within the ray's cone and 4 of its radii from the hit.
/// The first of these kinds, and of one kind the nearest to the ray: corners; midpoints of straight edges
/// whose ends are corners or turns; centers of circles, whose rim is near; loops; straight edges; vertices of
/// a coarse mesh, whose edges are longer than 4 radii; a plane, if the triangle is that large or lies in the
/// plane of a neighbour; the hit point. A circle is what fit_circle() accepts: a chain of feature edges; a
/// loop of at most 512 edges around a smooth face that nowhere turns by more than 40 degrees, as of a hole of
/// 9 or more segments; or the part of a chain around its edge that is nearest to the ray. Vertices of such a
/// loop are no corners, and no edge of a circle is straight. If `to` names kinds, they are not judged: each
/// vertex of the mesh, edge and plane counts. What lies behind the surface of the part is not found. `hit` is
/// the ray's, or that of a ray beside it in the cone, which finds an edge at whose outer side the ray passes.
/// None if nothing is there, or if the part is flattened.
std::optional<Snapped> snap(const scene::PlacedScene& placed, const mesh::Hit& hit, const mesh::Ray& ray,
                            const SnapOptions& options, MeshEdgesMemo& memo);

}  // namespace vrut::measurement
