#pragma once

#include "json_reader.hpp"
#include "state.hpp"

/// Sections of the state that other messages repeat. For protocol's own .cpp files.
namespace vrut::protocol {

Json section_json(const SceneState& scene);
Json section_json(const CameraState& camera);

}  // namespace vrut::protocol
