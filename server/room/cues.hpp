#pragma once

#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "scene/scene.hpp"
#include "state.hpp"

namespace vrut::server::room {

scene::Camera camera_of(const protocol::CueState& cue);

/// Lays over `state` what a cue shows, but for the camera. The selection gets its id alone.
void lay_cue(const protocol::CueState& cue, protocol::State& state);

protocol::Error no_cue_named(const std::string& name);

/// All that does not go with the scene of a cue called `name`, an error each. `starting`: the scene's own
/// state.
std::vector<protocol::Error> problems_of(const std::string& name, const protocol::CueState& cue,
                                         const protocol::State& starting, const scene::PlacedScene& placed);

}  // namespace vrut::server::room
