#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// Which nodes of a scene were occluded when they were last queried. The next image begins with the others,
/// as in Bittner et al., "Coherent Hierarchical Culling" (2004), without the hierarchy. All begin as visible.
class OcclusionHistory {
public:
    /// Of a scene with so many nodes.
    explicit OcclusionHistory(std::size_t nodes) : nodes_(nodes) {}
    /// Begins an image, or another sample of one, that is seen from `eye` (world space). If that is farther
    /// than `most_move` from the eye of the image before, or there is none, all nodes are visible, and are
    /// queried from the next image on.
    void begin_image(const glm::dvec3& eye, double most_move);
    bool is_occluded(scene::Index node) const { return at(node).occluded; }
    /// Returns true if a node that is drawn is to be queried in the present image. While its results stay the
    /// same, that happens after 2, 4, 8 images and so on, up to kLongestInterval.
    bool is_query_due(scene::Index node) const { return image_ >= at(node).next; }
    /// Records the result of a query in the present image.
    void set_occluded(scene::Index node, bool occluded);
    static constexpr std::uint32_t kLongestInterval = 64;

private:
    struct Node {
        bool occluded = false;
        std::uint32_t interval = 1, next = 0;  // in images
    };
    const Node& at(scene::Index node) const { return nodes_[static_cast<std::size_t>(node)]; }

    std::vector<Node> nodes_;
    std::uint32_t image_ = 0;
    glm::dvec3 eye_{std::numeric_limits<double>::infinity()};  // of the present image
};

/// A box in view space that contains all that an item draws, with a margin for float's rounding of positions
/// and depths.
struct OcclusionBox {
    scene::Index node = scene::kNone;
    glm::dmat4 view_from_box{1};  ///< from the cube between -1 and 1; without reflection or shear
};

/// The opaque items of an image, without those that are expected to be occluded.
struct OcclusionPlan {
    std::vector<DrawItem> drawn;      ///< the others, in their order; empty if none are culled
    std::vector<DrawItem> culled;     ///< in their order; drawn later if their boxes are visible
    std::vector<OcclusionBox> boxes;  ///< to be queried: of each culled item, then of some that are drawn
};

/// Returns the box of an item; none if it comes close to the eye: such items count as visible.
std::optional<OcclusionBox> occlusion_box(const DrawItem& item, const View& view);

/// Returns true if occluded items of the view are culled: if it draws faces in their own materials, without
/// edges.
bool culls_occluded(const View& view);

/// Begins an image of `history`. Culls the items that were occluded if they have more than a twentieth of all
/// triangles. Items whose triangles take little time beside a query are drawn and not queried.
OcclusionPlan plan_occlusion(std::span<const DrawItem> opaque, const View& view,
                             const glm::dmat4& clip_from_view, OcclusionHistory& history);

}  // namespace vrut::plan
