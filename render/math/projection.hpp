#pragma once

#include <glm/glm.hpp>

namespace vrut::math {

/// What a perspective camera sees: the sides of its image in the plane one unit before the eye. The camera
/// looks along -z; left < right, bottom < top. Nothing of near and far.
struct Projection {
    double left = -1, right = 1, bottom = -1, top = 1;

    double width() const { return right - left; }
    double height() const { return top - bottom; }
    /// The point of that plane at a position in the image, given in normalized device coordinates: x and y
    /// from -1 (left, bottom) to 1 (right, top).
    glm::dvec2 at(const glm::dvec2& ndc) const {
        return {(left + right) / 2 + ndc.x * width() / 2, (bottom + top) / 2 + ndc.y * height() / 2};
    }

    bool operator==(const Projection&) const = default;
};

/// The field of view of both sides is the same. `vertical_fov` in radians, above 0 and below pi; `aspect` is
/// width / height.
Projection symmetric_projection(double vertical_fov, double aspect);

/// A part of an image, or more than it, in normalized device coordinates.
struct NdcRect {
    glm::dvec2 low{-1}, high{1};
};
/// The whole of an image of that size, and a margin in pixels on all sides.
NdcRect ndc_with_margin(int width, int height, double pixels);
/// What is seen in a part of the image.
Projection cropped(const Projection& projection, const NdcRect& area);

/// OpenGL's matrix (4.6 compatibility specification, section 12.1.1): clip z from -w at `near` to w at `far`.
glm::dmat4 clip_from_view(const Projection& projection, double near, double far);

/// What the GPU clips and tests against: depth is near / distance, 1 at the near plane and 0 at infinity,
/// which gives float depth the same relative precision everywhere (Reed, "Depth Precision Visualized", 2015).
/// `offset` moves the image, in normalized device coordinates.
glm::dmat4 reversed_clip_from_view(const Projection& projection, double near,
                                   const glm::dvec2& offset = glm::dvec2(0));

}  // namespace vrut::math
