#pragma once

#include <span>

#include "plan/frame_plan.hpp"
#include "plan/transparency_cache.hpp"
#include "plan/view.hpp"

namespace vrut::plan {

/// Returns the transparent items in groups, sorted from far to near in view space (the eye is the origin).
/// `items` are sorted by rising id. A plane that separates the bounding boxes of two items decides their
/// order: the item on the eye's side is in front. Without such a plane their triangles are compared. If that
/// decides nothing, or items form a cycle, they become an exact group, whose order is found at each pixel. If
/// the wrong order changes no colour by more than 1/255, or under Transparency::sorted, they are sorted by
/// the distance of their centres instead. An item that overlaps itself in an unknown order is an exact group
/// of its own, under the same conditions.
///
/// If more than kMaxOverlappingPairs pairs overlap in x on the screen, items are not compared. Then all items
/// are one exact group. If more than kMaxMeanLayers of them cover a pixel on average, they are sorted by
/// distance.
std::vector<TransparentGroup> order_transparent(std::span<const DrawItem> items, const View& view,
                                                TransparencyCache& shapes);

inline constexpr std::size_t kMaxOverlappingPairs = std::size_t{1} << 20;
inline constexpr double kMaxMeanLayers = 64;

/// Sets occluded_by_coincident of each item for which `others` hold an item of the same geometry and matrix
/// and of a higher id.
void mark_occluded_by_coincident(std::vector<DrawItem>& items, std::span<const DrawItem> others,
                                 const scene::Scene& scene);

}  // namespace vrut::plan
