#include "scene/texture_coordinates.hpp"

#include <cmath>

namespace vrut::scene {

namespace {

/// What is taken off; zero where nothing is.
template <class Texcoords>
glm::dvec2 whole_numbers_of(const Texcoords& texcoords) {
    if (texcoords.empty()) return glm::dvec2(0);
    glm::dvec2 low(texcoords.front()), high = low;
    for (const glm::dvec2 texcoord : texcoords) {
        low = glm::min(low, texcoord);
        high = glm::max(high, texcoord);
    }
    glm::dvec2 whole = glm::floor((low + high) / 2.0);
    for (int axis = 0; axis < 2; ++axis) {
        const double size = std::abs(whole[axis]);
        if (!(size >= 2 && size > high[axis] - low[axis])) whole[axis] = 0;
    }
    return whole;
}

}  // namespace

TexcoordsNearZero texcoords_near_zero(std::span<const glm::dvec2> texcoords) {
    TexcoordsNearZero result{{}, whole_numbers_of(texcoords)};
    result.texcoords.reserve(texcoords.size());
    for (const glm::dvec2& texcoord : texcoords) result.texcoords.emplace_back(texcoord - result.taken_off);
    return result;
}

void move_near_zero(std::vector<glm::vec2>& texcoords) {
    const glm::dvec2 whole = whole_numbers_of(texcoords);
    if (whole == glm::dvec2(0)) return;
    for (glm::vec2& texcoord : texcoords) texcoord = glm::vec2(glm::dvec2(texcoord) - whole);
}

}  // namespace vrut::scene
