#include "renderer/renderer.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <list>

#include "gl/context.hpp"
#include "gl/framebuffer.hpp"
#include "gl/gpu_scene.hpp"
#include "gl/passes/depth_pass.hpp"
#include "gl/passes/drawing.hpp"
#include "gl/passes/id_pass.hpp"
#include "gl/resolver.hpp"
#include "gl/sample_drawing.hpp"
#include "plan/cut_cache.hpp"
#include "plan/frame_plan.hpp"
#include "plan/occlusion_culling.hpp"
#include "plan/transparency_cache.hpp"

namespace vrut::renderer {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

struct Renderer::Impl {
    Impl(std::optional<int> device, bool debug) : context({device, debug}) {}

    void require_context() const {
        if (context.lost()) throw base::ContextLost("the graphics driver has reset itself");
    }

    /// Draws. The one place that asks whether the context was lost meanwhile, whatever that made of it, and
    /// whether OpenGL reported an error. Errors of a frame that failed before are no errors of this one.
    template <class Draw>
    auto draw_or_fail(Draw draw) {
        try {
            gl::take_gl_error();
            gl::set_constant_state();
            auto drawn = draw();
            require_context();
            gl::throw_on_gl_error("to draw");
            return drawn;
        } catch (const std::bad_alloc&) {
            require_context();
            throw base::OutOfMemory("this machine has no memory left to draw with");
        } catch (const std::exception&) {
            require_context();
            throw;
        }
    }

    void use_scene(const std::shared_ptr<const scene::Scene>& wanted) {
        if (scene && scene->scene() == wanted) return;
        scene.reset();
        for (const gl::SampleDrawing& sample : in_flight)
            if (sample.scene() && sample.scene()->scene() == wanted) scene = sample.scene();
        if (!scene && staged && staged->scene() == wanted) scene = std::move(staged);
        if (!scene) scene = std::make_shared<gl::GpuScene>(wanted);
        staged.reset();
        shapes.emplace(*wanted);
        cuts = {};
        occlusion = std::make_shared<plan::OcclusionHistory>(wanted->nodes().size());
    }

    bool upload_step(const plan::View& view) {
        constexpr std::chrono::milliseconds kPatience{2};
        const std::shared_ptr<const scene::Scene>& wanted = view.scene->scene;
        forget_abandoned_samples();
        auto next = std::exchange(staged, nullptr);  // given up if this throws
        if (!next || next->scene() != wanted) {
            next = scene && scene->scene() == wanted ? scene : std::make_shared<gl::GpuScene>(wanted);
            if (next != scene) next->request_shown(view);
        }
        plan::DrawBudget budget(context.software(), plan::DrawBudget::kMostUpload);
        if (next != scene) next->upload(budget);
        const bool compiled = programs.compile_step(*wanted, view.methods, budget);
        if (budget.spent() == 0 && !next->is_complete()) next->wait(kPatience);
        gl::wait_for_gl();
        staged = next;
        return compiled && (next == scene || next->is_complete());
    }

    /// Gives back what was drawn with; what is needed comes again.
    void release() {
        scene.reset();
        staged.reset();
        in_flight.clear();
        targets.reset();
        resolver->release();
    }

    /// What draws the rendering's next sample.
    gl::SampleDrawing& sample_of(const plan::RenderJob& job) {
        const auto is_its = [&](const gl::SampleDrawing& sample) { return sample.belongs_to(job); };
        if (const auto found = std::ranges::find_if(in_flight, is_its); found != in_flight.end())
            return *found;
        forget_abandoned_samples();
        if (!targets) targets = std::make_unique<gl::SampleTargets>(programs);
        return in_flight.emplace_back(job, job.view.scene ? scene : nullptr, occlusion, std::move(targets));
    }

    void forget_abandoned_samples() {
        for (gl::SampleDrawing& sample : in_flight)
            if (sample.abandoned()) targets = sample.release();
        std::erase_if(in_flight, [](const gl::SampleDrawing& sample) { return sample.abandoned(); });
    }

    void forget_sample_of(const plan::RenderJob& job) {
        std::erase_if(in_flight, [&](const gl::SampleDrawing& sample) { return sample.belongs_to(job); });
    }

    bool step(plan::RenderJob& job);
    bool draw(plan::RenderJob& job);
    void read_depth(plan::RenderJob& job, const gl::Framebuffer& target);
    double time_resolver();
    double try_resolver(ResolveOn where);
    void use_resolver(ResolveOn where);

    gl::GlContext context;  // first: destroyed after everything below
    gl::SubmittedWork submitted;
    std::shared_ptr<gl::GpuScene> scene, staged;
    std::optional<plan::TransparencyCache> shapes;
    plan::CutCache cuts;
    std::shared_ptr<plan::OcclusionHistory> occlusion;  // of the scene's nodes
    gl::Programs programs;
    gl::Passes passes{programs};
    std::list<gl::SampleDrawing> in_flight;      // of renderings that wait
    std::unique_ptr<gl::SampleTargets> targets;  // of a sample before, for the next
    gl::IdPass ids{programs};
    gl::DepthPass depths{programs};
    std::unique_ptr<gl::Resolver> resolver = gl::make_cpu_resolver();
    std::vector<float> depth;  // of a strip of the image drawn last
};

void Renderer::Impl::read_depth(plan::RenderJob& job, const gl::Framebuffer& target) {
    const Clock::time_point start = Clock::now();
    // A strip is still in the processor's cache when it is sampled. With a graphics card, each read waits.
    constexpr int kStrip = 1 << 14;
    warp::DepthSamples samples(target.width(), target.height(), job.depth_size);
    const int rows = context.software() ? std::max(kStrip / target.width(), 1) : target.height();
    for (int first = 0; first < target.height(); first += rows) {
        const int count = std::min(rows, target.height() - first);
        depth.resize(static_cast<std::size_t>(target.width()) * static_cast<std::size_t>(count));
        target.read_depth(first, depth);
        samples.add(depth);
    }
    job.depth = samples.map(plan::near_distance(job.view), scene ? depths.read() : std::span<const float>());
    job.stats.readback_ms += milliseconds_since(start);
}

/// True if a sample is drawn: then the resolver has read it.
bool Renderer::Impl::draw(plan::RenderJob& job) {
    const plan::View& view = job.view;
    plan::FrameStats& stats = job.stats;
    const Clock::time_point start = Clock::now();
    if (view.scene) use_scene(view.scene->scene);
    plan::DrawBudget budget(context.software());
    if (!job.planner) job.planner = std::make_shared<plan::FramePlanner>();
    plan::IsResident is_resident;
    if (job.interactive)
        is_resident = [this](scene::Index geometry, const mesh::DetailLevel& level) {
            return scene->can_draw(geometry, level);
        };
    if (view.scene && !job.planner->step(view, {*shapes, cuts}, budget, is_resident)) {
        stats.render_ms += milliseconds_since(start);
        return false;
    }
    const int uploads_before = scene ? scene->uploads() : 0, programs_before = programs.compiled();
    gl::SampleDrawing& sample = sample_of(job);
    const bool drawn = sample.draw(job, passes, budget);
    const bool has_depth = job.depth_size.columns > 0 && job.samples == 0;
    if (drawn && has_depth && scene)
        depths.draw(job.planner->plan().scene, *scene,
                    math::reversed_clip_from_view(plan::projection_of(view), plan::near_distance(view)),
                    warp::kAddedSide * job.depth_size.columns, warp::kAddedSide * job.depth_size.rows);
    drawn ? gl::wait_for_gl() : submitted.submit();
    if (drawn) sample.subtract_discarded(stats);
    stats.render_ms += milliseconds_since(start);
    stats.programs += programs.compiled() - programs_before;
    stats.uploads += (scene ? scene->uploads() : 0) - uploads_before;
    if (!drawn) return false;

    resolver->read(job, sample.image_target());
    if (has_depth) read_depth(job, sample.image_target());
    targets = sample.release();
    ++stats.samples;
    return true;
}

bool Renderer::Impl::step(plan::RenderJob& job) {
    if (!resolver->holds(job)) job.samples = 0;
    if (job.samples == 0 || job.samples < job.view.samples) {
        bool drawn = false;
        try {
            drawn = draw_or_fail([&] { return draw(job); });
        } catch (...) {
            forget_sample_of(job);
            throw;
        }
        if (!drawn) return false;
        forget_sample_of(job);
        resolver->add(job);
        job.memory_released = false;
        if (job.samples < job.view.samples) return false;
    }
    return draw_or_fail([&] { return resolver->resolve(job); });
}

/// Returns milliseconds for an image of one sample and one of four.
double Renderer::Impl::time_resolver() {
    constexpr int kWidth = 640, kHeight = 360;
    plan::View view;
    view.width = kWidth;
    view.height = kHeight;
    gl::Framebuffer target(kWidth, kHeight);
    double best = std::numeric_limits<double>::infinity();
    for (int repetition = 0; repetition < 2; ++repetition) {  // the first compiles programs
        const Clock::time_point start = Clock::now();
        for (const int samples : {1, 4}) {
            view.samples = samples;
            plan::RenderJob job(view);
            job.output = plan::RenderJob::Output::ycbcr_420;
            job.planner = std::make_shared<plan::FramePlanner>();
            while (job.samples < samples) {
                resolver->read(job, target);
                resolver->add(job);
            }
            while (!resolver->resolve(job)) {
            }
        }
        best = std::min(best, milliseconds_since(start));
    }
    return best;
}

/// As time_resolver(); infinity if it fails.
double Renderer::Impl::try_resolver(ResolveOn where) {
    try {
        use_resolver(where);
        return draw_or_fail([&] { return time_resolver(); });
    } catch (const base::OutOfMemory&) {
    } catch (const base::GlError&) {
    }
    return std::numeric_limits<double>::infinity();
}

void Renderer::Impl::use_resolver(ResolveOn where) {
    resolver = where == ResolveOn::gpu ? gl::make_gpu_resolver(programs) : gl::make_cpu_resolver();
}

Renderer::Renderer(std::optional<int> device, bool debug) : impl_(std::make_unique<Impl>(device, debug)) {}
Renderer::~Renderer() = default;

const std::string& Renderer::description() const { return impl_->context.description(); }
const std::vector<std::string>& Renderer::rejected() const { return impl_->context.rejected(); }
bool Renderer::software() const { return impl_->context.software(); }
int Renderer::max_size() const { return impl_->context.max_size(); }
long Renderer::gl_objects() const { return gl::live_gl_objects(); }
std::vector<std::string> Renderer::take_messages() { return impl_->context.take_messages(); }

void Renderer::use_resolver(ResolveOn where) { impl_->use_resolver(where); }

ResolverTimes Renderer::choose_resolver() {
    const ResolverTimes times{impl_->try_resolver(ResolveOn::cpu), impl_->try_resolver(ResolveOn::gpu)};
    use_resolver(times.faster());
    return times;
}

bool Renderer::step(plan::RenderJob& job) {
    try {
        return impl_->step(job);
    } catch (const base::OutOfMemory&) {
        if (job.memory_released) throw;
        // Much may be there of images before: levels of detail, edges, the targets of larger ones.
        impl_->release();
        job.memory_released = true;
        return false;
    }
}

void Renderer::render(const plan::View& view, scene::Image& image, plan::FrameStats& stats) {
    plan::RenderJob job(view, std::move(image));
    while (!step(job)) {
    }
    image = std::move(job.image);
    stats = job.stats;
}

bool Renderer::upload_step(const plan::View& view) {
    return impl_->draw_or_fail([&] { return impl_->upload_step(view); });
}

void Renderer::upload(const plan::View& view) {
    while (!upload_step(view)) {
    }
}

std::vector<scene::Index> Renderer::node_ids(const plan::View& view) {
    if (!view.scene)
        return std::vector<scene::Index>(
            static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height), scene::kNone);
    return impl_->draw_or_fail([&] {
        impl_->use_scene(view.scene->scene);
        return impl_->ids.draw(
            plan::visible_faces(view, impl_->cuts), *impl_->scene, view.width, view.height,
            math::reversed_clip_from_view(plan::projection_of(view), plan::near_distance(view)));
    });
}

}  // namespace vrut::renderer
