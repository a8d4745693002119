#pragma once

#include <vector>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// Returns true if one draw call can draw both as opaque items, should their geometries share buffers: they
/// have the same textures and sides, and both or neither are clipped.
bool share_draw(const DrawItem& a, const DrawItem& b);

/// Moves opaque items together that share draws. Items whose boxes in view space come close keep their order:
/// at equal depth the last one is in front. So the image stays the same.
void group_for_draws(std::vector<DrawItem>& items, const scene::Scene& scene);

}  // namespace vrut::plan
