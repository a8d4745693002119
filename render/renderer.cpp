#include "renderer.hpp"

#include <bit>
#include <chrono>
#include <cmath>

#include "context.hpp"
#include "frame_plan.hpp"
#include "framebuffer.hpp"
#include "gpu_scene.hpp"
#include "passes/opaque_pass.hpp"

namespace vrut {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Place of sample `index` in its pixel, from the pixel's centre: the Hammersley set, moved to be centred.
glm::dvec2 sample_offset(int index, int samples) {
    const auto count = std::bit_ceil(static_cast<unsigned>(samples));
    double y = 0.5 / count;
    double digit = 0.5;
    for (unsigned rest = static_cast<unsigned>(index); rest != 0; rest >>= 1, digit /= 2)
        y += (rest & 1) * digit;
    return {(index + 0.5) / samples - 0.5, y - 0.5};
}

/// What the GPU clips and tests against: depth is near / distance, 1 at the near plane and 0 at infinity,
/// which gives float depth the same relative precision everywhere. `offset` moves the sample, in pixels, y
/// down.
glm::dmat4 reversed_clip_from_view(const View& view, double near, const glm::dvec2& offset) {
    glm::dmat4 matrix =
        clip_from_view(view.camera, static_cast<double>(view.width) / view.height, {near, 2 * near});
    matrix[2][0] = 2 * offset.x / view.width;
    matrix[2][1] = -2 * offset.y / view.height;
    matrix[2][2] = 0;
    matrix[3][2] = near;
    return matrix;
}

}  // namespace

struct Renderer::Impl {
    Impl(std::optional<int> device, bool debug) : context({device, debug}) {
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        glClearDepth(0);
        glEnable(GL_DEPTH_TEST);
        glDisable(GL_DITHER);
    }

    void draw(const FramePlan& plan, const View& view, double near, const glm::dvec2& offset,
              FrameStats& stats) {
        target->bind();
        glClearColor(static_cast<float>(view.background.r), static_cast<float>(view.background.g),
                     static_cast<float>(view.background.b), 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        if (!plan.opaque.empty())
            opaque.draw(plan.opaque, *scene, reversed_clip_from_view(view, near, offset), view.headlight,
                        stats);
    }

    GlContext context;  // first: destroyed after everything below
    std::optional<GpuScene> scene;
    std::optional<Framebuffer> target;
    OpaquePass opaque;
    std::vector<std::uint8_t> sample;
    std::vector<std::uint32_t> sums;
};

Renderer::Renderer(std::optional<int> device, bool debug) : impl_(std::make_unique<Impl>(device, debug)) {
    set_scene(std::make_shared<PlacedScene>(place(Scene())));
}
Renderer::~Renderer() = default;

const std::string& Renderer::description() const { return impl_->context.description(); }
const std::vector<std::string>& Renderer::rejected() const { return impl_->context.rejected(); }
bool Renderer::software() const { return impl_->context.software(); }
int Renderer::max_size() const { return impl_->context.max_size(); }
std::vector<std::string> Renderer::take_messages() { return impl_->context.take_messages(); }

void Renderer::set_scene(std::shared_ptr<const PlacedScene> scene) { impl_->scene.emplace(std::move(scene)); }

bool Renderer::render(const View& view, Image& image, FrameStats& stats,
                      const std::function<bool()>& interrupted) {
    stats = {};
    if (!impl_->target || impl_->target->width() != view.width || impl_->target->height() != view.height) {
        impl_->target.reset();  // the old one's memory is free before the new one takes its own
        impl_->target.emplace(view.width, view.height);
    }
    image.resize(view.width, view.height);

    Clock::time_point start = Clock::now();
    const PlacedScene& placed = impl_->scene->placed();
    const FramePlan plan = plan_frame(placed, view.camera);
    const double near = fit_clip_range(view.camera, placed.bounds).near;
    if (view.samples > 1) impl_->sums.assign(image.rgba.size(), 0);
    for (int i = 0; i < view.samples; ++i) {
        if (i > 0 && interrupted && interrupted()) return false;
        impl_->draw(plan, view, near, sample_offset(i, view.samples), stats);
        wait_for_gl();
        stats.render_ms += milliseconds_since(start);

        start = Clock::now();
        std::vector<std::uint8_t>& pixels = view.samples > 1 ? impl_->sample : image.rgba;
        pixels.resize(image.rgba.size());
        impl_->target->read(pixels);
        if (view.samples > 1)
            for (std::size_t k = 0; k < pixels.size(); ++k) impl_->sums[k] += pixels[k];
        stats.readback_ms += milliseconds_since(start);
        start = Clock::now();
    }
    if (view.samples > 1) {
        // Division in float is vectorised, and exact here: the sums are integers far below 2^24.
        const auto count = static_cast<float>(view.samples), half = std::floor(count / 2);
        for (std::size_t k = 0; k < image.rgba.size(); ++k)
            image.rgba[k] = static_cast<std::uint8_t>((static_cast<float>(impl_->sums[k]) + half) / count);
        stats.readback_ms += milliseconds_since(start);
    }
    return true;
}

}  // namespace vrut
