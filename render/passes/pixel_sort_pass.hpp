#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "framebuffer.hpp"
#include "passes/drawing.hpp"
#include "passes/programs.hpp"

namespace vrut {

/// Faces of transparent materials whose order changes from pixel to pixel. Those that the depth lets through
/// are kept in a list for each pixel, which is then composited from near to far; at equal depth the item that
/// comes later is in front. There is room for two layers in each pixel of the picture, but 64 MiB at most;
/// lists that need more are made for a part of the picture at a time, so that nothing is lost, unless a
/// single pixel needs more than all of it.
class PixelSortPass {
public:
    /// Draws into `target`, which is bound; adds its draws and triangles to `stats`, and a pass for each part
    /// of the picture.
    void draw(std::span<const DrawItem> items, GpuScene& scene, const glm::dmat4& clip_from_view,
              const Framebuffer& target, SurfacePrograms& programs, FrameStats& stats);
    /// Gives its memory back until it draws again.
    void release();

private:
    static constexpr std::size_t kLayerBytes = 5 * sizeof(GLuint), kHeadBytes = 16;
    /// Two in each pixel, but 64 MiB.
    static constexpr std::size_t most_layers(std::size_t pixels) {
        return std::min(8 * pixels, (std::size_t{64} << 20) / kLayerBytes);
    }

    void prepare(std::size_t pixels);
    /// Fills the lists of the pixels in `box`; how many layers they should hold, with those that do not fit.
    std::uint64_t collect(std::span<const DrawItem> items, const PixelBox& box, GpuScene& scene,
                          SurfacePrograms& programs, FrameStats& stats);
    void composite(FrameStats& stats);

    std::size_t pixels_ = 0;
    GlBuffer layers_, lists_;
    GlProgram composite_;
    GlVertexArray nothing_;  ///< the corners of a full-screen triangle need no attributes
};

}  // namespace vrut
