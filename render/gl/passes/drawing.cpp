#include "gl/passes/drawing.hpp"

#include <algorithm>

namespace vrut::gl {

void set_up_drawing() {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glClearDepth(0);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    glDisable(GL_DITHER);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CLIP_DISTANCE0);
    glDepthMask(GL_TRUE);
    glDepthRange(0, 1);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void set_cull_mode(const plan::DrawItem& item, bool front_only) {
    if (item.cull_mode == plan::CullMode::none && !front_only)
        glDisable(GL_CULL_FACE);
    else
        glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(item.mirrored ? GL_CW : GL_CCW);
}

void scissor(const math::PixelBox& box) {
    glScissor(box.low.x, box.low.y, std::max(box.size().x, 0), std::max(box.size().y, 0));
}

namespace {

void draw_indices(const GlVertexArray& vertex_array, GLsizei count, plan::FrameStats& stats) {
    glBindVertexArray(vertex_array.get());
    glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, nullptr);
    ++stats.draws;
    stats.triangles += static_cast<std::uint64_t>(count) / 3;
}

}  // namespace

void draw_triangles(const GpuGeometry& geometry, plan::FrameStats& stats) {
    draw_indices(geometry.vertex_array, geometry.index_count, stats);
}

void draw_triangles(const GpuTriangles& triangles, plan::FrameStats& stats) {
    draw_indices(triangles.vertex_array, triangles.index_count, stats);
}

}  // namespace vrut::gl
