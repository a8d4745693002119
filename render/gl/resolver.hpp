#pragma once

#include <memory>

#include "gl/framebuffer.hpp"
#include "gl/programs.hpp"
#include "plan/render_job.hpp"

namespace vrut::gl {

/// Averages the samples of images, and reads the images into memory. All resolvers give the same bytes: a
/// sample is rounded to 8 bits, and the average of samples is rounded again.
class Resolver {
public:
    virtual ~Resolver() = default;
    /// Takes the sample that is drawn in `target`. Throws as throw_on_gl_error().
    virtual void read(plan::RenderJob& job, Framebuffer& target) = 0;
    /// Counts that sample, once it is known that OpenGL reported no error.
    virtual void add(plan::RenderJob& job) = 0;
    /// Fills the job's image or planes. Returns false while the GPU is at work: call it again. It waits for a
    /// millisecond at most.
    virtual bool resolve(plan::RenderJob& job) = 0;
    /// Returns true if it has the samples that the job counts, and no others. It has none of another
    /// resolver.
    virtual bool holds(const plan::RenderJob& job) const = 0;
    /// Gives back the memory that no image needs.
    virtual void release() {}
};

/// Reads each sample, and sums them on the CPU.
std::unique_ptr<Resolver> make_cpu_resolver();
/// Sums the samples in a texture, and reads the average through pixel buffers: GPU and CPU do not wait for
/// each other. It converts to Y'CbCr as libjpeg does.
std::unique_ptr<Resolver> make_gpu_resolver(Programs& programs);

}  // namespace vrut::gl
