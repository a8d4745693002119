#pragma once

#include "scene/scene.hpp"

namespace vrut::server::room {

/// The node that a double tap on `hit` selects: the part that a person would name, as a door, a wheel or the
/// bonnet. That is the outermost node above the hit with a hinge; else the largest whose box has at most 0.4
/// of the scene's diagonal; else the hit. Where `selected` is one of these or lies between them and the hit,
/// it is the next one towards the hit: a second double tap goes a level deeper. What a switch or a LOD
/// chooses is no part of its own. kNone for kNone.
scene::Index named_part(const scene::PlacedScene& placed, scene::Index hit, scene::Index selected);

}  // namespace vrut::server::room
