#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "plan/view.hpp"
#include "scene/image.hpp"

namespace vrut::reference {

/// What a view shows, before it is rounded. Rows from the bottom up.
struct ReferenceImage {
    int width = 0, height = 0;
    std::vector<glm::dvec3> color;  ///< of each pixel, 0 to 1: the mean of its samples
    /// What the ray through each pixel's centre meets first, transparent surfaces included; kNone: nothing.
    std::vector<scene::Index> node;
};

/// The image as the rules of the scene format have it, ray by ray in double: slow, simple, and the judge of
/// what the GPU draws. It leaves out edges, outlines and markers: of a wireframe it draws the background
/// alone. Uses all of the processor's cores.
ReferenceImage trace(const plan::View& view);

/// Rounded to bytes: floor(255 x + 0.5).
scene::Image image_of(const ReferenceImage& reference);

}  // namespace vrut::reference
