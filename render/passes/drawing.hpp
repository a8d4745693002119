#pragma once

#include "frame_plan.hpp"
#include "gpu_scene.hpp"
#include "view.hpp"

namespace vrut {

/// From here on the sides of an item that do not show are left out; `front_only`: of a two-sided one, too.
void cull_sides(const DrawItem& item, bool front_only = false);

/// Nothing outside the box is drawn or cleared, while GL_SCISSOR_TEST is enabled.
void scissor(const PixelBox& box);

/// With the current program; adds to the draws and triangles of `stats`.
void draw_triangles(const GpuGeometry& geometry, FrameStats& stats);
void draw_triangles(const GpuTriangles& triangles, FrameStats& stats);

}  // namespace vrut
