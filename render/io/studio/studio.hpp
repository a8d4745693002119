#pragma once

#include "scene/scene.hpp"

namespace vrut::io {

/// Adds what a thing is shown in: the assembly "Studio", marked as presentation, with a background that
/// lights surfaces (studio_cube_map()), and a sheet on the ground with the thing's contact_shadow(), if it
/// has one. Their ids are above those of the file. Materials without metallic-roughness get it: their colours
/// become base colours, their highlights roughness, their emission light. Adds nothing to parts that have a
/// background of their own, or show no triangles, or whose ids leave no room below scene::kMaxId.
void add_studio(scene::SceneParts& parts);

}  // namespace vrut::io
