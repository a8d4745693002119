#include "gl/passes/opaque_pass.hpp"

#include "gl/passes/drawing.hpp"

namespace vrut::gl {

void OpaquePass::draw(std::span<const plan::DrawItem> items, const scene::Style& style,
                      SurfacePrograms& programs, plan::FrameStats& stats) {
    PipelineState state;
    state.behind_edges = style.edges;
    programs.draw_faces(items, state, style.override_material ? &*style.override_material : nullptr, stats);
}

void OpaquePass::reset_depth(std::span<const plan::DrawItem> items, GpuScene& scene,
                             const glm::dmat4& clip_from_view, plan::FrameStats& stats) {
    PipelineState state;
    state.depth_func = GL_ALWAYS;
    state.farthest = true;
    state.color_write = false;
    PlainProgram program(programs_, glm::dvec3(0), clip_from_view);
    for (const plan::DrawItem& item : items) {
        const GpuGeometry& geometry = scene.geometry(item);
        program.use(item, geometry);
        apply(state.for_item(item));
        draw_triangles(geometry, stats);
    }
}

}  // namespace vrut::gl
