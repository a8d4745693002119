#pragma once

#include "scene/scene.hpp"

namespace vrut::scene {

/// Faces of the stylized drawing: dark blue, under the same light as realistic ones.
inline const Material& stylized_faces() {
    static const Material material = [] {
        Material blue;
        blue.ambient = {0.03, 0.05, 0.15, 1};
        blue.diffuse = {0.10, 0.18, 0.45, 1};
        return blue;
    }();
    return material;
}

/// Its edges: light blue.
inline constexpr glm::dvec3 kStylizedEdges{0.55, 0.78, 1};

/// What marks the selection: orange.
inline constexpr glm::dvec3 kSelection{1, 0.6, 0};

/// What markers are: crimson, with a white rim.
inline constexpr glm::dvec3 kMarkerColor{0.8, 0.04, 0.32};

}  // namespace vrut::scene
