#pragma once

#include <span>

#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

/// The edges of triangles as lines a pixel wide, each once. Those of back faces are drawn too. Of an item
/// whose edges are not resident, faces in its material stand in the place of realistic ones, and nothing in
/// that of others (FrameStats::substitutes).
class EdgePass {
public:
    explicit EdgePass(Programs& programs) : programs_(programs) {}
    /// In the style's colour, or in their materials under the view's light; hidden where a face stands before
    /// them. Draws into the bound framebuffer; adds its draws and edges to `stats`.
    void draw(std::span<const plan::DrawItem> items, GpuScene& scene, const scene::Style& style,
              const glm::dmat4& clip_from_view, SurfacePrograms& programs, plan::FrameStats& stats);
    /// The lines of items' cuts.
    void draw_cuts(std::span<const plan::DrawItem> items, GpuScene& scene, const glm::dmat4& clip_from_view,
                   plan::FrameStats& stats);
    /// In one colour, over everything.
    void draw_overlay(std::span<const plan::DrawItem> items, GpuScene& scene, const glm::dvec3& color,
                      const glm::dmat4& clip_from_view, plan::FrameStats& stats);

private:
    Programs& programs_;
};

}  // namespace vrut::gl
