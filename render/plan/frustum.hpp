#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/camera.hpp"

namespace vrut::plan {

/// An area of the image in normalized device coordinates: x and y from −1 (left, bottom) to 1 (right, top).
struct NdcRect {
    glm::dvec2 low{-1}, high{1};
};
/// Returns the area of the whole image, enlarged by some pixels on all sides.
NdcRect ndc_with_margin(int width, int height, double pixels);

/// The frustum of an area of the image, in view space: the points whose dot product with no normal is
/// negative. Without near and far planes.
struct Frustum {
    std::array<glm::dvec3, 5> normals;  ///< unit, pointing inwards: left, right, bottom, top, before the eye
};
/// `aspect` is width / height of the whole image.
Frustum frustum_of(const scene::Camera& camera, double aspect, const NdcRect& area = {});

/// Returns true if the transformed box lies entirely outside of one frustum plane, by more than the rounding
/// error of float positions. Conservative: a box beyond a corner of the image may be reported as inside.
bool is_outside(const Frustum& frustum, const glm::dmat4& view_from_node, const math::Bounds& box);

}  // namespace vrut::plan
