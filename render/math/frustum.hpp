#pragma once

#include <array>
#include <glm/glm.hpp>

#include "math/bounds.hpp"
#include "math/projection.hpp"

namespace vrut::math {

/// What a projection sees, in view space: the points before the eye with which no normal has a negative
/// product. Without near and far.
struct Frustum {
    std::array<glm::dvec3, 5> normals;  ///< unit, pointing inwards: left, right, bottom, top, before the eye
};
Frustum frustum_of(const Projection& projection);

/// Returns true if the transformed box lies entirely outside of one frustum plane, by more than the rounding
/// error of float positions. Conservative: a box beyond a corner of the image may be reported as inside.
bool is_outside(const Frustum& frustum, const glm::dmat4& view_from_node, const Bounds& box);

}  // namespace vrut::math
