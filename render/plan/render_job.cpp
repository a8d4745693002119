#include "plan/render_job.hpp"

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

RenderJob::RenderJob(View what, scene::Image buffer) : view(std::move(what)), image(std::move(buffer)) {
    image.resize(view.width, view.height);
    if (view.samples > 1) sums.assign(image.rgba.size(), 0);
}

bool add_sample(RenderJob& job, std::vector<std::uint8_t>& pixels) {
    ++job.samples;
    if (job.view.samples <= 1) {
        job.image.rgba.swap(pixels);
        return true;
    }
    for (std::size_t k = 0; k < pixels.size(); ++k) job.sums[k] += pixels[k];
    if (job.samples < job.view.samples) return false;
    average(job.sums, job.samples, job.image.rgba);
    return true;
}

}  // namespace vrut::plan
