#pragma once

#include <optional>
#include <vector>

#include "scene/scene.hpp"

namespace vrut::io {

/// Returns where the nodes of a scene that is not built yet lie, without what they show. None where they
/// are no tree, which build_scene() says.
std::optional<scene::PlacedScene> placed_nodes(const scene::SceneParts& parts);

/// Returns for each node whether it is shown at first, from near: a LOD shows its first child.
std::vector<bool> nodes_shown_near(const scene::PlacedScene& placed);

}  // namespace vrut::io
