#include "gl/passes/depth_pass.hpp"

#include "gl/passes/drawing.hpp"
#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

void DepthPass::draw(const plan::DrawLists& lists, const Framebuffer& target, GpuScene& scene,
                     const glm::dmat4& clip_from_view) {
    target.bind();
    set_scissor({});
    PipelineState state;
    state.color_write = false;
    SolidColorProgram program(programs_, glm::dvec3(0), clip_from_view);
    plan::FrameStats not_counted;
    for (const plan::TransparentGroup& group : lists.transparent)
        for (const plan::DrawItem& item : group.items) {
            const GpuGeometry& geometry = scene.geometry(item);
            program.use(item, geometry);
            apply(state.for_item(item));
            draw_triangles(geometry, not_counted);
        }
}

}  // namespace vrut::gl
