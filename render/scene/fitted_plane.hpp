#pragma once

#include <optional>

#include "math/plane.hpp"

namespace vrut::scene {

struct Geometry;

/// The plane in which a geometry lies: fitted to its triangles by their areas, and none of their corners is
/// further from it than 1e-4 of the geometry's radius. None where there is no such plane.
std::optional<math::Plane> fitted_plane(const Geometry& geometry);

}  // namespace vrut::scene
