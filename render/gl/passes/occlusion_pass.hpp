#pragma once

#include <span>
#include <vector>

#include "gl/passes/surface_programs.hpp"
#include "plan/occlusion_culling.hpp"

namespace vrut::gl {

/// Occlusion queries of boxes, and the faces of culled items that are visible. These are drawn later than
/// their place in the order, which changes no pixel unless they have a depth in common with what is there.
class OcclusionPass {
public:
    explicit OcclusionPass(Programs& programs) : programs_(programs) {}
    /// Begins a sample. The numbers of its queries begin at 0.
    void begin() { used_ = 0; }
    /// Begins a query for each box: whether any of it passes the depth test of the current target, which does
    /// not change.
    void query(std::span<const plan::OcclusionBox> boxes, const glm::dmat4& clip_from_view);
    /// Draws the faces of items into the current target. Before each item begins a query: whether it has a
    /// depth in common with what is there. `programs` are those of the view.
    void draw_revealed(std::span<const plan::DrawItem> items, GpuScene& scene,
                       const glm::dmat4& clip_from_view, SurfacePrograms& programs, plan::FrameStats& stats);
    /// Returns true if anything passed in query number `index`. Waits for the GPU.
    bool passed(std::size_t index) const;

private:
    void begin_query();
    GpuGeometry cube_;
    Programs& programs_;
    std::vector<GlQuery> queries_;
    std::size_t used_ = 0;
};

}  // namespace vrut::gl
