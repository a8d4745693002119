#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "measurement/snap_around.hpp"
#include "mesh/picking.hpp"
#include "scene/scene.hpp"
#include "study.hpp"

namespace vrut::stability {

using Points = std::vector<glm::dvec3>;

/// Of the cone in which a pick finds features: the tangent of half its angle, and its radius at the part.
inline constexpr double kCone = 0.005, kEyeDistance = 5, kConeRadius = kCone * kEyeDistance;

/// A part whose top lies in z = 0, and its features there. A rim is a circle of radius 1 around the origin.
struct Solid {
    scene::Geometry geometry;
    double edge_length = 0;  ///< of the mesh where it is finest
    double depth = 0;
    Points corners;
    std::vector<Points> edges, other_edges;  ///< straight: the vertices in order; the others are not on top
    Points rim;                              ///< closed; there is one like it below
    std::vector<std::array<glm::dvec3, 3>> top, side;
};

/// A box of two triangles a face.
Solid coarse_box();
/// A square plate with a round hole of 32 edges.
Solid plate_with_hole();
/// A cylinder of 128 edges around, with a side of squares.
Solid fine_cylinder();

/// Distributed normally, of mean 0 and variance 1: the sum of twelve.
double gaussian(Noise& noise);

/// A solid whose vertices were moved by Gaussian noise of a deviation `sigma`; those of equal position are
/// moved together.
class NoisySolid {
public:
    NoisySolid(const Solid& solid, double sigma, Noise& noise);

    const scene::PlacedScene& placed() const { return *placed_; }
    glm::dvec3 moved(const glm::dvec3& position) const { return moved_.at(key(position)); }
    Points moved(const Points& positions) const;
    /// What a click at `at` snaps to.
    std::optional<measurement::Snapped> snapped(const glm::dvec3& at, const glm::dvec3& eye);

private:
    using Key = std::array<double, 3>;
    static Key key(const glm::dvec3& p) { return {p.x + 0.0, p.y + 0.0, p.z + 0.0}; }  // -0 is 0

    std::map<Key, glm::dvec3> moved_;
    std::shared_ptr<const scene::PlacedScene> placed_;
    measurement::MeshEdgesMemo memo_;
};

/// The same of any scene.
std::optional<measurement::Snapped> clicked(const scene::PlacedScene& placed, const glm::dvec3& at,
                                            const glm::dvec3& eye, measurement::MeshEdgesMemo& memo);

}  // namespace vrut::stability
