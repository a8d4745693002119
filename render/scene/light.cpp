#include "scene/light.hpp"

#include <cmath>

namespace vrut::scene {

Light light_of(const PlacedScene& placed, Index node) {
    const auto at = static_cast<std::size_t>(node);
    const auto& data = std::get<LightData>(placed.scene->nodes()[at].data);
    Light light{data.type, false, data.color, data.attenuation, placed.world[at][3], {0, 0, -1}, data.angle};
    const glm::dvec3 along = -glm::dvec3(placed.world[at][2]);
    const double length = glm::length(along);
    if (length > 0 && std::isfinite(length)) light.direction = along / length;
    return light;
}

}  // namespace vrut::scene
