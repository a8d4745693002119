#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "gl/framebuffer.hpp"
#include "gl/passes/drawing.hpp"
#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

/// Draws transparent faces whose order differs from pixel to pixel, by per-pixel linked lists. The fragments
/// that pass the depth test are appended to a list of their pixel. Then each list is composited from near to
/// far. Source: Yang, Hensley, Grün, Thibieroz, "Real-Time Concurrent Linked List Construction on the GPU",
/// EGSR 2010.
///
/// At equal depth the later item is in front, and within an item the later triangle of the index buffer. The
/// result does not depend on the order in which the GPU appends fragments, which OpenGL leaves undefined.
///
/// The buffer holds 8 fragments for each pixel of the image, but at most 64 MiB. If the lists need more,
/// the image is drawn box by box. Fragments are lost only if a single pixel needs more than the whole
/// buffer.
class PerPixelListsPass {
public:
    explicit PerPixelListsPass(Programs& programs) : programs_(programs) {}
    /// Begins to draw `items` of an image of size `image_size`, in pixels, within the box `within`. While
    /// is_drawing(), the caller collects all items and then composites them.
    void begin(std::span<const plan::DrawItem> items, const GpuScene& scene, const glm::dmat4& clip_from_view,
               const glm::ivec2& image_size, const math::PixelBox& within);
    bool is_drawing() const { return !pending_boxes_.empty(); }
    /// Returns the box of pixels that is drawn now.
    const math::PixelBox& box() const { return pending_boxes_.back(); }
    /// Appends the fragments of `items` to the lists. `first` items were collected before; 0 clears the
    /// lists. Adds to the draws and triangles of `stats`.
    void collect(std::span<const plan::DrawItem> items, std::size_t first, GpuScene& scene,
                 SurfacePrograms& programs, plan::FrameStats& stats);
    /// Composites the lists into the bound framebuffer. If they did not fit, it draws nothing and splits the
    /// box instead. Returns the number of fragments of the box.
    std::uint64_t composite(plan::FrameStats& stats);
    /// Ends drawing without a result.
    void abandon() { pending_boxes_.clear(); }
    /// Frees the buffers; begin() makes new ones.
    void release();

private:
    static constexpr std::size_t kFragmentBytes = 5 * sizeof(GLuint), kHeadBytes = 16;
    /// Returns the number of fragments that the buffer holds, for an image of so many pixels.
    static constexpr std::size_t max_fragments(std::size_t pixels) {
        return std::min(8 * pixels, (std::size_t{64} << 20) / kFragmentBytes);
    }

    void prepare(std::size_t pixels);
    void bind() const;
    void clear_lists() const;
    void blend(plan::FrameStats& stats);

    std::vector<math::PixelBox> pending_boxes_;  // the last is drawn first
    std::size_t pixels_ = 0;
    GLuint collected_triangles_ = 0;  ///< since the lists were cleared; modulo 2^32
    GlBuffer fragments_, heads_;
    GlBuffer count_;  ///< of the fragments, copied to be read
    Programs& programs_;
    GlVertexArray empty_vertex_array_;  ///< the corners of a full-screen triangle need no attributes
};

}  // namespace vrut::gl
