#pragma once

#include <functional>
#include <optional>

#include "measurement/snapping.hpp"
#include "mesh/picking.hpp"

namespace vrut::measurement {

/// What a ray hits of what is shown.
using FindHit = std::function<std::optional<mesh::Hit>(const mesh::Ray&)>;

/// Returns the best that snap() finds by the ray itself and by eight rays on the rim of its cone, so that a
/// finger beside an edge finds it. Of what those hit, points and planes do not count: they were not pointed
/// at. None where nothing is found.
std::optional<Snapped> snap_around(const scene::PlacedScene& placed, const mesh::Ray& ray,
                                   const FindHit& find_hit, const SnapOptions& options, MeshEdgesMemo& memo);

}  // namespace vrut::measurement
