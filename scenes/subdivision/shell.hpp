#pragma once

#include "cage.hpp"
#include "sheet.hpp"

namespace vrut {

/// A sheet as a closed shell in the space that `from_car` leads to: lifted, its edge rounded outward, a rim
/// and a back. `tolerance` decides into how many pieces the rounding is broken.
scene::Geometry shell_of(const Sheet& sheet, const Panel& panel, double tolerance, const glm::dmat4& from_car,
                         bool textured);

}  // namespace vrut
