#include "gl/passes/drawing.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace vrut::gl {

namespace {

/// Of the context that is current on this thread since set_constant_state(). Few items are clipped: setting
/// all of them for each would take longer than the rest of the state.
thread_local int enabled_clip_distances = 0;

void enable(GLenum capability, bool enabled) { enabled ? glEnable(capability) : glDisable(capability); }

void count_draw(GLsizei indices, plan::FrameStats& stats) {
    ++stats.draws;
    stats.triangles += static_cast<std::uint64_t>(indices) / 3;
}

}  // namespace

PipelineState PipelineState::for_item(const plan::DrawItem& item, bool front_only) const {
    PipelineState state = clipped_as(item);
    state.cull_back = item.cull_mode != plan::CullMode::none || front_only;
    state.clockwise_front = item.mirrored;
    return state;
}

PipelineState PipelineState::clipped_as(const plan::DrawItem& item) const {
    PipelineState state = *this;
    state.clip_distances = std::min(static_cast<int>(item.clip_planes.size()), kMostClipDistances);
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
    for (; enabled_clip_distances < state.clip_distances; ++enabled_clip_distances)
        glEnable(GL_CLIP_DISTANCE0 + static_cast<GLenum>(enabled_clip_distances));
    for (; enabled_clip_distances > state.clip_distances; --enabled_clip_distances)
        glDisable(GL_CLIP_DISTANCE0 + static_cast<GLenum>(enabled_clip_distances - 1));
}

void set_constant_state() {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glClearDepth(0);
    for (int i = 0; i < kMostClipDistances; ++i) glDisable(GL_CLIP_DISTANCE0 + static_cast<GLenum>(i));
    enabled_clip_distances = 0;
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
    const plan::TriangleRange all{0, static_cast<std::size_t>(geometry.index_count) / 3};
    draw_triangles(geometry, {&all, 1}, stats);
}

void draw_triangles(const GpuGeometry& geometry, std::span<const plan::TriangleRange> ranges,
                    plan::FrameStats& stats) {
    glBindVertexArray(geometry.buffers->vertex_array.get());
    const auto offset_of = [&](const plan::TriangleRange& range) {
        const std::uintptr_t index = std::uintptr_t{geometry.first_index} + 3 * range.first;
        return std::bit_cast<const void*>(index * sizeof(unsigned));
    };
    if (ranges.size() == 1) {
        const auto indices = static_cast<GLsizei>(3 * ranges[0].count);
        glDrawElementsBaseVertex(GL_TRIANGLES, indices, GL_UNSIGNED_INT, offset_of(ranges[0]),
                                 geometry.first_vertex);
        return count_draw(indices, stats);
    }
    std::vector<GLsizei> counts;
    std::vector<const void*> offsets;
    GLsizei indices = 0;
    for (const plan::TriangleRange& range : ranges) {
        counts.push_back(static_cast<GLsizei>(3 * range.count));
        offsets.push_back(offset_of(range));
        indices += counts.back();
    }
    const std::vector<GLint> first_vertices(ranges.size(), geometry.first_vertex);
    glMultiDrawElementsBaseVertex(GL_TRIANGLES, counts.data(), GL_UNSIGNED_INT, offsets.data(),
                                  static_cast<GLsizei>(ranges.size()), first_vertices.data());
    count_draw(indices, stats);
}

void draw_triangles(const GpuTriangles& triangles, plan::FrameStats& stats) {
    glBindVertexArray(triangles.vertex_array.get());
    glDrawElements(GL_TRIANGLES, triangles.index_count, GL_UNSIGNED_INT, nullptr);
    count_draw(triangles.index_count, stats);
}

}  // namespace vrut::gl
