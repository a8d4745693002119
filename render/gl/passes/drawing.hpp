#pragma once

#include "gl/gpu_scene.hpp"
#include "plan/frame_plan.hpp"
#include "plan/view.hpp"

namespace vrut::gl {

/// All that drawing changes, as each pass expects it: what was drawn before may have failed in its midst.
void set_up_drawing();

/// From here on the sides of an item that do not show are left out; `front_only`: of a two-sided one, too.
void set_cull_mode(const plan::DrawItem& item, bool front_only = false);

/// Nothing outside the box is drawn or cleared, while GL_SCISSOR_TEST is enabled.
void scissor(const math::PixelBox& box);

/// With the current program; adds to the draws and triangles of `stats`.
void draw_triangles(const GpuGeometry& geometry, plan::FrameStats& stats);
void draw_triangles(const GpuTriangles& triangles, plan::FrameStats& stats);

}  // namespace vrut::gl
