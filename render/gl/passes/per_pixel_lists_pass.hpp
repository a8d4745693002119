#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "gl/framebuffer.hpp"
#include "gl/passes/drawing.hpp"
#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

/// Faces of transparent materials whose order changes from pixel to pixel. Those that the depth lets through
/// are kept in a list for each pixel, which is then composited from near to far. At equal depth the item that
/// comes later is in front, and of one item the triangle that comes later in the index buffer: the later one
/// of the file, unless a level of detail is drawn. The order in which the GPU appends fragments, which OpenGL
/// does not define, changes nothing. There is room for two layers in each pixel of the picture, but 64 MiB at
/// most; lists that need more are made for a part of the picture at a time, so that nothing is lost, unless a
/// single pixel needs more than all of it.
class PerPixelListsPass {
public:
    explicit PerPixelListsPass(Programs& programs) : programs_(programs) {}
    /// Begins to draw items within a box of a picture of that size: each is to be collected, and then all
    /// composited, again and again while it is drawing.
    void begin(std::span<const plan::DrawItem> items, const GpuScene& scene, const glm::dmat4& clip_from_view,
               const glm::ivec2& picture, const math::PixelBox& within);
    bool is_drawing() const { return !pending_boxes_.empty(); }
    /// The part of the picture for which items are collected.
    const math::PixelBox& box() const { return pending_boxes_.back(); }
    /// Adds items to the lists, of which `first` were added before; adds to the draws and triangles of
    /// `stats`.
    void collect(std::span<const plan::DrawItem> items, std::size_t first, GpuScene& scene,
                 SurfacePrograms& programs, plan::FrameStats& stats);
    /// Draws all that was collected into the bound target, or divides the box where it does not fit; how many
    /// layers there are.
    std::uint64_t composite(plan::FrameStats& stats);
    /// Gives up what it is drawing.
    void abandon() { pending_boxes_.clear(); }
    /// Gives its memory back until it draws again.
    void release();

private:
    static constexpr std::size_t kFragmentBytes = 5 * sizeof(GLuint), kHeadBytes = 16;
    /// Two in each pixel, but 64 MiB.
    static constexpr std::size_t max_fragments(std::size_t pixels) {
        return std::min(8 * pixels, (std::size_t{64} << 20) / kFragmentBytes);
    }

    void prepare(std::size_t pixels);
    void bind() const;
    void clear_lists() const;
    void blend(plan::FrameStats& stats);

    std::vector<math::PixelBox> pending_boxes_;  // the last one first
    std::size_t pixels_ = 0;
    GLuint collected_triangles_ = 0;  ///< since the lists were cleared; modulo 2^32
    GlBuffer fragments_, heads_;
    Programs& programs_;
    GlVertexArray empty_vertex_array_;  ///< the corners of a full-screen triangle need no attributes
};

}  // namespace vrut::gl
