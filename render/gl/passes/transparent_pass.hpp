#pragma once

#include <span>

#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

/// Faces of transparent materials over what is drawn already. They are tested against its depth and leave it
/// as it is.
class TransparentPass {
public:
    /// Draws `items` in their order into the bound framebuffer; adds its draws and triangles to `stats`.
    void draw(std::span<const plan::DrawItem> items, GpuScene& scene, SurfacePrograms& programs,
              plan::FrameStats& stats);
};

}  // namespace vrut::gl
