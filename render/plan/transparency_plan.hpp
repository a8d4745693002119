#pragma once

#include <span>

#include "plan/frame_plan.hpp"
#include "plan/transparency_cache.hpp"
#include "plan/view.hpp"

namespace vrut::plan {

/// Transparent items, given by rising id, in groups from far to near as the eye (the origin of their view
/// space) sees them. What lies before what is told by a plane between two boxes: the one on the eye's side is
/// in front. Items that no such plane parts, and rings of items, become an exact group if drawing them in the
/// wrong order could change a colour by more than 1/255; with Transparency::sorted they are drawn by their
/// distance, and with Transparency::per_pixel_lists all items are one exact group. Above kMaxOverlappingPairs
/// pairs that overlap in the width of the screen everything is one exact group, or, where more than
/// kMaxMeanLayers lie over each other on average, drawn by its distance.
std::vector<TransparentGroup> order_transparent(std::span<const DrawItem> items, const View& view,
                                                TransparencyCache& shapes);

inline constexpr std::size_t kMaxOverlappingPairs = std::size_t{1} << 20;
inline constexpr double kMaxMeanLayers = 64;

/// Sets occluded_by_coincident of each of `items`.
void mark_occluded_by_coincident(std::vector<DrawItem>& items, std::span<const DrawItem> others,
                                 const scene::Scene& scene);

}  // namespace vrut::plan
