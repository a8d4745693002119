#include "gl/passes/opaque_pass.hpp"

#include "gl/passes/drawing.hpp"
#include "scene/colors.hpp"

namespace vrut::gl {

void OpaquePass::draw(std::span<const plan::DrawItem> items, GpuScene& scene, plan::DrawMode mode,
                      SurfacePrograms& programs, plan::FrameStats& stats) {
    const bool stylized = mode == plan::DrawMode::stylized;
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDisable(GL_BLEND);
    if (stylized) {
        // Depth falls with distance. A line's pixel lies up to half a pixel beside the line.
        glEnable(GL_POLYGON_OFFSET_FILL);
        glPolygonOffset(-1, -16);
    }
    for (const plan::DrawItem& item : items) {
        const GpuGeometry& geometry = scene.geometry(item);
        programs.use(SurfacePrograms::SurfaceKind::faces, item, geometry,
                     stylized ? scene::stylized_faces() : scene.scene()->material(item.material));
        set_cull_mode(item);
        draw_triangles(geometry, stats);
    }
    glDisable(GL_POLYGON_OFFSET_FILL);
}

void OpaquePass::reset_depth(std::span<const plan::DrawItem> items, GpuScene& scene,
                             const glm::dmat4& clip_from_view, plan::FrameStats& stats) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthRange(0, 0);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    use_solid_color(programs_, glm::dvec3(0), clip_from_view);
    for (const plan::DrawItem& item : items) {
        const GpuGeometry& geometry = scene.geometry(item);
        set_transform(item, geometry);
        set_cull_mode(item);
        draw_triangles(geometry, stats);
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthRange(0, 1);
}

}  // namespace vrut::gl
