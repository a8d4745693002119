#pragma once

#include <optional>
#include <span>

#include "gl/framebuffer.hpp"
#include "gl/passes/drawing.hpp"
#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

/// An outline around all that some nodes cover, of constant width in pixels, over everything. What they
/// cover, seen or hidden, is drawn as a mask; then each pixel outside that has some of it within the width is
/// coloured. The distance is found first along the rows and then down the columns: exact, and for a width w
/// 4w + 2 looks at a pixel.
class OutlinePass {
public:
    explicit OutlinePass(Programs& programs) : programs_(programs) {}
    /// Begins an outline around items in an image like `target`: each is to be covered before it is drawn.
    void begin(std::span<const plan::DrawItem> items, const GpuScene& scene, const glm::dmat4& clip_from_view,
               const Framebuffer& target);
    /// Draws items into the mask, which is bound afterwards; adds to the draws and triangles of `stats`.
    void draw_mask(std::span<const plan::DrawItem> items, GpuScene& scene, const glm::dmat4& clip_from_view,
                   plan::FrameStats& stats);
    /// Draws the outline into `target`, which is bound afterwards.
    void draw(const Framebuffer& target, plan::FrameStats& stats);

private:
    void prepare(const Framebuffer& target);

    struct Mask {
        Mask(int width, int height);
        int width, height;
        GlTexture covered, across;  ///< 1 inside; how far along the row to the nearest covered pixel
        GlFramebuffer covered_target, across_target;
    };
    std::optional<Mask> mask_;
    math::PixelBox box_;  ///< the outline, and all that it surrounds
    Programs& programs_;
    GlVertexArray empty_vertex_array_;  ///< the corners of a full-screen triangle need no attributes
};

/// Width of an outline in an image of that height: 2 pixels at 1 megapixel (1152 x 864).
int outline_width(int picture_height);

}  // namespace vrut::gl
