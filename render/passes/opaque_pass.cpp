#include "passes/opaque_pass.hpp"

#include "passes/colors.hpp"

namespace vrut {

namespace {

void set_sides(const DrawItem& item) {
    if (item.sides == Sides::both)
        glDisable(GL_CULL_FACE);
    else
        glEnable(GL_CULL_FACE);
    glFrontFace(item.mirrored ? GL_CW : GL_CCW);
}

}  // namespace

void OpaquePass::draw(std::span<const DrawItem> items, GpuScene& scene, const View& view,
                      const glm::dmat4& clip_from_view, FrameStats& stats) {
    const bool stylized = view.mode == DrawMode::stylized;
    programs_.use(view, clip_from_view);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDisable(GL_BLEND);
    glCullFace(GL_BACK);
    if (stylized) {
        // Depth falls with distance. A line's pixel lies up to half a pixel beside the line.
        glEnable(GL_POLYGON_OFFSET_FILL);
        glPolygonOffset(-1, -16);
    }
    for (const DrawItem& item : items) {
        const GpuGeometry& geometry = scene.geometry(item.geometry);
        set_surface(item, geometry, stylized ? stylized_faces() : scene.scene()->material(item.material));
        set_sides(item);
        glBindVertexArray(geometry.vertex_array.get());
        glDrawElements(GL_TRIANGLES, geometry.index_count, GL_UNSIGNED_INT, nullptr);
        ++stats.draws;
        stats.triangles += static_cast<std::uint64_t>(geometry.index_count) / 3;
    }
    glDisable(GL_POLYGON_OFFSET_FILL);
    ++stats.passes;
}

}  // namespace vrut
