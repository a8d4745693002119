#pragma once

#include <atomic>

#include "scene/scene.hpp"

namespace vrut::mesh {

/// Returns true if the surface is watertight: every edge joins two triangles of consistent winding, and every
/// connected component has a positive volume. Seen from outside, the nearest triangle then is front-facing.
/// Vertices of equal position are merged, degenerate triangles ignored. Self-intersections that turn a part
/// inside out are not detected. Returns false soon after `stop` is set.
bool is_watertight(const scene::Geometry& geometry, const std::atomic<bool>& stop);

}  // namespace vrut::mesh
