#pragma once

#include "scene.hpp"
#include "state.hpp"
#include "view.hpp"

namespace vrut {

/// What the reader had to say of a scene, and what of it is not drawn.
std::vector<std::string> all_notices(const Scene& scene);

/// The state that a scene starts with, its camera at home for a view of `aspect`.
protocol::State starting_state(const PlacedScene& placed, double aspect, std::vector<std::string> notices);

Camera camera_of(const protocol::CameraState& state);
/// Near and far are refitted to the scene.
protocol::CameraState state_of(const Camera& camera, const Bounds& bounds);

/// What of the state and the scene is to be seen, but for size and samples. The background is the active one,
/// if its subtree is active, else the plain colour.
View view_of(const protocol::State& state, std::shared_ptr<const PlacedScene> placed);

}  // namespace vrut
