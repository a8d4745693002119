#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "plan/view.hpp"
#include "scene/image.hpp"
#include "warp/depth_map.hpp"

namespace vrut::plan {

class FramePlanner;

/// An image of a view that is drawn in steps (Renderer::step). Between two steps it may wait while others are
/// drawn, it may outlive its renderer, and once it is whole it may go on to more samples.
struct RenderJob {
    enum class Keep { image, samples };
    enum class Output { rgba, ycbcr_420, ycbcr_444 };

    /// Begins it, and draws nothing. `buffer` is an image whose memory may be used again. With Keep::samples
    /// it can go on once it is whole, even after one sample.
    explicit RenderJob(View what, scene::Image buffer = {}, Keep what_to_keep = Keep::image);

    /// Goes on to that many samples from those that are drawn: more than those, or as many. The image becomes
    /// `buffer`, and is whole after a further step. The samples were kept.
    void refine(int more_samples, scene::Image buffer);

    View view;
    scene::Image image;  ///< of the view's size; its pixels once all samples are drawn
    /// Set before the last step. A renderer that resolves samples on the GPU then fills `planes` instead of
    /// the image if this asks for them. Another one leaves the conversion to the encoder.
    Output output = Output::rgba;
    scene::PlanarImage planes;  ///< empty if the image is filled
    FrameStats stats;           ///< of all steps since it was begun or went on
    Keep keep = Keep::image;
    /// Set before the first step: the image does not wait until levels of detail and edges are on the GPU. In
    /// the place of a level it shows a finer one that is there; in a wireframe, parts without edges are faces
    /// (FrameStats::substitutes). Other images wait for all that they show.
    bool interactive = false;
    /// Set before the first step: with the first sample `depth` is filled; glass counts as what is in front
    /// of what is seen through it, if it is less than half clear. No columns: it is not.
    warp::DepthMapSize depth_size;
    warp::DepthMap depth;
    bool memory_released = false;  ///< by the renderer for the sample that is next: it has no more to release
    int samples = 0;               ///< drawn, of view.samples
    /// Of a renderer that resolves samples on the CPU: the bytes of the first, while it is the only one and
    /// there may be others; later for each byte of the image the sum over all samples.
    std::vector<std::uint8_t> first_sample;
    std::vector<std::uint32_t> sums;
    std::shared_ptr<FramePlanner> planner = nullptr;  ///< the renderer's, by which it knows this image
    // Copies would share one unfinished sample.
    RenderJob(const RenderJob&) = delete;
    RenderJob& operator=(const RenderJob&) = delete;
    RenderJob(RenderJob&&) = default;
    RenderJob& operator=(RenderJob&&) = default;
    ~RenderJob() = default;
};

}  // namespace vrut::plan
