#pragma once

#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

/// An image or an environment map behind everything; a plain colour needs no pass.
class BackgroundPass {
public:
    explicit BackgroundPass(Programs& programs) : programs_(programs) {}
    static bool is_needed(const plan::View& view) {
        return view.scene && (view.background.shows_cube_map() || view.background.texture != scene::kNone);
    }
    /// Fills the bound framebuffer, whatever its depths, and leaves those as they are. An image is stretched
    /// over the view; of an environment map each pixel shows what lies in the direction of its ray.
    void draw(const CameraMatrices& camera, const plan::View& view, GpuScene& scene, plan::FrameStats& stats);

private:
    Programs& programs_;
    GlSampler clamped_;
    GlVertexArray empty_vertex_array_;  ///< the corners of a full-screen triangle need no attributes
};

}  // namespace vrut::gl
