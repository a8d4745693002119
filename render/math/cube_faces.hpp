#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

namespace vrut::math {

/// A camera of a cube map: where it looks, what is to its right, and up.
struct CubeFace {
    glm::dvec3 forward, right, up;
};

/// In the order px nx py ny pz nz; right = view × up.
inline constexpr std::array<CubeFace, 6> kCubeFaces{
    CubeFace{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},  CubeFace{{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    CubeFace{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},  CubeFace{{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
    CubeFace{{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}, CubeFace{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}};

/// The number of the face that a direction meets, of any length but 0.
inline std::size_t cube_face_of(const glm::dvec3& direction) {
    const glm::dvec3 size = glm::abs(direction);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return 2 * static_cast<std::size_t>(axis) + (direction[axis] < 0 ? 1 : 0);
}

/// Where a direction meets the image of a face: (0, 0) is its bottom left and (1, 1) its top right.
inline glm::dvec2 uv_on(const CubeFace& face, const glm::dvec3& direction) {
    return glm::dvec2(glm::dot(direction, face.right), glm::dot(direction, face.up)) /
               (2 * glm::dot(direction, face.forward)) +
           0.5;
}

/// The direction, of a length from 1 to √3, that meets the image of a face at `uv`.
inline glm::dvec3 direction_at(const CubeFace& face, const glm::dvec2& uv) {
    return face.forward + face.right * (2 * uv.x - 1) + face.up * (2 * uv.y - 1);
}

}  // namespace vrut::math
