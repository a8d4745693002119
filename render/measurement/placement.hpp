#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "measurement/feature.hpp"
#include "scene/scene.hpp"

namespace vrut::measurement {

/// A feature in the world, as exact far from the world's origin as near it.
struct PlacedFeature {
    Snap snap = Snap::point;
    scene::Index node = scene::kNone;
    glm::dvec3 at{0};                ///< its first point, from the first point of the first feature
    glm::dvec3 second{0}, third{0};  ///< its other points, from its first one
    glm::dvec3 along{0};             ///< from its second point to its third
};

/// Nodes of all features are known (Scene::find_node()). They are placed in the space of their lowest common
/// ancestor, and only their differences in the world.
std::vector<PlacedFeature> placed_features(const scene::PlacedScene& placed,
                                           std::span<const Feature> features);

/// A point of a node, in the world.
glm::dvec3 in_world(const scene::PlacedScene& placed, scene::Index node, const glm::dvec3& point);

}  // namespace vrut::measurement
