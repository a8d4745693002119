#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "state.hpp"

namespace vrut::server::room {

protocol::Error no_cue_named(const std::string& name);

/// All that does not go with the scene of a cue called `name`, an error each. `starting`: the scene's own
/// state.
std::vector<protocol::Error> problems_of(const std::string& name, const protocol::CueState& cue,
                                         const protocol::State& starting, const scene::PlacedScene& placed);

}  // namespace vrut::server::room
