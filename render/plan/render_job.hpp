#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "plan/view.hpp"
#include "scene/image.hpp"

namespace vrut::plan {

class FramePlanner;

/// An image of a view that is drawn in steps (Renderer::step). Steps of other jobs may come between, and it
/// may outlive its renderer.
struct RenderJob {
    /// Draws nothing yet. The memory of `buffer` is reused.
    explicit RenderJob(View what, scene::Image buffer = {});

    View view;
    scene::Image image;               ///< of the view's size; its pixels once all samples are drawn
    FrameStats stats;                 ///< of all steps so far
    std::vector<std::uint32_t> sums;  ///< for each byte of the image, over the samples; empty for one sample
    int samples = 0;                  ///< drawn, of view.samples
    std::shared_ptr<FramePlanner> planner = nullptr;  ///< the renderer's, by which it knows this image
    // Copies would share one unfinished sample.
    RenderJob(const RenderJob&) = delete;
    RenderJob& operator=(const RenderJob&) = delete;
    RenderJob(RenderJob&&) = default;
    RenderJob& operator=(RenderJob&&) = default;
    ~RenderJob() = default;
};

/// Accumulates one sample. With a single sample per pixel the buffers are swapped instead. Returns true when
/// all samples are in; `image` then holds their average.
bool add_sample(RenderJob& job, std::vector<std::uint8_t>& pixels);

}  // namespace vrut::plan
