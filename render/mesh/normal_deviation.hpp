#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/deviation.hpp"

namespace vrut::mesh {

/// Measures how far off a simplified surface's normals make it look: a normal that is off by an angle, over
/// half a triangle's longest edge, pretends a step of their product. It shrinks in the picture as a distance
/// does, and where it is a fraction of a pixel, the shade is either nearly right or seen on few pixels.
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
