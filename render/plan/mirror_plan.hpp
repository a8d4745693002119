#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// The number of mirrors in an image that show a reflection: the largest ones.
inline constexpr std::size_t kMaxMirrors = 16;

/// Returns the mirror plane of an opaque, reflective and flat item, in view space. None for other items, and
/// if the matrix collapses the plane.
std::optional<math::Plane> mirror_plane(const scene::Scene& scene, const DrawItem& item);

/// Moves the mirrors that show a reflection in this view out of `opaque`. The `shown` items that a mirror
/// reflects become its opaque items, transparent ones too. All lists are ordered by rising id.
std::vector<MirrorItem> extract_mirrors(std::vector<DrawItem>& opaque, std::span<const DrawItem> shown,
                                        const View& view);

}  // namespace vrut::plan
