#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// So many mirrors of a picture show a reflection: those that are largest in it.
inline constexpr std::size_t kMaxMirrors = 16;

/// The plane about which a part mirrors, in view space: that of an opaque, reflective and flat one. None for
/// others, and where the matrix leaves no plane.
std::optional<math::Plane> mirror_plane(const scene::Scene& scene, const DrawItem& item);

/// Takes out of `opaque` the mirrors that show a reflection in this view. All that is seen in one, of
/// whatever is `shown`, stands among its opaque items, glass too. Everything is by rising id.
std::vector<MirrorItem> extract_mirrors(std::vector<DrawItem>& opaque, std::span<const DrawItem> shown,
                                        const View& view);

}  // namespace vrut::plan
