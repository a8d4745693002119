#include "gl/passes/transparent_pass.hpp"

#include "gl/passes/drawing.hpp"

namespace vrut::gl {

void TransparentPass::draw(std::span<const plan::DrawItem> items, GpuScene& scene, SurfacePrograms& programs,
                           plan::FrameStats& stats) {
    PipelineState state;
    state.depth_write = false;
    state.blend = PipelineState::Blend::premultiplied;
    for (const plan::DrawItem& item : items) {
        const GpuGeometry& geometry = scene.geometry(item);
        programs.use(SurfacePrograms::SurfaceKind::glass, item, geometry,
                     scene.scene()->material(item.material));
        state.depth_func = item.occluded_by_coincident ? GL_GREATER : GL_GEQUAL;
        apply(state.for_item(item, item.order != nullptr));
        if (item.order)
            draw_triangles(scene.sorted_triangles(item), stats);
        else
            draw_triangles(geometry, stats);
    }
}

}  // namespace vrut::gl
