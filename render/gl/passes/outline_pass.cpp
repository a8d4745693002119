#include "gl/passes/outline_pass.hpp"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <stdexcept>

#include "scene/style.hpp"

namespace vrut::gl {

namespace {

enum OutlineUniform : GLint { outline_width_at = 0, outline_color_at = 1, outline_box_at = 2 };

GlFramebuffer make_target(const GlTexture& texture) {
    GlFramebuffer framebuffer = make_framebuffer();
    glNamedFramebufferTexture(framebuffer.get(), GL_COLOR_ATTACHMENT0, texture.get(), 0);
    if (glCheckNamedFramebufferStatus(framebuffer.get(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("no outline can be drawn: the driver refuses the framebuffer");
    return framebuffer;
}

PipelineState over_everything() {
    PipelineState state;
    state.depth_test = false;
    return state;
}

void use(Programs& programs, FixedProgram program, int width, const math::PixelBox& box,
         const GlTexture& texture) {
    programs.use(program);
    glUniform1i(outline_width_at, width);
    glUniform4i(outline_box_at, box.low.x, box.low.y, box.high.x, box.high.y);
    glBindTextureUnit(0, texture.get());
}

math::PixelBox box_of(const plan::DrawItem& item, const GpuScene& scene, const glm::dmat4& clip_from_view,
                      const glm::ivec2& image_size) {
    const math::Bounds& bounds = scene.scene()->geometries()[static_cast<std::size_t>(item.geometry)].bounds;
    return math::pixel_box(bounds, clip_from_view * item.view_from_node, image_size);
}

}  // namespace

int outline_width(int picture_height) { return std::clamp((picture_height + 431) / 432, 1, 200); }

OutlinePass::Mask::Mask(int mask_width, int mask_height)
    : width(mask_width),
      height(mask_height),
      covered(make_texture(GL_R8, width, height)),
      across(make_texture(GL_R8, width, height)),
      covered_target(make_target(covered)),
      across_target(make_target(across)) {}

void OutlinePass::prepare(const Framebuffer& target) {
    if (!mask_ || mask_->width != target.width() || mask_->height != target.height()) {
        mask_.reset();
        mask_.emplace(target.width(), target.height());
    }
    if (!empty_vertex_array_) empty_vertex_array_ = make_vertex_array();
}

void OutlinePass::begin(std::span<const plan::DrawItem> items, const GpuScene& scene,
                        const glm::dmat4& clip_from_view, const Framebuffer& target) {
    prepare(target);
    const glm::ivec2 image_size{target.width(), target.height()};
    const int width = outline_width(target.height());
    box_ = {image_size, {0, 0}};
    for (const plan::DrawItem& item : items) {
        const math::PixelBox box = box_of(item, scene, clip_from_view, image_size);
        box_ = {glm::min(box_.low, box.low - width), glm::max(box_.high, box.high + width)};
    }
    box_ = {glm::max(box_.low, 0), glm::min(box_.high, image_size)};
    glBindFramebuffer(GL_FRAMEBUFFER, mask_->covered_target.get());
    set_scissor(box_);
    apply(PipelineState());
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
}

void OutlinePass::draw_mask(std::span<const plan::DrawItem> items, GpuScene& scene,
                            const glm::dmat4& clip_from_view, plan::FrameStats& stats) {
    const glm::ivec2 image_size{mask_->width, mask_->height};
    glBindFramebuffer(GL_FRAMEBUFFER, mask_->covered_target.get());
    apply(over_everything());
    set_scissor(box_);
    glClearColor(1, 1, 1, 1);
    PlainProgram program(programs_, glm::dvec3(1), clip_from_view);
    for (const plan::DrawItem& item : items) {
        const GpuGeometry& geometry = scene.geometry(item);
        program.use(item, geometry);
        apply(over_everything().clipped_as(item));
        draw_triangles(geometry, stats);
        // So small that it may miss all centres of pixels: it is found all the same.
        const math::PixelBox box = box_of(item, scene, clip_from_view, image_size);
        if (box.size().x > 2 || box.size().y > 2) continue;
        set_scissor(box);
        glClear(GL_COLOR_BUFFER_BIT);
        set_scissor(box_);
    }
}

void OutlinePass::draw(const Framebuffer& target, plan::FrameStats& stats) {
    const int width = outline_width(target.height());
    apply(over_everything());
    set_scissor(box_);
    glBindVertexArray(empty_vertex_array_.get());
    glBindFramebuffer(GL_FRAMEBUFFER, mask_->across_target.get());
    use(programs_, FixedProgram::row_distance, width, box_, mask_->covered);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    target.bind();
    use(programs_, FixedProgram::outline, width, box_, mask_->across);
    const glm::vec3 color(scene::kSelection);
    glUniform3fv(outline_color_at, 1, glm::value_ptr(color));
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindTextureUnit(0, 0);
    set_scissor({});
    stats.draws += 2;
    ++stats.passes;
}

}  // namespace vrut::gl
