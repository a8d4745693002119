#include "gl/passes/mirror_pass.hpp"

#include "gl/passes/drawing.hpp"

namespace vrut::gl {

void MirrorPass::query(std::span<const plan::MirrorItem> mirrors, GpuScene& scene,
                       const glm::dmat4& clip_from_view, plan::FrameStats& stats) {
    while (queries_.size() < mirrors.size()) queries_.push_back(make_query(GL_ANY_SAMPLES_PASSED));
    PlainProgram program(programs_, glm::dvec3(0), clip_from_view);
    PipelineState state;
    state.depth_write = false;
    state.color_write = false;
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
        const GpuGeometry& geometry = scene.geometry(mirrors[i].surface);
        program.use(mirrors[i].surface, geometry);
        apply(state.for_item(mirrors[i].surface));
        glBeginQuery(GL_ANY_SAMPLES_PASSED, queries_[i].get());
        draw_triangles(geometry, stats);
        glEndQuery(GL_ANY_SAMPLES_PASSED);
    }
    glFlush();  // the GPU begins while the first mirror is prepared
    ++stats.passes;
}

std::optional<bool> MirrorPass::seen(std::size_t index) const {
    GLuint available = 0, any = 0;
    glGetQueryObjectuiv(queries_[index].get(), GL_QUERY_RESULT_AVAILABLE, &available);
    if (!available) return {};
    glGetQueryObjectuiv(queries_[index].get(), GL_QUERY_RESULT, &any);
    return any != 0;
}

void MirrorPass::open(const plan::MirrorItem& mirror, GpuScene& scene, const glm::dmat4& clip_from_view,
                      const glm::dvec3& background, const Framebuffer& image_target,
                      plan::FrameStats& stats) {
    if (!target_ || target_->width() != image_target.width() || target_->height() != image_target.height() ||
        target_->rgba16() != image_target.rgba16()) {
        target_.reset();
        target_.emplace(image_target.width(), image_target.height(), image_target.rgba16());
    }
    bind(mirror);
    // Nothing comes before what is nearest; but at the mirror's pixels everything does.
    PipelineState state;
    state.depth_func = GL_ALWAYS;
    state.farthest = true;
    apply(state.for_item(mirror.surface));
    constexpr GLfloat kNearest = 1;
    glClearBufferfv(GL_DEPTH, 0, &kNearest);
    const GpuGeometry& geometry = scene.geometry(mirror.surface);
    PlainProgram(programs_, background, clip_from_view).use(mirror.surface, geometry);
    draw_triangles(geometry, stats);
}

void MirrorPass::bind(const plan::MirrorItem& mirror) const {
    target_->bind();
    set_scissor(mirror.box);
}

void MirrorPass::close(const plan::MirrorItem& mirror, GpuScene& scene, const Framebuffer& image_target,
                       SurfacePrograms& programs, plan::FrameStats& stats) {
    image_target.bind();
    set_scissor({});
    PipelineState state;
    state.depth_func = mirror.surface.occluded_by_coincident ? GL_GREATER : GL_GEQUAL;
    const GpuGeometry& geometry = scene.geometry(mirror.surface);
    programs.use(SurfacePrograms::SurfaceKind::mirror, mirror.surface, geometry,
                 scene.scene()->material(mirror.surface.material));
    glBindTextureUnit(SurfacePrograms::kReflectionUnit, target_->color().get());
    apply(state.for_item(mirror.surface));
    draw_triangles(geometry, stats);
    // What is bound for reading must not be what is drawn into next.
    glBindTextureUnit(SurfacePrograms::kReflectionUnit, 0);
    ++stats.passes;
}

}  // namespace vrut::gl
