#include "plan/render_job.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>

namespace vrut::plan {

namespace {

void average(std::span<const std::uint32_t> sums, int samples, std::span<std::uint8_t> rgba) {
    // Division in float is vectorised, where bytes cannot lie over what holds them, and exact here: the sums
    // are integers far below 2^24.
    const auto count = static_cast<float>(samples), half = std::floor(count / 2);
    for (std::size_t k = 0; k < rgba.size(); ++k)
        rgba[k] = static_cast<std::uint8_t>((static_cast<float>(sums[k]) + half) / count);
}

}  // namespace

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
}

bool add_sample(RenderJob& job, std::vector<std::uint8_t>& pixels) {
    ++job.samples;
    job.memory_released = false;
    if (job.samples == 1) {
        (job.keep == RenderJob::Keep::samples ? job.first : job.image.rgba).swap(pixels);
    } else if (job.samples == 2) {
        job.sums.resize(pixels.size());
        for (std::size_t k = 0; k < pixels.size(); ++k)
            job.sums[k] = std::uint32_t{job.first[k]} + std::uint32_t{pixels[k]};
        job.first = {};
    } else {
        for (std::size_t k = 0; k < pixels.size(); ++k) job.sums[k] += pixels[k];
    }
    return job.samples >= job.view.samples;
}

void resolve_samples(RenderJob& job) {
    if (job.samples > 1)
        average(job.sums, job.samples, job.image.rgba);
    else if (job.keep == RenderJob::Keep::samples)
        std::copy(job.first.begin(), job.first.end(), job.image.rgba.begin());
}

}  // namespace vrut::plan
