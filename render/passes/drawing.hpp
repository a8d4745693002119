#pragma once

#include "frame_plan.hpp"
#include "gpu_scene.hpp"
#include "view.hpp"

namespace vrut {

/// Pixels from `low` to before `high`, y up.
struct PixelBox {
    glm::ivec2 low{0}, high{0};
    glm::ivec2 size() const { return high - low; }
};

/// All that a part can cover, within the picture; everything where it reaches behind the eye.
PixelBox pixel_box(const DrawItem& item, const Scene& scene, const glm::dmat4& clip_from_view,
                   const glm::ivec2& picture);

/// From here on the sides of an item that do not show are left out.
void cull_sides(const DrawItem& item);

/// With the current program; adds to the draws and triangles of `stats`.
void draw_triangles(const GpuGeometry& geometry, FrameStats& stats);

}  // namespace vrut
