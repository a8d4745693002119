#include "plan/projection.hpp"

#include "scene/camera.hpp"

namespace vrut::plan {

double near_distance(const View& view) {
    // Reversed float depth is as precise with a nearer plane. A power of two scales it without rounding.
    constexpr double kOfClipRange = 1.0 / 128;
    const math::Bounds bounds = view.scene ? view.scene->bounds : math::Bounds();
    return scene::fit_clip_range(view.camera, bounds).near * kOfClipRange;
}

glm::dmat4 reversed_clip_from_view(const View& view, double near, const glm::dvec2& offset) {
    glm::dmat4 matrix =
        scene::clip_from_view(view.camera, static_cast<double>(view.width) / view.height, {near, 2 * near});
    matrix[2][0] = 2 * offset.x / view.width;
    matrix[2][1] = -2 * offset.y / view.height;
    matrix[2][2] = 0;
    matrix[3][2] = near;
    return matrix;
}

PixelBox intersection(const PixelBox& a, const PixelBox& b) {
    return {glm::max(a.low, b.low), glm::min(a.high, b.high)};
}

PixelBox pixel_box(const math::Bounds& bounds, const glm::dmat4& clip_from_node, const glm::ivec2& viewport) {
    const glm::dvec2 size(viewport);
    glm::dvec2 low = size, high(0);
    const auto add = [&](const glm::dvec4& clip) {
        const glm::dvec2 pixel =
            glm::clamp((glm::dvec2(clip) / clip.w * 0.5 + 0.5) * size, glm::dvec2(0), size);
        low = glm::min(low, pixel);
        high = glm::max(high, pixel);
    };
    std::array<glm::dvec4, 8> clip{};
    for (std::size_t i = 0; const glm::dvec3& corner : math::corners(bounds))
        clip[i++] = clip_from_node * glm::dvec4(corner, 1);
    // The edges of the box, cut where they come through the near plane: bits of their numbers tell corners.
    const auto behind_near = [](const glm::dvec4& p) { return p.w - p.z; };
    for (std::size_t i = 0; i < clip.size(); ++i) {
        const double here = behind_near(clip[i]);
        if (here >= 0) add(clip[i]);
        for (std::size_t bit = 1; bit < clip.size(); bit *= 2) {
            const double there = behind_near(clip[i ^ bit]);
            if (here >= 0 && there < 0) add(glm::mix(clip[i], clip[i ^ bit], here / (here - there)));
        }
    }
    return {glm::ivec2(glm::floor(low)), glm::ivec2(glm::ceil(high))};
}

}  // namespace vrut::plan
