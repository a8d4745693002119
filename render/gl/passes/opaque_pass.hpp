#pragma once

#include <span>

#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

/// Faces under the view's light; where their edges are drawn, too, a little further away, so that these lie
/// before them.
class OpaquePass {
public:
    explicit OpaquePass(Programs& programs) : programs_(programs) {}
    /// Draws into the bound framebuffer; adds its draws and triangles to `stats`.
    void draw(std::span<const plan::DrawItem> items, const scene::Style& style, SurfacePrograms& programs,
              plan::FrameStats& stats);
    /// What was drawn before is behind these items from here on, wherever they cover it.
    void reset_depth(std::span<const plan::DrawItem> items, GpuScene& scene, const glm::dmat4& clip_from_view,
                     plan::FrameStats& stats);

private:
    Programs& programs_;
};

}  // namespace vrut::gl
