#pragma once

#include <glm/glm.hpp>

#include "scene/scene.hpp"

namespace vrut::scene {

/// The light that shines in a picture, in world space. `position` is a point's and a spot's, `direction`
/// (unit, the way in which it shines) a spot's and a directional light's. Attenuation is constant, linear,
/// quadratic; all zero means none, and a directional light has none.
struct Light {
    LightData::Type type = LightData::Type::point;
    bool headlight = true;  ///< a point light at the eye, wherever `position` is
    glm::dvec4 color{1, 1, 1, 1};
    glm::dvec3 attenuation{1, 0, 0};
    glm::dvec3 position{0}, direction{0, 0, -1};
    double angle = 90;  ///< a spot's full cone in degrees

    bool operator==(const Light&) const = default;
};

/// The light of a light node as the file says, where the node stands now. Shining along the node's local -z;
/// where its matrix leaves no direction, along the world's.
Light light_of(const PlacedScene& placed, Index node);

}  // namespace vrut::scene
