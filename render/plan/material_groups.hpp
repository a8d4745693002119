#pragma once

#include <vector>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// Moves opaque items of one material together, since drivers take long where uniforms of the fragment shader
/// change. Items whose boxes in view space come close keep their order: at equal depth the last one is in
/// front. So the image stays the same.
void group_by_material(std::vector<DrawItem>& items, const scene::Scene& scene);

}  // namespace vrut::plan
