#pragma once

#include "scene/scene.hpp"

namespace vrut::io {

/// For formats whose cameras have no focus distance, so that moves turn about what is seen. Moves the focus
/// of each camera that looks one unit ahead along its view, to the first surface there, or else to the depth
/// of the scene's centre. A focus stays where neither lies before the camera. Looks at no more than 2^24
/// boxes and triangles; for further cameras the centre counts.
void focus_on_what_is_seen(scene::SceneParts& parts);

}  // namespace vrut::io
