#pragma once

#include <cstddef>
#include <vector>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// A geometry of so many triangles is small: the call that draws it takes longer than its triangles, so that
/// it is drawn together with others. Measured on llvmpipe.
inline constexpr std::size_t kMostTrianglesOfSmall = 256;

/// Returns true if one draw call can draw both as opaque items, should their geometries share buffers: they
/// have the same textures and sides, both or neither are clipped, have colours at their vertices or are lit
/// by metal and roughness, and none is emissive or mapped.
bool share_draw(const DrawItem& a, const DrawItem& b);

/// Moves opaque items together: small ones that share draws, and others of one material, since drivers take
/// long where uniforms of the fragment shader change. Items whose boxes in world space come close keep their
/// order: at equal depth the last one is in front. So the image stays the same.
void group_for_draws(std::vector<DrawItem>& items, const scene::PlacedScene& placed, const glm::dvec3& eye);

}  // namespace vrut::plan
