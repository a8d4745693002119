#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/drawing_errors.hpp"
#include "plan/render_job.hpp"
#include "plan/view.hpp"
#include "scene/image.hpp"

namespace vrut::renderer {

/// Scene and view to picture. Owns all of EGL and GL: made, used and destroyed on one thread. Whatever draws
/// throws ContextLost when the driver has reset itself: from then on it draws nothing any more. It throws
/// OutOfMemory where there is too little: what was drawn before can be drawn still.
class Renderer {
public:
    /// Throws std::runtime_error where nothing on this machine can draw. `device` is an index in EGL's
    /// enumeration; with `debug` the driver's messages are collected.
    explicit Renderer(std::optional<int> device = std::nullopt, bool debug = false);
    ~Renderer();

    /// What draws, for a log; why other devices were passed over; whether the processor draws.
    const std::string& description() const;
    const std::vector<std::string>& rejected() const;
    bool software() const;
    /// Largest width and height of a picture.
    int max_size() const;
    /// That live now, in the whole process.
    long gl_objects() const;
    std::vector<std::string> take_messages();

    /// Uploads the geometry and textures that the view's scene shows, in the image or beside it, so that the
    /// next step() does not have to: as much as fits the budget of one step (DrawBudget::kMostUpload). Their
    /// data is made on another thread, for which it waits a few milliseconds at most. Returns true when all
    /// is there. The scene drawn last stays on the GPU until then, or for good if this throws; steps of it
    /// may be interleaved.
    bool upload_step(const plan::View& view);
    /// All steps of it.
    void upload(const plan::View& view);

    /// Draws the next sample, or the part of it that fits the budget of one step (DrawBudget); the first
    /// steps may only plan, or upload (RenderJob::interactive says what it waits for). Returns true when the
    /// image is complete. Steps of several RenderJobs may be interleaved. If this throws, completed samples
    /// are kept and the current one starts again; after ContextLost continue with a new Renderer. The scene
    /// drawn last stays on the GPU.
    bool step(plan::RenderJob& job);

    /// Draws all of `view` into `image`, resized to fit, and says in `stats` what it took: for who has
    /// nothing else to do meanwhile.
    void render(const plan::View& view, scene::Image& image, plan::FrameStats& stats);

    /// The node that is in front at each pixel's centre, as an index into the scene's; kNone for none. Glass
    /// is in front of what is seen through it. Rows from the bottom up.
    std::vector<scene::Index> node_ids(const plan::View& view);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vrut::renderer
