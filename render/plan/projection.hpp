#pragma once

#include <array>
#include <glm/glm.hpp>

#include "plan/view.hpp"

namespace vrut::plan {

/// Projection with reversed depth: near / distance, 1 at the near plane, 0 at infinity. Float depth then has
/// the same relative precision at every distance. `offset` shifts the sample position, in pixels, y down.
glm::dmat4 reversed_clip_from_view(const View& view, double near, const glm::dvec2& offset = glm::dvec2(0));

/// Pixels from `low` to before `high`, y up.
struct PixelBox {
    glm::ivec2 low{0}, high{0};
    glm::ivec2 size() const { return high - low; }
    bool empty() const { return low.x >= high.x || low.y >= high.y; }
};
PixelBox intersection(const PixelBox& a, const PixelBox& b);

/// Returns the pixels that geometry within `bounds` can cover, with a projection of reversed depth; parts in
/// front of the near plane are ignored.
PixelBox pixel_box(const math::Bounds& bounds, const glm::dmat4& clip_from_node, const glm::ivec2& viewport);

}  // namespace vrut::plan
