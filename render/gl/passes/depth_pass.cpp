#include "gl/passes/depth_pass.hpp"

#include "gl/passes/drawing.hpp"
#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

namespace {

/// Of what is seen through it, more is seen than of itself.
bool is_clear(const scene::Material& material, const plan::DrawItem& item) {
    return item.texture == scene::kNone && material.diffuse.a < 0.5;
}

}  // namespace

void DepthPass::draw(const plan::DrawLists& lists, GpuScene& scene, const glm::dmat4& clip_from_view,
                     int width, int height) {
    if (!target_ || target_->width() != width || target_->height() != height) target_.emplace(width, height);
    target_->bind();
    set_scissor({});
    PipelineState state;
    apply(state);
    glClear(GL_DEPTH_BUFFER_BIT);
    state.color_write = false;
    PlainProgram program(programs_, glm::dvec3(0), clip_from_view);
    plan::FrameStats not_counted;
    for (const plan::TransparentGroup& group : lists.transparent)
        for (const plan::DrawItem& item : group.items) {
            if (is_clear(scene.scene()->material(item.material), item)) continue;
            const GpuGeometry& geometry = scene.geometry(item);
            program.use(item, geometry);
            apply(state.for_item(item));
            draw_triangles(geometry, not_counted);
        }
}

const std::vector<float>& DepthPass::read() {
    depth_.resize(static_cast<std::size_t>(target_->width()) * static_cast<std::size_t>(target_->height()));
    target_->read_depth(0, depth_);
    return depth_;
}

}  // namespace vrut::gl
