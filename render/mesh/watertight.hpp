#pragma once

#include <atomic>

#include "scene/scene.hpp"

namespace vrut::mesh {

/// Returns true if the surface bounds solids: at each edge two triangles meet that agree on the outside, and
/// each piece that hangs together by its edges has a positive volume and does not cross itself
/// (may_self_intersect()). From outside, the nearest of its triangles on any line of sight then shows its
/// front. Corners of equal position are one; triangles that use one twice do not count. Gives up, with false,
/// soon after `stop` is set.
bool is_watertight(const scene::Geometry& geometry, const std::atomic<bool>& stop);

}  // namespace vrut::mesh
