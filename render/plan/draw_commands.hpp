#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// One step of drawing a sample, over a list of items or none. A step over items can be executed in batches.
struct DrawCommand {
    enum class Kind {
        clear,            ///< clears the image, and draws its background
        opaque,           ///< faces
        query_boxes,      ///< begins occlusion queries of opaque items, culled or not
        revealed,         ///< faces of culled items that are visible
        cut_lines,        ///< lines of items' cuts
        find_mirrors,     ///< begins occlusion queries of `mirrors`; commands of hidden ones are skipped
        open_mirror,      ///< clears the target of `mirror`, and draws its background
        close_mirror,     ///< draws its surface
        sorted_glass,     ///< faces, in the order of the items
        per_pixel_glass,  ///< faces, in the order that each pixel needs
        edges,            ///< lines
        edges_overlay,    ///< lines without depth test
        reset_depth,      ///< clears depth where the items cover the image
        outline_mask,     ///< into a mask
        outline,          ///< around that
        markers,          ///< the plan's
    };
    Kind kind = Kind::clear;
    /// The mirror whose reflection is drawn, opened or closed; null: the image itself.
    const MirrorItem* mirror = nullptr;
    std::span<const DrawItem> items = {};
    std::span<const MirrorItem> mirrors = {};
};

/// Returns true if it draws into a mirror's target instead of the image.
bool is_reflected(const DrawCommand& command);

/// Returns the commands that draw one sample of a view, in order. They point into the plan, which must
/// outlive them and must not move.
std::vector<DrawCommand> draw_commands(const FramePlan& plan, const View& view);

}  // namespace vrut::plan
