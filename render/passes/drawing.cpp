#include "passes/drawing.hpp"

namespace vrut {

PixelBox pixel_box(const DrawItem& item, const Scene& scene, const glm::dmat4& clip_from_view,
                   const glm::ivec2& picture_size) {
    const glm::dvec2 picture(picture_size);
    const Bounds& bounds = scene.geometries()[static_cast<std::size_t>(item.geometry)].bounds;
    const glm::dmat4 clip_from_node = clip_from_view * item.view_from_node;
    glm::dvec2 low = picture, high(0);
    for (const glm::dvec3& corner : corners(bounds)) {
        const glm::dvec4 clip = clip_from_node * glm::dvec4(corner, 1);
        if (!(clip.w > 0)) return {{0, 0}, picture_size};
        const glm::dvec2 pixel =
            glm::clamp((glm::dvec2(clip) / clip.w * 0.5 + 0.5) * picture, glm::dvec2(0), picture);
        low = glm::min(low, pixel);
        high = glm::max(high, pixel);
    }
    return {glm::ivec2(glm::floor(low)), glm::ivec2(glm::ceil(high))};
}

void cull_sides(const DrawItem& item) {
    if (item.sides == Sides::both)
        glDisable(GL_CULL_FACE);
    else
        glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(item.mirrored ? GL_CW : GL_CCW);
}

void draw_triangles(const GpuGeometry& geometry, FrameStats& stats) {
    glBindVertexArray(geometry.vertex_array.get());
    glDrawElements(GL_TRIANGLES, geometry.index_count, GL_UNSIGNED_INT, nullptr);
    ++stats.draws;
    stats.triangles += static_cast<std::uint64_t>(geometry.index_count) / 3;
}

}  // namespace vrut
