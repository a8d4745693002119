#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gl/framebuffer.hpp"
#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

/// Flat mirrors. What is seen in one is drawn from the same eye with the scene reflected about its plane,
/// into a target like the picture's own, where it keeps its pixels; the surface then takes each pixel from
/// there. One target serves all mirrors in turn.
class MirrorPass {
public:
    explicit MirrorPass(Programs& programs) : programs_(programs) {}
    /// Which mirrors are seen from `clip_from_view` in the current target, behind nothing that has been drawn
    /// there.
    std::vector<bool> seen(std::span<const plan::MirrorItem> mirrors, GpuScene& scene,
                           const glm::dmat4& clip_from_view, plan::FrameStats& stats);
    /// Makes the target that a mirror's reflection is drawn into the current one, empty before `background`
    /// and open only at the pixels that the mirror can be seen at.
    void open(const plan::MirrorItem& mirror, GpuScene& scene, const glm::dmat4& clip_from_view,
              const glm::dvec3& background, const Framebuffer& picture, plan::FrameStats& stats);
    /// Makes that target the current one again.
    void bind(const plan::MirrorItem& mirror) const;
    /// Draws the surface, with what was drawn since, into `picture`, which is bound afterwards.
    void close(const plan::MirrorItem& mirror, GpuScene& scene, const Framebuffer& picture,
               SurfacePrograms& programs, plan::FrameStats& stats);
    /// Gives back what the driver holds for mirrors.
    void release() {
        target_.reset();
        queries_.clear();
    }

private:
    std::optional<Framebuffer> target_;
    Programs& programs_;
    std::vector<GlQuery> queries_;
};

}  // namespace vrut::gl
