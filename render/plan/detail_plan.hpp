#pragma once

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// Returns an upper bound of the length in pixels of a unit vector of node space that starts or ends in `box`
/// and is visible; infinite if the box reaches the eye.
double max_screen_space_scale(const glm::dmat4& view_from_node, const math::Bounds& box, const View& view);

/// Selects for each face the coarsest level of detail whose error stays within `view.detail` pixels. Level 0
/// (all triangles, reordered), if there is one, is used when `view.detail` is 0 and for textured items.
/// Selected items and glass with ordered triangles get no level. Items with equal geometry and matrix get the
/// same level, so that their depths are equal. Only resident levels are selected: where the view would select
/// another, that is noted in the plan, and a finer one, or none, stands in its place.
void select_levels(FramePlan& plan, const View& view, const IsResident& is_resident = {});

/// Culls the back faces of two-sided opaque items that are watertight: front faces of the same item hide
/// them, so the image does not change. Skipped where the eye or the near plane may be inside, or a mirror
/// clips the item.
void cull_backfaces(FramePlan& plan, const View& view);

}  // namespace vrut::plan
