#pragma once

#include <assimp/camera.h>
#include <assimp/light.h>

#include <optional>

#include "io/assimp/format.hpp"
#include "io/conversion_warnings.hpp"
#include "scene/scene.hpp"

namespace vrut::io {

/// What hangs in the node of that name: a camera, or none where it is of a kind that we have not.
std::optional<scene::Node> convert_camera(const aiCamera& from, AssimpFormat format,
                                          ConversionWarnings& warnings);
/// The same of a light. Its matrix turns it where it shines.
std::optional<scene::Node> convert_light(const aiLight& from, AssimpFormat format,
                                         ConversionWarnings& warnings);

/// Lets each camera whose target is a node of its own, named as the camera or its node with `.Target` behind
/// it as 3ds Max does, look at that node. Parents stand before their children.
void look_at_targets(scene::SceneParts& parts);

}  // namespace vrut::io
