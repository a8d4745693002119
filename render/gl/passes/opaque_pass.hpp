#pragma once

#include <span>

#include "gl/passes/surface_programs.hpp"

namespace vrut {

/// Faces under the view's light: realistic ones in their materials, stylized ones all in the same, and a
/// little further away, so that their edges lie before them.
class OpaquePass {
public:
    /// Draws into the bound framebuffer; adds its draws and triangles to `stats`.
    void draw(std::span<const DrawItem> items, GpuScene& scene, DrawMode mode, SurfacePrograms& programs,
              FrameStats& stats);
    /// What was drawn before is behind these items from here on, wherever they cover it.
    void reset_depth(std::span<const DrawItem> items, GpuScene& scene, const glm::dmat4& clip_from_view,
                     FrameStats& stats);

private:
    SolidColorProgram solid_color_;
};

}  // namespace vrut
