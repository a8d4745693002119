#include "passes/drawing.hpp"

#include <algorithm>

namespace vrut {

void cull_sides(const DrawItem& item) {
    if (item.sides == Sides::both)
        glDisable(GL_CULL_FACE);
    else
        glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(item.mirrored ? GL_CW : GL_CCW);
}

void scissor(const PixelBox& box) {
    glScissor(box.low.x, box.low.y, std::max(box.size().x, 0), std::max(box.size().y, 0));
}

void draw_triangles(const GpuGeometry& geometry, FrameStats& stats) {
    glBindVertexArray(geometry.vertex_array.get());
    glDrawElements(GL_TRIANGLES, geometry.index_count, GL_UNSIGNED_INT, nullptr);
    ++stats.draws;
    stats.triangles += static_cast<std::uint64_t>(geometry.index_count) / 3;
}

}  // namespace vrut
