#pragma once

#include <glm/glm.hpp>

#include "gl/framebuffer.hpp"
#include "gl/gpu_scene.hpp"
#include "gl/programs.hpp"
#include "plan/frame_plan.hpp"

namespace vrut::gl {

/// Adds transparent items to the depth of a target in which opaque ones are drawn, but for clear ones.
class DepthPass {
public:
    explicit DepthPass(Programs& programs) : programs_(programs) {}
    void draw(const plan::DrawLists& lists, const Framebuffer& target, GpuScene& scene,
              const glm::dmat4& clip_from_view);

private:
    Programs& programs_;
};

}  // namespace vrut::gl
