#pragma once

#include <glm/glm.hpp>

#include "math/bounds.hpp"

namespace vrut::math {

/// Pixels from `low` to before `high`, y up.
struct PixelBox {
    glm::ivec2 low{0}, high{0};
    glm::ivec2 size() const { return high - low; }
    bool empty() const { return low.x >= high.x || low.y >= high.y; }
};
PixelBox intersection(const PixelBox& a, const PixelBox& b);

/// All that something within `bounds` can cover of an image, whose clip space is a reversed one; what lies
/// before the near plane counts for nothing.
PixelBox pixel_box(const Bounds& bounds, const glm::dmat4& clip_from_node, const glm::ivec2& viewport);

}  // namespace vrut::math
