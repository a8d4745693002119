#include "gl/passes/edge_pass.hpp"

#include "gl/passes/drawing.hpp"
#include "scene/colors.hpp"

namespace vrut::gl {

namespace {

void draw_lines(const GpuEdges& edges, plan::FrameStats& stats) {
    if (edges.index_count == 0) return;  // triangles that are points
    glBindVertexArray(edges.vertex_array.get());
    glDrawElements(GL_LINES, edges.index_count, GL_UNSIGNED_INT, nullptr);
    ++stats.draws;
    stats.edges += static_cast<std::uint64_t>(edges.index_count) / 2;
}

}  // namespace

void EdgePass::draw(std::span<const plan::DrawItem> items, GpuScene& scene, plan::DrawMode mode,
                    const glm::dmat4& clip_from_view, SurfacePrograms& programs, plan::FrameStats& stats) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDisable(GL_BLEND);
    const bool stylized = mode == plan::DrawMode::stylized;
    glDepthMask(!stylized);  // of one colour, none hides another
    if (stylized) solid_color_.use(scene::kStylizedEdges, clip_from_view);
    for (const plan::DrawItem& item : items) {
        const GpuEdges* edges = scene.edges(item.geometry);
        stats.substitutes += edges == nullptr;
        if (!edges && stylized) continue;  // its faces are drawn
        const GpuGeometry& geometry = scene.geometry(item);
        if (stylized)
            set_transform(item, geometry);
        else
            programs.use(edges ? SurfacePrograms::SurfaceKind::edges : SurfacePrograms::SurfaceKind::faces,
                         item, geometry, scene.scene()->material(item.material));
        if (edges) {
            draw_lines(*edges, stats);
        } else {
            set_cull_mode(item);
            draw_triangles(geometry, stats);
        }
    }
    glDepthMask(GL_TRUE);
}

void EdgePass::draw_overlay(std::span<const plan::DrawItem> items, GpuScene& scene, const glm::dvec3& color,
                            const glm::dmat4& clip_from_view, plan::FrameStats& stats) {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    solid_color_.use(color, clip_from_view);
    for (const plan::DrawItem& item : items) {
        const GpuEdges* edges = scene.edges(item.geometry);
        stats.substitutes += edges == nullptr;
        if (!edges) continue;
        set_transform(item, scene.geometry(item));
        draw_lines(*edges, stats);
    }
}

}  // namespace vrut::gl
