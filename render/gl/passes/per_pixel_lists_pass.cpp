#include "gl/passes/per_pixel_lists_pass.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace vrut::gl {

namespace {

/// Into so many parts of about the same size, one above the other, or beside it if the box is wider than
/// high; fewer where there are not so many pixels.
void split(const math::PixelBox& box, std::uint64_t parts, std::vector<math::PixelBox>& into) {
    const int along = box.size().x > box.size().y ? 0 : 1, length = box.size()[along];
    const int count = static_cast<int>(std::min(parts, static_cast<std::uint64_t>(length)));
    for (int i = 0; i < count; ++i) {
        math::PixelBox& part = into.emplace_back(box);
        part.low[along] = box.low[along] + length * i / count;
        part.high[along] = box.low[along] + length * (i + 1) / count;
    }
}

}  // namespace

void PerPixelListsPass::prepare(std::size_t pixels) {
    if (!empty_vertex_array_) empty_vertex_array_ = make_vertex_array();
    if (pixels == pixels_) return;
    release();
    fragments_ =
        make_buffer("transparent layers", nullptr, kHeadBytes + max_fragments(pixels) * kFragmentBytes);
    heads_ = make_buffer("lists of layers", nullptr, kHeadBytes + pixels * sizeof(GLuint));
    count_ = make_readback_buffer("counts of layers", sizeof(GLuint));
    pixels_ = pixels;
}

void PerPixelListsPass::release() {
    fragments_ = {};
    heads_ = {};
    count_ = {};
    pixels_ = 0;
}

void PerPixelListsPass::begin(std::span<const plan::DrawItem> items, const GpuScene& scene,
                              const glm::dmat4& clip_from_view, const glm::ivec2& image_size,
                              const math::PixelBox& within) {
    math::PixelBox all{image_size, {0, 0}};
    for (const plan::DrawItem& item : items) {
        const math::Bounds& bounds =
            scene.scene()->geometries()[static_cast<std::size_t>(item.geometry)].bounds;
        const math::PixelBox box = math::pixel_box(bounds, clip_from_view * item.view_from_node, image_size);
        all = {glm::min(all.low, box.low), glm::max(all.high, box.high)};
    }
    all = math::intersection(all, within);
    if (all.empty()) return;
    prepare(static_cast<std::size_t>(image_size.x) * static_cast<std::size_t>(image_size.y));
    pending_boxes_.push_back(all);
}

void PerPixelListsPass::bind() const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kFragmentsBinding, fragments_.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kHeadsBinding, heads_.get());
    set_scissor(box());
}

void PerPixelListsPass::clear_lists() const {
    const std::array<GLuint, 2> none{0, static_cast<GLuint>(max_fragments(pixels_))};
    glClearNamedBufferSubData(fragments_.get(), GL_RG32UI, 0, sizeof none, GL_RG_INTEGER, GL_UNSIGNED_INT,
                              none.data());
    const std::array<GLint, 4> place{box().low.x, box().low.y, box().size().x, box().size().y};
    glClearNamedBufferSubData(heads_.get(), GL_RGBA32I, 0, sizeof place, GL_RGBA_INTEGER, GL_INT,
                              place.data());
    glClearNamedBufferSubData(heads_.get(), GL_R32UI, kHeadBytes,
                              static_cast<GLsizeiptr>(sizeof(GLuint)) * box().size().x * box().size().y,
                              GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void PerPixelListsPass::collect(std::span<const plan::DrawItem> items, std::size_t first, GpuScene& scene,
                                SurfacePrograms& programs, plan::FrameStats& stats) {
    bind();
    if (first == 0) {
        clear_lists();
        collected_triangles_ = 0;
    }
    PipelineState state;
    state.depth_write = false;
    state.color_write = false;
    for (const plan::DrawItem& item : items) {
        const GpuGeometry& geometry = scene.geometry(item);
        programs.use(SurfacePrograms::SurfaceKind::per_pixel_glass, item, geometry,
                     scene.scene()->material(item.material));
        set_first_triangle(collected_triangles_);
        state.depth_func = item.occluded_by_coincident ? GL_GREATER : GL_GEQUAL;
        apply(state.for_item(item));
        draw_triangles(geometry, stats);
        collected_triangles_ += static_cast<GLuint>(geometry.index_count / 3);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

std::uint64_t PerPixelListsPass::composite(plan::FrameStats& stats) {
    GLuint fragment_count = 0;
    // Reading from the large buffer would make the driver move all of it into the CPU's memory.
    glCopyNamedBufferSubData(fragments_.get(), count_.get(), 0, 0, sizeof fragment_count);
    glGetNamedBufferSubData(count_.get(), 0, sizeof fragment_count, &fragment_count);
    const math::PixelBox box = pending_boxes_.back();
    pending_boxes_.pop_back();
    if (const std::size_t most = max_fragments(pixels_);
        fragment_count <= most || box.size() == glm::ivec2(1))
        blend(stats);
    else
        split(box, 2 + fragment_count / most, pending_boxes_);
    return fragment_count;
}

void PerPixelListsPass::blend(plan::FrameStats& stats) {
    PipelineState state;
    state.depth_test = false;
    state.depth_write = false;
    state.blend = PipelineState::Blend::premultiplied;
    apply(state);
    programs_.use(FixedProgram::composite_lists);
    glBindVertexArray(empty_vertex_array_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    // The lists are written again: Mesa's llvmpipe would not wait for this.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    ++stats.draws;
    ++stats.passes;
}

}  // namespace vrut::gl
