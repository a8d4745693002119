#include "gl/passes/transparent_pass.hpp"

#include "gl/passes/drawing.hpp"

namespace vrut::gl {

void TransparentPass::draw(std::span<const plan::DrawItem> items, GpuScene& scene, SurfacePrograms& programs,
                           plan::FrameStats& stats) {
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (const plan::DrawItem& item : items) {
        const GpuGeometry& geometry = scene.geometry(item);
        programs.use(SurfacePrograms::SurfaceKind::glass, item, geometry,
                     scene.scene()->material(item.material));
        glDepthFunc(item.occluded_by_coincident ? GL_GREATER : GL_GEQUAL);
        set_cull_mode(item, item.order != nullptr);
        if (item.order)
            draw_triangles(scene.sorted_triangles(item), stats);
        else
            draw_triangles(geometry, stats);
    }
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
}

}  // namespace vrut::gl
