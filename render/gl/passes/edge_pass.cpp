#include "gl/passes/edge_pass.hpp"

#include <optional>

#include "gl/passes/drawing.hpp"

namespace vrut::gl {

namespace {

const glm::dvec3 kCutColor(0.1);

void draw_lines(const GpuEdges& edges, plan::FrameStats& stats) {
    if (edges.index_count == 0) return;  // triangles that are points
    glBindVertexArray(edges.vertex_array.get());
    glDrawElements(GL_LINES, edges.index_count, GL_UNSIGNED_INT, nullptr);
    ++stats.draws;
    stats.edges += static_cast<std::uint64_t>(edges.index_count) / 2;
}

}  // namespace

void EdgePass::draw(std::span<const plan::DrawItem> items, GpuScene& scene, const scene::Style& style,
                    const glm::dmat4& clip_from_view, SurfacePrograms& programs, plan::FrameStats& stats) {
    PipelineState state;
    state.depth_write = !style.edge_color;  // of one colour, none hides another
    std::optional<PlainProgram> solid;
    if (style.edge_color) solid.emplace(programs_, *style.edge_color, clip_from_view);
    for (const plan::DrawItem& item : items) {
        if (item.cut) continue;
        const GpuEdges* edges = scene.edges(item.geometry);
        stats.substitutes += edges == nullptr;
        if (!edges && style.edge_color) continue;  // its faces are drawn
        if (!edges) {
            programs.draw_faces({&item, 1}, state, nullptr, stats);
            continue;
        }
        const GpuGeometry& geometry = scene.geometry(item);
        if (solid)
            solid->use(item, geometry);
        else
            programs.use(SurfacePrograms::SurfaceKind::edges, item, geometry,
                         scene.scene()->material(item.material));
        apply(state.clipped_as(item));
        draw_lines(*edges, stats);
    }
}

void EdgePass::draw_cuts(std::span<const plan::DrawItem> items, GpuScene& scene,
                         const glm::dmat4& clip_from_view, plan::FrameStats& stats) {
    // On the very faces that they border.
    constexpr double kNearer = 1 + 0x1p-14;
    glm::dmat4 nearer(1);
    nearer[2][2] = kNearer;
    PlainProgram program(programs_, kCutColor, nearer * clip_from_view);
    const PipelineState state;
    for (const plan::DrawItem& item : items) {
        const GpuEdges& lines = scene.cut_lines(item);
        program.use(item, scene.geometry(item));
        apply(state.clipped_as(item));
        draw_lines(lines, stats);
    }
}

void EdgePass::draw_overlay(std::span<const plan::DrawItem> items, GpuScene& scene, const glm::dvec3& color,
                            const glm::dmat4& clip_from_view, plan::FrameStats& stats) {
    PipelineState state;
    state.depth_test = false;
    PlainProgram program(programs_, color, clip_from_view);
    for (const plan::DrawItem& item : items) {
        if (item.cut) continue;
        const GpuEdges* edges = scene.edges(item.geometry);
        stats.substitutes += edges == nullptr;
        if (!edges) continue;
        program.use(item, scene.geometry(item));
        apply(state.clipped_as(item));
        draw_lines(*edges, stats);
    }
}

}  // namespace vrut::gl
