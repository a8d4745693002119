#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measurement/feature.hpp"
#include "measurement/mesh_edges.hpp"
#include "scene/scene.hpp"

namespace vrut::measurement {

enum class Kind {
    distance,  ///< of two points
    parallel,  ///< of a point, or of what is parallel, from a line or plane
    angle,     ///< of two directions, 0 to 90 degrees; or at the second of three points, 0 to 180
    radius,    ///< of a circle, or of that through three points
    length,    ///< of an edge, or of all of a loop
};

struct Measured {
    std::optional<double> value;  ///< in the scene's unit, or degrees
    std::optional<glm::dvec3>
        components;                ///< of a distance: from the first point to the second, in the world
    std::vector<glm::dvec3> line;  ///< at most 64 points in the world; empty where a part is hidden
    std::string problem;           ///< why there is no value: a part of a sentence
};

/// Returns what is wrong with the picks whatever the scene is, as a part of a sentence: "a distance needs 2
/// picks, not 1". None if nothing is.
std::optional<std::string> invalid(Kind kind, std::span<const Feature> features);

/// Measures the features where their nodes are. Values do not depend on where the scene is: points of two
/// parts are compared below what moves both. Circles are measured where they are circles in the world.
Measured measure(const scene::PlacedScene& placed, Kind kind, std::span<const Feature> features,
                 MeshEdgesMemo& memo);

}  // namespace vrut::measurement
