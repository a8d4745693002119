#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "gl/framebuffer.hpp"
#include "gl/gpu_scene.hpp"
#include "gl/programs.hpp"
#include "plan/frame_plan.hpp"

namespace vrut::gl {

/// The depth of transparent items, which the depth of an image has not. Clear ones do not count.
class DepthPass {
public:
    explicit DepthPass(Programs& programs) : programs_(programs) {}
    /// Draws `width` · `height` samples, at the middle of equal parts of the image.
    void draw(const plan::DrawLists& lists, GpuScene& scene, const glm::dmat4& clip_from_view, int width,
              int height);
    /// What was drawn last, rows from the bottom up: the nearest of the items, even behind what is opaque; 0
    /// where there is none. Stays until the next call.
    const std::vector<float>& read();

private:
    Programs& programs_;
    std::optional<Framebuffer> target_;
    std::vector<float> depth_;
};

}  // namespace vrut::gl
