#include "gl/passes/drawing.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace vrut::gl {

namespace {

void enable(GLenum capability, bool enabled) { enabled ? glEnable(capability) : glDisable(capability); }

void count_draw(GLsizei indices, plan::FrameStats& stats) {
    ++stats.draws;
    stats.triangles += static_cast<std::uint64_t>(indices) / 3;
}

}  // namespace

PipelineState PipelineState::for_item(const plan::DrawItem& item, bool front_only) const {
    PipelineState state = *this;
    state.cull_back = item.cull_mode != plan::CullMode::none || front_only;
    state.clockwise_front = item.mirrored;
    state.clipped = item.clip_plane.has_value();
    return state;
}

void apply(const PipelineState& state) {
    enable(GL_DEPTH_TEST, state.depth_test);
    glDepthFunc(state.depth_func);
    glDepthMask(state.depth_write);
    glDepthRange(0, state.farthest ? 0 : 1);
    glColorMask(state.color_write, state.color_write, state.color_write, state.color_write);
    enable(GL_BLEND, state.blend != PipelineState::Blend::none);
    const GLenum kept = state.blend == PipelineState::Blend::add ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA;
    glBlendFuncSeparate(state.blend == PipelineState::Blend::alpha ? GL_SRC_ALPHA : GL_ONE, kept, GL_ONE,
                        kept);
    enable(GL_CULL_FACE, state.cull_back);
    glFrontFace(state.clockwise_front ? GL_CW : GL_CCW);
    enable(GL_POLYGON_OFFSET_FILL, state.behind_edges);
    enable(GL_CLIP_DISTANCE0, state.clipped);
}

void set_constant_state() {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glClearDepth(0);
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    glDisable(GL_DITHER);
    glCullFace(GL_BACK);
    glPolygonOffset(-1, -16);
}

void set_scissor(const std::optional<math::PixelBox>& box) {
    enable(GL_SCISSOR_TEST, box.has_value());
    if (box) glScissor(box->low.x, box->low.y, std::max(box->size().x, 0), std::max(box->size().y, 0));
}

void draw_triangles(const GpuGeometry& geometry, plan::FrameStats& stats) {
    glBindVertexArray(geometry.buffers->vertex_array.get());
    const std::uintptr_t offset = std::uintptr_t{geometry.first_index} * sizeof(unsigned);
    glDrawElementsBaseVertex(GL_TRIANGLES, geometry.index_count, GL_UNSIGNED_INT,
                             std::bit_cast<const void*>(offset), geometry.first_vertex);
    count_draw(geometry.index_count, stats);
}

void draw_triangles(const GpuTriangles& triangles, plan::FrameStats& stats) {
    glBindVertexArray(triangles.vertex_array.get());
    glDrawElements(GL_TRIANGLES, triangles.index_count, GL_UNSIGNED_INT, nullptr);
    count_draw(triangles.index_count, stats);
}

}  // namespace vrut::gl
