#pragma once

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// How many pixels a step of length 1 in the space of a node can be long in the picture, for a step that
/// starts or ends in the box and is seen in the picture; infinite where the box reaches to the eye.
double max_screen_space_scale(const glm::dmat4& view_from_node, const math::Bounds& box, const View& view);

/// Gives faces the coarsest levels of detail whose surfaces are, in pixels, no further from the scene's than
/// the view allows; those that keep every triangle the level 0, if there is one: all in a view whose detail
/// is 0, and what is textured. What is selected and glass whose triangles have an order take none. Parts with
/// one geometry and one matrix get one level, so that their depths are equal.
void select_levels(FramePlan& plan, const View& view);

/// Two-sided opaque parts that are closed are seen from outside only: their backs need not be drawn. The
/// picture stays as it is. Not where the eye or the near plane may be inside, or a mirror cuts the part.
void cull_backfaces(FramePlan& plan, const View& view);

}  // namespace vrut::plan
