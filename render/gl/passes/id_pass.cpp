#include "gl/passes/id_pass.hpp"

#include <stdexcept>

#include "gl/passes/drawing.hpp"

namespace vrut::gl {

namespace {

/// Integers with depth, used once.
struct Target {
    Target(int width, int height)
        : numbers(make_renderbuffer(GL_R32I, width, height)),
          depth(make_renderbuffer(GL_DEPTH_COMPONENT32F, width, height)),
          framebuffer(make_framebuffer()) {
        const GLuint name = framebuffer.get();
        glNamedFramebufferRenderbuffer(name, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, numbers.get());
        glNamedFramebufferRenderbuffer(name, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth.get());
        if (glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw std::runtime_error("no ids can be drawn: the driver refuses the framebuffer");
    }

    GlRenderbuffer numbers, depth;
    GlFramebuffer framebuffer;
};

}  // namespace

std::vector<scene::Index> IdPass::draw(std::span<const plan::DrawItem> items, GpuScene& scene, int width,
                                       int height, const glm::dmat4& clip_from_view) {
    const Target target(width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
    glViewport(0, 0, width, height);
    set_scissor({});
    const PipelineState state;
    apply(state);
    glClearBufferiv(GL_COLOR, 0, &scene::kNone);
    glClear(GL_DEPTH_BUFFER_BIT);
    PlainProgram program(programs_, {}, clip_from_view);
    plan::FrameStats stats;
    for (const plan::DrawItem& item : items) {
        const GpuGeometry& geometry = scene.geometry(item);
        program.use(item, geometry);
        apply(state.for_item(item));
        draw_triangles(geometry, stats);
    }
    std::vector<scene::Index> nodes(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_INT, nodes.data());
    return nodes;
}

}  // namespace vrut::gl
