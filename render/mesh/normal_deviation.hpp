#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/deviation.hpp"

namespace vrut::mesh {

/// Measures the error of a simplified surface's normals as an equivalent distance: the angle of the deviation
/// times half the triangle's longest edge. Like a distance it shrinks in the image; below a fraction of a
/// pixel, shading is nearly right or affects few pixels.
class NormalDeviation {
public:
    /// `corners`: for each corner of the triangles its normal, not of unit length; none where each triangle
    /// is flat.
    NormalDeviation(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                    const std::vector<glm::vec3>& corners);

    /// Of the surface that the deviation has measured last: what all but a twentieth of the area stays below.
    float measure(const SurfaceDeviation& deviation, std::span<const glm::uvec3> after,
                  const std::vector<glm::vec3>& corners) const;

private:
    struct NormalSample {
        glm::vec3 point, normal;
        glm::uvec3 triangle;
        float area;
    };
    std::span<const glm::vec3> positions_;
    std::vector<NormalSample> samples_;
};

}  // namespace vrut::mesh
