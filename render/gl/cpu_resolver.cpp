#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "gl/resolver.hpp"

namespace vrut::gl {

namespace {

using Clock = std::chrono::steady_clock;
using plan::RenderJob;

/// Adds the time of its life to `ms`.
class Stopwatch {
public:
    explicit Stopwatch(double& ms) : ms_(ms) {}
    ~Stopwatch() { ms_ += std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& ms_;
    Clock::time_point start_ = Clock::now();
};

void average(std::span<const std::uint32_t> sums, int samples, std::span<std::uint8_t> rgba) {
    // Division in float is vectorised, where bytes cannot lie over what holds them, and exact here: the sums
    // are integers far below 2^24.
    const auto count = static_cast<float>(samples), half = std::floor(count / 2);
    for (std::size_t k = 0; k < rgba.size(); ++k)
        rgba[k] = static_cast<std::uint8_t>((static_cast<float>(sums[k]) + half) / count);
}

class CpuResolver final : public Resolver {
public:
    void read(RenderJob& job, Framebuffer& target) override {
        const Stopwatch stopwatch(job.stats.readback_ms);
        pixels_.resize(job.image.rgba.size());
        target.read(pixels_);
        ++job.stats.readbacks;
    }

    void add(RenderJob& job) override {
        const Stopwatch stopwatch(job.stats.readback_ms);
        if (job.samples == 0) {
            (job.keep == RenderJob::Keep::samples ? job.first_sample : job.image.rgba).swap(pixels_);
            job.sums = {};
        } else if (job.samples == 1) {
            job.sums.resize(pixels_.size());
            for (std::size_t k = 0; k < pixels_.size(); ++k)
                job.sums[k] = std::uint32_t{job.first_sample[k]} + std::uint32_t{pixels_[k]};
            job.first_sample = {};
        } else {
            for (std::size_t k = 0; k < pixels_.size(); ++k) job.sums[k] += pixels_[k];
        }
        ++job.samples;
    }

    bool resolve(RenderJob& job) override {
        const Stopwatch stopwatch(job.stats.readback_ms);
        if (job.samples > 1)
            average(job.sums, job.samples, job.image.rgba);
        else if (job.keep == RenderJob::Keep::samples)
            std::ranges::copy(job.first_sample, job.image.rgba.begin());
        return true;
    }

    bool holds(const RenderJob& job) const override {
        return job.samples == 0 || !job.first_sample.empty() || !job.sums.empty();
    }

    void release() override { pixels_ = {}; }

private:
    std::vector<std::uint8_t> pixels_;  // of a sample
};

}  // namespace

std::unique_ptr<Resolver> make_cpu_resolver() { return std::make_unique<CpuResolver>(); }

}  // namespace vrut::gl
