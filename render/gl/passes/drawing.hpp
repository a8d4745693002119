#pragma once

#include <optional>
#include <span>

#include "gl/gpu_scene.hpp"
#include "plan/backface_culling.hpp"
#include "plan/frame_plan.hpp"
#include "plan/view.hpp"

namespace vrut::gl {

/// As many as every driver has. Fragments are discarded by further planes.
inline constexpr int kMostClipDistances = 8;

/// How fragments come to be and what becomes of them: all of it, so that a pass that declares it depends on
/// nothing that was drawn, or failed, before.
struct PipelineState {
    enum class Blend {
        none,
        premultiplied,  ///< colours that are multiplied by alpha
        alpha,
        add,
    };
    bool depth_test = true;
    GLenum depth_func = GL_GEQUAL;  ///< depth falls with distance
    bool depth_write = true;
    bool farthest = false;  ///< all fragments have the depth of the background
    bool color_write = true;
    Blend blend = Blend::none;
    bool cull_back = false;
    bool clockwise_front = false;
    bool behind_edges = false;  ///< polygon offset: edges on these faces pass the depth test
    int clip_distances = 0;     ///< that the program's vertices write

    /// The same, with the sides of an item that show; `front_only`: of a two-sided one, too.
    PipelineState for_item(const plan::DrawItem& item, bool front_only = false) const;
    /// The same, with the item's clip planes alone.
    PipelineState clipped_as(const plan::DrawItem& item) const;
};

/// Makes it that of the context.
void apply(const PipelineState& state);

/// What no pass changes. Begins all drawing on a thread.
void set_constant_state();

/// Nothing outside the box is drawn or cleared; none: everything is.
void set_scissor(const std::optional<math::PixelBox>& box);

/// With the current program; adds to the draws and triangles of `stats`.
void draw_triangles(const GpuGeometry& geometry, plan::FrameStats& stats);
void draw_triangles(const GpuGeometry& geometry, std::span<const plan::TriangleRange> ranges,
                    plan::FrameStats& stats);
void draw_triangles(const GpuTriangles& triangles, plan::FrameStats& stats);

}  // namespace vrut::gl
