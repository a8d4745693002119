#include "renderer.hpp"

#include <chrono>
#include <cmath>
#include <span>

#include "colors.hpp"
#include "context.hpp"
#include "frame_plan.hpp"
#include "framebuffer.hpp"
#include "glass_shape.hpp"
#include "gpu_scene.hpp"
#include "passes/background_pass.hpp"
#include "passes/edge_pass.hpp"
#include "passes/id_pass.hpp"
#include "passes/mark_pass.hpp"
#include "passes/mirror_pass.hpp"
#include "passes/opaque_pass.hpp"
#include "passes/outline_pass.hpp"
#include "passes/pixel_sort_pass.hpp"
#include "passes/transparent_pass.hpp"
#include "projection.hpp"
#include "sampling.hpp"

namespace vrut {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kKeptWithoutLayers = 100;  // pictures

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void add(const std::vector<std::uint8_t>& sample, Accumulation& sum) {
    for (std::size_t k = 0; k < sample.size(); ++k) sum.sums[k] += sample[k];
    ++sum.samples;
}

void average(std::span<const std::uint32_t> sums, int samples, std::span<std::uint8_t> rgba) {
    // Division in float is vectorised, where bytes cannot lie over what holds them, and exact here: the sums
    // are integers far below 2^24.
    const auto count = static_cast<float>(samples), half = std::floor(count / 2);
    for (std::size_t k = 0; k < rgba.size(); ++k)
        rgba[k] = static_cast<std::uint8_t>((static_cast<float>(sums[k]) + half) / count);
}

}  // namespace

struct Renderer::Impl {
    Impl(std::optional<int> device, bool debug) : context({device, debug}) {}

    /// All that drawing changes, too: a picture before may have failed in the midst of it.
    void set_up_drawing() {
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        glClearDepth(0);
        glEnable(GL_DEPTH_TEST);
        glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
        glDisable(GL_DITHER);
        glDisable(GL_SCISSOR_TEST);
        glDisable(GL_BLEND);
        glDepthMask(GL_TRUE);
        glDepthRange(0, 1);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }

    void require_context() const {
        if (context.lost()) throw ContextLost("the graphics driver has reset itself");
    }

    static void require_memory() {
        constexpr int kMostErrors = 100;
        GLenum error = glGetError();
        for (int i = 0; i < kMostErrors && error != GL_NO_ERROR && error != GL_OUT_OF_MEMORY; ++i)
            error = glGetError();
        if (error == GL_OUT_OF_MEMORY) throw OutOfMemory("the graphics driver has no memory to draw with");
    }

    /// Draws. The one place that asks whether the context was lost meanwhile, whatever that made of it, and
    /// whether there was too little memory for something.
    template <class Draw>
    auto draw_or_fail(Draw draw) {
        try {
            set_up_drawing();
            auto drawn = draw();
            require_context();
            require_memory();
            return drawn;
        } catch (const std::bad_alloc&) {
            require_context();
            throw OutOfMemory("this machine has no memory left to draw with");
        } catch (const std::exception&) {
            require_context();
            throw;
        }
    }

    bool render(const View& view, Image& image, FrameStats& stats, const std::function<bool()>& interrupted,
                Accumulation* kept);

    void use_target(int width, int height, bool deep) {
        if (target && target->width() == width && target->height() == height && target->deep() == deep)
            return;
        target.reset();  // the old one's memory is free before the new one takes its own
        target.emplace(width, height, deep);
    }

    /// What turns has panes now that only pixels order, now not: room for them is kept for a while.
    void keep_room_for_layers(bool needed) {
        pictures_without_layers = needed ? 0 : pictures_without_layers + 1;
        if (pictures_without_layers > kKeptWithoutLayers) pixel_sort.release();
    }

    void use_scene(const std::shared_ptr<const Scene>& wanted) {
        if (scene && scene->scene() == wanted) return;
        scene.reset();
        if (taken && taken->scene() == wanted)
            scene = std::move(taken);
        else
            scene = std::make_unique<GpuScene>(wanted);
        taken.reset();
        shapes.emplace(*wanted);
    }

    void take(const View& view) {
        taken.reset();
        if (scene && scene->scene() == view.scene->scene) return;
        auto next = std::make_unique<GpuScene>(view.scene->scene);
        next->upload_shown(view);
        taken = std::move(next);
    }

    /// Gives back what was drawn with; what is needed comes again.
    void release() {
        scene.reset();
        taken.reset();
        target.reset();
        mirrors.release();
        pixel_sort.release();
        sample = {};
        accumulation = {};
    }

    void draw_layers(const Layers& layers, const View& view, const Sight& sight, const Framebuffer& into,
                     FrameStats& stats) {
        programs.begin(sight, view, scene ? &*scene : nullptr);
        if (!layers.opaque.empty()) opaque.draw(layers.opaque, *scene, view.mode, programs, stats);
        // What a mirror shows costs as much as the picture: it is drawn only where the mirror can be seen.
        const std::vector<bool> seen =
            layers.mirrors.empty() ? std::vector<bool>()
                                   : mirrors.seen(layers.mirrors, *scene, sight.clip_from_view, stats);
        for (std::size_t i = 0; i < seen.size(); ++i)
            if (seen[i]) draw_mirror(layers.mirrors[i], view, sight, into, stats);
        for (const TransparentGroup& group : layers.transparent)
            if (group.exact)
                pixel_sort.draw(group.items, *scene, sight.clip_from_view, into, programs, stats);
            else
                transparent.draw(group.items, *scene, programs, stats);
    }

    void draw_mirror(const MirrorItem& mirror, const View& view, const Sight& sight, const Framebuffer& into,
                     FrameStats& stats) {
        const Sight reflected{sight.clip_from_view, mirror.reflection * sight.view_from_world};
        const Framebuffer& reflection =
            mirrors.open(mirror, *scene, sight.clip_from_view, view.background.color, into, stats);
        if (BackgroundPass::is_needed(view)) background.draw(reflected, view, *scene, stats);
        draw_layers(mirror.reflected, view, reflected, reflection, stats);
        programs.begin(sight, view, &*scene);
        mirrors.close(mirror, *scene, into, programs, stats);
    }

    void draw(const FramePlan& plan, const View& view, double near, const glm::dvec2& offset,
              FrameStats& stats) {
        target->bind();
        glClearColor(static_cast<float>(view.background.color.r), static_cast<float>(view.background.color.g),
                     static_cast<float>(view.background.color.b), 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        const glm::dmat4 clip = reversed_clip_from_view(view, near, offset);
        const Sight sight{clip, view_from_world(view.camera)};
        if (BackgroundPass::is_needed(view)) background.draw(sight, view, *scene, stats);
        if (plan.scene.mirrors.empty() && plan.over.mirrors.empty()) mirrors.release();
        draw_layers(plan.scene, view, sight, *target, stats);
        if (!plan.edges.empty()) edges.draw(plan.edges, *scene, view.mode, clip, programs, stats);
        if (!plan.selected.empty()) draw_selection(plan, view, sight, stats);
        if (plan.marks.empty()) return;
        const auto cover = view.wireframe ? MarkPass::Cover::none : MarkPass::Cover::by_depth;
        marks.draw(plan.marks, cover, clip, *target, stats);
    }

    void draw_selection(const FramePlan& plan, const View& view, const Sight& sight, FrameStats& stats) {
        const glm::dmat4& clip = sight.clip_from_view;
        if (view.wireframe) return edges.draw_over(plan.selected, *scene, kSelection, clip, stats);
        opaque.move_behind(plan.selected, *scene, clip, stats);
        draw_layers(plan.over, view, sight, *target, stats);
        if (view.mode == DrawMode::stylized)
            edges.draw(plan.selected, *scene, view.mode, clip, programs, stats);
        outline.draw(plan.selected, *scene, clip, *target, stats);
    }

    GlContext context;  // first: destroyed after everything below
    std::unique_ptr<GpuScene> scene, taken;
    std::optional<GlassShapes> shapes;
    std::optional<Framebuffer> target;
    SurfacePrograms programs;
    BackgroundPass background;
    OpaquePass opaque;
    TransparentPass transparent;
    PixelSortPass pixel_sort;
    int pictures_without_layers = 0;  // since the last with them
    MirrorPass mirrors;
    EdgePass edges;
    OutlinePass outline;
    MarkPass marks;
    IdPass ids;
    std::vector<std::uint8_t> sample;
    Accumulation accumulation;  // of pictures whose samples the caller does not keep
};

bool Renderer::Impl::render(const View& view, Image& image, FrameStats& stats,
                            const std::function<bool()>& interrupted, Accumulation* kept) {
    stats = {};
    image.resize(view.width, view.height);

    Clock::time_point start = Clock::now();
    if (view.scene) use_scene(view.scene->scene);
    const FramePlan plan = plan_frame(view, shapes ? &*shapes : nullptr);
    const bool has_glass = has_transparent(plan.scene) || has_transparent(plan.over);
    use_target(view.width, view.height, has_glass);
    keep_room_for_layers(has_exact_group(plan.scene) || has_exact_group(plan.over));
    const double near = fit_clip_range(view.camera, view.scene ? view.scene->bounds : Bounds()).near;
    const int uploads_before = scene ? scene->uploads() : 0;
    Accumulation& sum = kept ? *kept : accumulation;
    const bool goes_on =
        kept && kept->samples > 0 && kept->samples < view.samples && kept->sums.size() == image.rgba.size();
    if (!goes_on) sum.samples = 0;
    if (view.samples > 1 && !goes_on) sum.sums.assign(image.rgba.size(), 0);
    const int first = sum.samples;
    for (int i = first; i < view.samples; ++i) {
        if (i > first && interrupted && interrupted()) return false;
        draw(plan, view, near, sample_offset(i, view.samples), stats);
        wait_for_gl();
        ++stats.samples;
        stats.render_ms += milliseconds_since(start);
        stats.uploads = (scene ? scene->uploads() : 0) - uploads_before;

        start = Clock::now();
        std::vector<std::uint8_t>& pixels = view.samples > 1 ? sample : image.rgba;
        pixels.resize(image.rgba.size());
        target->read(pixels);
        ++stats.readbacks;
        if (view.samples > 1) add(pixels, sum);
        stats.readback_ms += milliseconds_since(start);
        start = Clock::now();
    }
    if (view.samples > 1) {
        average(sum.sums, sum.samples, image.rgba);
        stats.readback_ms += milliseconds_since(start);
    }
    if (kept) *kept = {};
    return true;
}

Renderer::Renderer(std::optional<int> device, bool debug) : impl_(std::make_unique<Impl>(device, debug)) {}
Renderer::~Renderer() = default;

const std::string& Renderer::description() const { return impl_->context.description(); }
const std::vector<std::string>& Renderer::rejected() const { return impl_->context.rejected(); }
bool Renderer::software() const { return impl_->context.software(); }
int Renderer::max_size() const { return impl_->context.max_size(); }
long Renderer::gl_objects() const { return live_gl_objects(); }
std::vector<std::string> Renderer::take_messages() { return impl_->context.take_messages(); }

bool Renderer::render(const View& view, Image& image, FrameStats& stats,
                      const std::function<bool()>& interrupted, Accumulation* kept) {
    const auto draw = [&] {
        return impl_->draw_or_fail([&] { return impl_->render(view, image, stats, interrupted, kept); });
    };
    try {
        return draw();
    } catch (const OutOfMemory&) {
        // Much may be there of pictures before: levels of detail, edges, the target of a larger one.
        impl_->release();
        if (kept) *kept = {};
    }
    return draw();
}

void Renderer::take(const View& view) {
    impl_->draw_or_fail([&] {
        impl_->take(view);
        return true;
    });
}

std::vector<Index> Renderer::node_ids(const View& view) {
    if (!view.scene)
        return std::vector<Index>(
            static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height), kNone);
    return impl_->draw_or_fail([&] {
        impl_->use_scene(view.scene->scene);
        const double near = fit_clip_range(view.camera, view.scene->bounds).near;
        return impl_->ids.draw(faces_of(view), *impl_->scene, view.width, view.height,
                               reversed_clip_from_view(view, near, glm::dvec2(0)));
    });
}

}  // namespace vrut
