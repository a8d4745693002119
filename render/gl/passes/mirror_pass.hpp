#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gl/framebuffer.hpp"
#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

/// While it lives, the GPU waits for the query's result before it draws, and discards what is drawn if no
/// sample passed (OpenGL 4.5, section 10.9). The CPU does not wait.
class ConditionalRendering {
public:
    explicit ConditionalRendering(const GlQuery& query) {
        glBeginConditionalRender(query.get(), GL_QUERY_WAIT);
    }
    ~ConditionalRendering() { glEndConditionalRender(); }
    ConditionalRendering(const ConditionalRendering&) = delete;
    ConditionalRendering& operator=(const ConditionalRendering&) = delete;
};

/// Flat mirrors. What is seen in one is drawn from the same eye with the scene reflected about its plane,
/// into a target like the image's, where it keeps its pixels; the surface then takes each pixel from
/// there. One target serves all mirrors in turn.
class MirrorPass {
public:
    explicit MirrorPass(Programs& programs) : programs_(programs) {}
    /// Asks the GPU which mirrors are seen from `clip_from_view` in the current target, behind nothing that
    /// has been drawn there. The answers replace those of the query before.
    void query(std::span<const plan::MirrorItem> mirrors, GpuScene& scene, const glm::dmat4& clip_from_view,
               plan::FrameStats& stats);
    /// Returns true if mirror number `index` of the last query is seen; none while the GPU has not answered.
    /// Does not wait.
    std::optional<bool> seen(std::size_t index) const;
    /// While it lives, the GPU discards what is drawn if that mirror is not seen.
    ConditionalRendering while_seen(std::size_t index) const { return ConditionalRendering(queries_[index]); }
    /// Makes the target that a mirror's reflection is drawn into the current one, empty before `background`
    /// and open only at the pixels that the mirror can be seen at.
    void open(const plan::MirrorItem& mirror, GpuScene& scene, const glm::dmat4& clip_from_view,
              const glm::dvec3& background, const Framebuffer& image_target, plan::FrameStats& stats);
    /// Makes that target the current one again.
    void bind(const plan::MirrorItem& mirror) const;
    /// Draws the surface, with what was drawn since, into `image_target`, which is bound afterwards.
    void close(const plan::MirrorItem& mirror, GpuScene& scene, const Framebuffer& image_target,
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
