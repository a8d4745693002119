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

/// Where samples are averaged. The images are equal, the times are not.
enum class ResolveOn { cpu, gpu };

/// Milliseconds for an image of one sample and one of four, of 640x360 pixels, from samples that are drawn
/// to an image in memory.
struct ResolverTimes {
    double cpu_ms = 0, gpu_ms = 0;  ///< infinite if it fails
    ResolveOn faster() const { return gpu_ms < cpu_ms ? ResolveOn::gpu : ResolveOn::cpu; }
};

/// Renders a view of a scene. Owns all of EGL and GL: created, used and destroyed on one thread. Drawing
/// functions throw ContextLost after a driver reset, and the renderer is unusable from then on; they throw
/// OutOfMemory if an allocation fails, and the renderer stays usable, and GlError if OpenGL reports another
/// error.
class Renderer {
public:
    /// Throws std::runtime_error if no device of this machine can draw. `device` is an index in EGL's
    /// enumeration; with `debug` the driver's messages are collected.
    explicit Renderer(std::optional<int> device = std::nullopt, bool debug = false);
    ~Renderer();

    /// What draws, for a log; why other devices were passed over; whether the processor draws.
    const std::string& description() const;
    const std::vector<std::string>& rejected() const;
    bool software() const;
    /// The largest width and height of an image.
    int max_size() const;
    /// The number of live GL objects in the whole process.
    long gl_objects() const;
    std::vector<std::string> take_messages();

    /// Uploads what the view's scene shows, in the image or beside it, and compiles the programs that any
    /// view of the scene by the same methods can need, so that the next step() does not have to: as much as
    /// fits the budget of one step (DrawBudget::kMostUpload). The data is prepared on another thread, for
    /// which this waits a few milliseconds at most. Returns true when all is there. The scene drawn last
    /// stays on the GPU until then, or for good if this throws; steps of it may be interleaved.
    bool upload_step(const plan::View& view);
    /// Calls upload_step() until it returns true.
    void upload(const plan::View& view);

    /// Samples are averaged on the CPU unless this says otherwise. Images that are begun start again.
    void use_resolver(ResolveOn where);
    /// Measures both and uses the faster one. Takes about 0.1 s on a CPU that draws. Throws ContextLost.
    ResolverTimes choose_resolver();

    /// Draws the next sample, or the part of it that fits the budget of one step (DrawBudget); the first
    /// steps may only plan, or upload (RenderJob::interactive says what it waits for). Returns true when the
    /// image is complete. Steps of several RenderJobs may be interleaved: while the image is read from the
    /// GPU the steps return false. If this throws, completed samples are kept and the current one starts
    /// again; after ContextLost continue with a new Renderer, which draws samples again that lay on the GPU.
    /// The scene drawn last stays on the GPU.
    bool step(plan::RenderJob& job);

    /// Draws the whole view into `image`, resized to fit, and fills `stats`. Blocks until the image is
    /// complete.
    void render(const plan::View& view, scene::Image& image, plan::FrameStats& stats);

    /// Returns the index of the frontmost node at each pixel's centre; kNone for none. Glass counts as in
    /// front of what is seen through it. Rows from the bottom up.
    std::vector<scene::Index> node_ids(const plan::View& view);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vrut::renderer
