#pragma once

#include <optional>

#include "math/plane.hpp"

namespace vrut::scene {

struct Geometry;

/// Returns the plane of a flat geometry: the fit to its triangles, weighted by area. None if a vertex is
/// further from the plane than 1e-4 of the geometry's radius.
std::optional<math::Plane> fitted_plane(const Geometry& geometry);

}  // namespace vrut::scene
