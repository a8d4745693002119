#pragma once

#include <span>
#include <vector>

#include "gl/passes/surface_programs.hpp"

namespace vrut::gl {

/// Which node each pixel shows, for a judge of images: all surfaces as if they were opaque.
class IdPass {
public:
    explicit IdPass(Programs& programs) : programs_(programs) {}
    /// What is drawn at the centres of width × height pixels, as indices of nodes, kNone for nothing; rows
    /// from the bottom up. `items` are by rising id.
    std::vector<scene::Index> draw(std::span<const plan::DrawItem> items, GpuScene& scene, int width,
                                   int height, const glm::dmat4& clip_from_view);

private:
    Programs& programs_;
};

}  // namespace vrut::gl
