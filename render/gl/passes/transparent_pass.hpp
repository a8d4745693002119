#pragma once

#include <span>

#include "gl/passes/surface_programs.hpp"

namespace vrut {

/// Faces of transparent materials over what is drawn already. They are tested against its depth and leave it
/// as it is.
class TransparentPass {
public:
    /// Draws `items` in their order into the bound framebuffer; adds its draws and triangles to `stats`.
    void draw(std::span<const DrawItem> items, GpuScene& scene, SurfacePrograms& programs, FrameStats& stats);
};

}  // namespace vrut
