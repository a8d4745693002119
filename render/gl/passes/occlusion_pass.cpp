#include "gl/passes/occlusion_pass.hpp"

#include <array>

#include "gl/passes/drawing.hpp"
#include "gl/vertex_arrays.hpp"

namespace vrut::gl {

namespace {

/// Between -1 and 1, seen from outside.
GpuGeometry make_cube() {
    std::array<GpuVertex, 8> vertices{};
    for (unsigned i = 0; i < vertices.size(); ++i)
        vertices[i].position = glm::vec3(i & 1, i >> 1 & 1, i >> 2) * 2.0F - 1.0F;
    constexpr std::array<glm::uvec3, 12> kTriangles{{{0, 2, 1},
                                                     {1, 2, 3},
                                                     {4, 5, 6},
                                                     {5, 7, 6},
                                                     {0, 1, 4},
                                                     {1, 5, 4},
                                                     {2, 6, 3},
                                                     {3, 6, 7},
                                                     {0, 4, 2},
                                                     {2, 4, 6},
                                                     {1, 3, 5},
                                                     {3, 7, 5}}};
    auto buffers = std::make_shared<GeometryBuffers>();
    buffers->vertices = make_buffer("vertices", vertices.data(), sizeof vertices);
    buffers->indices = make_buffer("indices", kTriangles.data(), sizeof kTriangles);
    GpuGeometry cube;
    cube.index_count = 3 * kTriangles.size();
    cube.buffers = buffers;
    buffers->vertex_array = vertex_array_of(cube, buffers->indices);
    return cube;
}

PipelineState only_tested(GLenum depth_func) {
    PipelineState state;
    state.depth_func = depth_func;
    state.depth_write = false;
    state.color_write = false;
    return state;
}

}  // namespace

void OcclusionPass::begin_query() {
    if (used_ == queries_.size()) queries_.push_back(make_query(GL_ANY_SAMPLES_PASSED));
    glBeginQuery(GL_ANY_SAMPLES_PASSED, queries_[used_++].get());
}

void OcclusionPass::query(std::span<const plan::OcclusionBox> boxes, const glm::dmat4& clip_from_view) {
    if (!cube_.buffers) cube_ = make_cube();
    PlainProgram program(programs_, glm::dvec3(0), clip_from_view);
    plan::DrawItem item;
    apply(only_tested(GL_GEQUAL).for_item(item));
    plan::FrameStats not_counted;
    for (const plan::OcclusionBox& box : boxes) {
        item.view_from_node = box.view_from_box;
        program.use(item, cube_);
        begin_query();
        draw_triangles(cube_, not_counted);
        glEndQuery(GL_ANY_SAMPLES_PASSED);
    }
}

void OcclusionPass::draw_revealed(std::span<const plan::DrawItem> items, GpuScene& scene,
                                  const glm::dmat4& clip_from_view, SurfacePrograms& programs,
                                  plan::FrameStats& stats) {
    for (const plan::DrawItem& item : items) {
        const GpuGeometry& geometry = scene.geometry(item);
        PlainProgram(programs_, glm::dvec3(0), clip_from_view).use(item, geometry);
        apply(only_tested(GL_EQUAL).for_item(item));
        begin_query();
        draw_triangles(geometry, stats);
        glEndQuery(GL_ANY_SAMPLES_PASSED);
        programs.draw_faces({&item, 1}, PipelineState(), nullptr, stats);
    }
}

bool OcclusionPass::passed(std::size_t index) const {
    GLuint any = 0;
    glGetQueryObjectuiv(queries_[index].get(), GL_QUERY_RESULT, &any);
    return any != 0;
}

}  // namespace vrut::gl
