#pragma once

#include <functional>
#include <optional>
#include <string>

namespace vrut::plan {
struct RenderJob;
struct View;
}  // namespace vrut::plan

namespace vrut::server::engine {

/// Draws frames: the OpenGL renderer, or in a test something that needs no GL. Made, used and destroyed on
/// the render thread; made anew when it throws ContextLost.
struct FrameRenderer {
    std::string description;
    bool software = false;
    int max_size = 16384;
    /// As Renderer::upload_step; empty: there is nothing to upload.
    std::function<bool(const plan::View&)> upload_step = {};
    /// As Renderer::step.
    std::function<bool(plan::RenderJob&)> step = {};
    std::function<long()> gl_objects = {};  ///< how many live; where there may be any
};
using FrameRendererFactory = std::function<FrameRenderer()>;

/// The OpenGL renderer, on EGL device `device` or the first that works.
FrameRendererFactory gl_renderer(std::optional<int> device);

}  // namespace vrut::server::engine
