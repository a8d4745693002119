#pragma once

#include <span>

#include "frame_plan.hpp"
#include "gpu_scene.hpp"
#include "view.hpp"

namespace vrut {

/// Opaque surfaces under Phong light, evaluated per pixel (Macků 2016, eq. 6.4–6.9 in their robust form).
class OpaquePass {
public:
    /// Draws into the bound framebuffer; adds its draws and triangles to `stats`.
    void draw(std::span<const DrawItem> items, GpuScene& scene, const glm::dmat4& clip_from_view,
              const Headlight& headlight, FrameStats& stats);

private:
    GlProgram program_;
};

}  // namespace vrut
