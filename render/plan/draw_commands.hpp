#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// One thing that is done to draw a sample, over some items or none. Those over items may be done for some
/// of them, and later for the others.
struct DrawCommand {
    enum class Kind {
        clear,            ///< the picture, and draws its background
        opaque,           ///< faces
        find_mirrors,     ///< asks which of `mirrors` can be seen; commands of the others are left out
        open_mirror,      ///< clears the target of `mirror`, and draws its background
        close_mirror,     ///< draws its surface
        sorted_glass,     ///< faces, in the order of the items
        per_pixel_glass,  ///< faces, in the order that each pixel needs
        edges,            ///< lines
        edges_overlay,    ///< lines that nothing hides
        reset_depth,      ///< makes room in the depth for what is drawn over everything
        outline_mask,     ///< into a mask
        outline,          ///< around that
        markers,          ///< the plan's
    };
    Kind kind = Kind::clear;
    /// The one that all this is seen in, that is opened, or that is closed; null: the picture itself.
    const MirrorItem* mirror = nullptr;
    std::span<const DrawItem> items = {};
    std::span<const MirrorItem> mirrors = {};
};

/// Whether it draws into a mirror's target, not into the picture.
bool is_reflected(const DrawCommand& command);

/// What draws a sample of a view, in this order. The plan must outlive it, and stay where it is.
std::vector<DrawCommand> draw_commands(const FramePlan& plan, const View& view);

}  // namespace vrut::plan
