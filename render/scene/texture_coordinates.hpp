#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace vrut::scene {

struct TexcoordsNearZero {
    std::vector<glm::vec2> texcoords;
    glm::dvec2 taken_off{0};  ///< whole numbers
};

/// The texture coordinates of a geometry, without whole numbers that only cost digits in float: textures that
/// repeat show the same without. Along each axis it takes off the floor of the middle of their range where
/// that is 2 or more in size and more than the range is wide. Doing so twice is doing so once.
TexcoordsNearZero texcoords_near_zero(std::span<const glm::dvec2> texcoords);
/// The same of coordinates that are float already; without rounding.
void move_near_zero(std::vector<glm::vec2>& texcoords);

}  // namespace vrut::scene
