#include "math/projection.hpp"

#include <cmath>

namespace vrut::math {

Projection symmetric_projection(double vertical_fov, double aspect) {
    const double top = std::tan(vertical_fov / 2), right = top * aspect;
    return {-right, right, -top, top};
}

NdcRect ndc_with_margin(int width, int height, double pixels) {
    const glm::dvec2 edge = 1.0 + 2 * pixels / glm::dvec2(width, height);
    return {-edge, edge};
}

Projection cropped(const Projection& projection, const NdcRect& area) {
    const glm::dvec2 low = projection.at(area.low), high = projection.at(area.high);
    return {low.x, high.x, low.y, high.y};
}

glm::dmat4 clip_from_view(const Projection& projection, double near, double far) {
    glm::dmat4 matrix = reversed_clip_from_view(projection, near);
    matrix[2][2] = -(far + near) / (far - near);
    matrix[3][2] = -2 * far * near / (far - near);
    return matrix;
}

glm::dmat4 reversed_clip_from_view(const Projection& projection, double near, const glm::dvec2& offset) {
    glm::dmat4 matrix(0);
    matrix[0][0] = 2 / projection.width();
    matrix[1][1] = 2 / projection.height();
    matrix[2][0] = (projection.left + projection.right) / projection.width() - offset.x;
    matrix[2][1] = (projection.bottom + projection.top) / projection.height() - offset.y;
    matrix[2][3] = -1;
    matrix[3][2] = near;
    return matrix;
}

}  // namespace vrut::math
