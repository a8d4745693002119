#include "plan/render_job.hpp"

#include <cassert>
#include <utility>

namespace vrut::plan {

RenderJob::RenderJob(View what, scene::Image buffer, Keep what_to_keep)
    : view(std::move(what)), image(std::move(buffer)), keep(what_to_keep) {
    image.resize(view.width, view.height);
    if (view.samples > 1) keep = Keep::samples;
}

void RenderJob::refine(int more_samples, scene::Image buffer) {
    assert(keep == Keep::samples && more_samples >= samples);
    view.samples = more_samples;
    interactive = false;
    stats = {};
    image = std::move(buffer);
    image.resize(view.width, view.height);
    planes = {};
}

}  // namespace vrut::plan
