#pragma once

#include <glm/glm.hpp>

#include "scene/scene.hpp"

namespace vrut::scene {

/// The light of a view, in world space. `position` is used by point and spot lights; `direction` (unit, away
/// from the light) by spot and directional lights. `attenuation` holds the constant, linear and quadratic
/// factors; all zero means none, and a directional light has none.
struct Light {
    LightData::Type type = LightData::Type::point;
    bool headlight = true;  ///< a point light at the eye, wherever `position` is
    glm::dvec4 color{1, 1, 1, 1};
    glm::dvec3 attenuation{1, 0, 0};
    glm::dvec3 position{0}, direction{0, 0, -1};
    double angle = 90;  ///< a spot's full cone in degrees

    bool operator==(const Light&) const = default;
};

/// Returns the light of a light node with the file's properties and the node's present pose. It shines along
/// the node's local -z, or along the world's if the node's matrix leaves no direction.
Light light_of(const PlacedScene& placed, Index node);

}  // namespace vrut::scene
