#pragma once

#include <span>

#include "gl/framebuffer.hpp"
#include "gl/programs.hpp"
#include "plan/view.hpp"

namespace vrut::gl {

/// Round signs of constant size in pixels over the image, each around its point: full where the point is
/// seen, and the fainter the more of its surroundings is hidden.
class MarkerPass {
public:
    explicit MarkerPass(Programs& programs) : programs_(programs) {}
    /// Whether the depth test can hide a point; in a wireframe it cannot.
    enum class MarkerFade { by_depth, none };

    /// `points` in view space, all before the eye, are drawn in that order into `target`, whose depth is the
    /// scene's; it is bound afterwards. Adds its draws to `stats`.
    void draw(std::span<const glm::dvec3> points, MarkerFade fade, const glm::dmat4& clip_from_view,
              const Framebuffer& target, plan::FrameStats& stats);

private:
    Programs& programs_;
    GlBuffer points_;
    GlVertexArray empty_vertex_array_;  ///< a sign's corners need no attributes
};

}  // namespace vrut::gl
