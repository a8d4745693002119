#pragma once

#include <optional>

#include "scene/scene.hpp"

namespace vrut::server::room {

/// The node or the innermost above it that has a hinge; kNone where none has.
scene::Index hinged(const scene::Scene& scene, scene::Index node);

/// A node's matrix with its hinge opened by a part. The node must have a hinge, as below.
glm::dmat4 opened(const scene::Node& node, double part);

/// By which part a hinge stands open, from 0 to 1, if `matrix` is one of opened().
double opened_part(const scene::Node& node, const glm::dmat4& matrix);

/// The same; none where `matrix` is none of opened(), or the node has no hinge.
std::optional<double> hinge_part(const scene::Node& node, const glm::dmat4& matrix);

}  // namespace vrut::server::room
