#pragma once

#include <array>
#include <glm/glm.hpp>

#include "plan/view.hpp"

namespace vrut::plan {

/// Distance of the plane before which nothing is drawn, in the scene's unit: a 128th of the near plane that
/// hosts are told (scene::fit_clip_range()), that is at most 10⁻⁸ of far where the eye is within the scene.
double near_distance(const View& view);

/// What the GPU clips and tests against: depth is near / distance, 1 at the near plane and 0 at infinity,
/// which gives float depth the same relative precision everywhere. `offset` moves the sample, in pixels, y
/// down.
glm::dmat4 reversed_clip_from_view(const View& view, double near, const glm::dvec2& offset = glm::dvec2(0));

/// Pixels from `low` to before `high`, y up.
struct PixelBox {
    glm::ivec2 low{0}, high{0};
    glm::ivec2 size() const { return high - low; }
    bool empty() const { return low.x >= high.x || low.y >= high.y; }
};
PixelBox intersection(const PixelBox& a, const PixelBox& b);

/// All that something within `bounds` can cover of a picture, whose clip space is a reversed one; what lies
/// before the near plane counts for nothing.
PixelBox pixel_box(const math::Bounds& bounds, const glm::dmat4& clip_from_node, const glm::ivec2& viewport);

}  // namespace vrut::plan
