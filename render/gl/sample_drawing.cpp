#include "gl/sample_drawing.hpp"

#include <algorithm>
#include <chrono>

#include "gl/passes/drawing.hpp"
#include "math/sample_sequence.hpp"
#include "scene/style.hpp"

namespace vrut::gl {

namespace {

using Kind = plan::DrawCommand::Kind;

constexpr int kKeepListsFor = 100;  // images

plan::FrameStats drawn_since(const plan::FrameStats& before, const plan::FrameStats& now) {
    plan::FrameStats drawn;
    drawn.passes = now.passes - before.passes;
    drawn.draws = now.draws - before.draws;
    drawn.triangles = now.triangles - before.triangles;
    return drawn;
}

void subtract(plan::FrameStats& stats, const plan::FrameStats& drawn) {
    stats.passes -= drawn.passes;
    stats.draws -= drawn.draws;
    stats.triangles -= drawn.triangles;
}

/// In units of DrawBudget; a full-screen pass takes these for each pixel, a layer is looked at a few times.
constexpr std::int64_t kScreenPixelCost = 1, kFragmentCost = 8;

/// Boxes are queried in batches; each box takes these.
constexpr std::size_t kMostBoxesOfBatch = 32;
constexpr std::int64_t kBoxCost = 1000;

glm::dmat4 clip_of(const plan::RenderJob& job) {
    const plan::View& view = job.view;
    const glm::dvec2 offset = math::sample_offset(static_cast<std::uint32_t>(job.samples));  // pixels, y down
    return math::reversed_clip_from_view(plan::projection_of(view), plan::near_distance(view),
                                         glm::dvec2(-2, 2) * offset / glm::dvec2(view.width, view.height));
}

}  // namespace

struct SampleDrawing::StepContext {
    const plan::View& view;
    const plan::FramePlan& plan;
    GpuScene* scene = nullptr;
    Passes& passes;
    plan::DrawBudget& budget;
    plan::FrameStats& stats;
    scene::Style style = plan::style_of(view);
    /// What commands draw into; none after one that has changed it.
    std::optional<const plan::MirrorItem*> bound = {};
};

SampleDrawing::SampleDrawing(const plan::RenderJob& job, std::shared_ptr<GpuScene> scene,
                             std::shared_ptr<plan::OcclusionHistory> history,
                             std::unique_ptr<SampleTargets> targets)
    : planner_(job.planner),
      scene_(std::move(scene)),
      history_(std::move(history)),
      targets_(std::move(targets)),
      camera_{clip_of(job), scene::view_from_world(job.view.camera)},
      commands_(plan::draw_commands(job.planner->plan(), job.view)) {
    const plan::FramePlan& plan = job.planner->plan();
    use_target(job.view, plan::has_transparent(plan.scene) || plan::has_transparent(plan.overlay));
    if (plan.scene.mirrors.empty() && plan.overlay.mirrors.empty()) targets_->mirrors.release();
    cull_occluded(job);
    if (job.samples > 0) return;
    // While the camera moves, per-pixel lists are needed in some images and not in others: keep their memory
    // for a while.
    int& without = targets_->images_without_lists;
    without = plan::has_exact_group(plan.scene) || plan::has_exact_group(plan.overlay) ? 0 : without + 1;
    if (without > kKeepListsFor) targets_->per_pixel_lists.release();
}

void SampleDrawing::use_target(const plan::View& view, bool rgba16) {
    std::optional<Framebuffer>& target = targets_->image_target;
    if (target && target->width() == view.width && target->height() == view.height &&
        target->rgba16() == rgba16)
        return;
    target.reset();  // the old one's memory is free before the new one takes its own
    target.emplace(view.width, view.height, rgba16);
}

/// Asks for what the sample takes. Returns true if it can be drawn.
bool SampleDrawing::request_all(const plan::RenderJob& job) const {
    const Need need = job.interactive ? Need::soon : Need::now;
    bool all = !job.view.scene || scene_->request_background(job.view);
    for (const plan::DrawCommand& command : commands_) {
        const bool edges = command.kind == Kind::edges || command.kind == Kind::edges_overlay;
        for (const plan::DrawItem& item : command.items)
            if (!edges || !scene_->request_edges(item, need))
                all = (!edges || job.interactive) && scene_->request(item, job.view.levels) && all;
        for (const plan::MirrorItem& mirror : command.mirrors)
            all = scene_->request(mirror.surface, job.view.levels) && all;
    }
    for (const auto& [geometry, level] : job.planner->plan().missing_levels)
        scene_->request(geometry, *level, job.view.levels, Need::soon);
    return all;
}

/// True if the sample can be drawn.
bool SampleDrawing::upload(const plan::RenderJob& job, plan::DrawBudget& budget) const {
    constexpr std::chrono::milliseconds kPatience{2};
    const bool all = request_all(job);
    plan::DrawBudget upload_budget(true, plan::DrawBudget::kMostUpload);
    scene_->upload(upload_budget);
    budget.spend(upload_budget.spent());
    if (!all && upload_budget.spent() == 0) scene_->wait(kPatience);
    return all;
}

bool SampleDrawing::draw(plan::RenderJob& job, Passes& passes, plan::DrawBudget& budget) {
    if (scene_ && !upload(job, budget)) return false;
    StepContext step{job.view, job.planner->plan(), scene_.get(), passes, budget, job.stats};
    while (command_ < commands_.size() && !budget.is_spent()) {
        const plan::DrawCommand& command = commands_[command_];
        if (!execute_if_seen(command, step)) continue;
        ++command_;
        item_ = 0;
    }
    return command_ == commands_.size() && finish_occlusion(job);
}

bool SampleDrawing::execute_if_seen(const plan::DrawCommand& command, StepContext& step) {
    if (!command.mirror) return execute(command, step);
    if (command.kind == Kind::open_mirror) stats_before_mirror_ = step.stats;
    if (is_hidden(*command.mirror, step)) return true;
    const std::size_t index = index_of(*command.mirror);
    if (seen_[index]) return execute(command, step);
    // The GPU is behind. It gets on meanwhile, and discards this if the mirror is not seen.
    const ConditionalRendering condition = targets_->mirrors.while_seen(index);
    const bool done = execute(command, step);
    if (done && command.kind == Kind::close_mirror)
        discardable_.emplace_back(index, drawn_since(stats_before_mirror_, step.stats));
    return done;
}

void SampleDrawing::subtract_discarded(plan::FrameStats& stats) {
    for (const auto& [mirror, drawn] : discardable_)
        if (!targets_->mirrors.seen(mirror).value_or(true)) subtract(stats, drawn);
    discardable_.clear();
}

std::size_t SampleDrawing::index_of(const plan::MirrorItem& mirror) const {
    return static_cast<std::size_t>(&mirror - queried_.data());
}

bool SampleDrawing::is_hidden(const plan::MirrorItem& mirror, StepContext& step) {
    std::optional<bool>& seen = seen_[index_of(mirror)];
    if (!seen) seen = targets_->mirrors.seen(index_of(mirror));
    if (seen.value_or(true)) return false;
    subtract(step.stats, drawn_since(stats_before_mirror_, step.stats));
    targets_->per_pixel_lists.abandon();
    return true;
}

CameraMatrices SampleDrawing::camera_in(const plan::MirrorItem* mirror) const {
    return mirror ? CameraMatrices{camera_.clip_from_view, mirror->reflection * camera_.view_from_world}
                  : camera_;
}

math::PixelBox SampleDrawing::full_viewport() const {
    return {{0, 0}, {targets_->image_target->width(), targets_->image_target->height()}};
}

/// Another step may have drawn something else.
void SampleDrawing::bind_target(const plan::MirrorItem* mirror, StepContext& step) {
    if (step.bound == mirror) return;
    if (mirror) {
        targets_->mirrors.bind(*mirror);
    } else {
        targets_->image_target->bind();
        set_scissor({});
    }
    step.passes.programs.begin(camera_in(mirror), step.view, step.scene);
    step.bound = mirror;
}

bool SampleDrawing::execute(const plan::DrawCommand& command, StepContext& step) {
    bind_target(plan::is_reflected(command) && command.kind != Kind::open_mirror ? command.mirror : nullptr,
                step);
    if (command.kind == Kind::per_pixel_glass) return draw_per_pixel_lists(command, step);
    if (command.kind == Kind::query_boxes) return query_boxes(step);
    if (command.items.empty() || command.kind == Kind::outline) {
        draw_once(command, step);
        return true;
    }
    if (command.kind == Kind::outline_mask && item_ == 0)
        targets_->outline.begin(command.items, *step.scene, camera_.clip_from_view, *targets_->image_target);
    const std::span<const plan::DrawItem> items = next_batch(command, full_viewport(), step);
    draw_items(command, items, step);
    item_ += items.size();
    if (item_ < command.items.size()) return false;
    if (command.kind != Kind::outline_mask) ++step.stats.passes;
    return true;
}

std::span<const plan::DrawItem> SampleDrawing::next_batch(const plan::DrawCommand& command,
                                                          const math::PixelBox& box,
                                                          StepContext& step) const {
    return step.budget.next_batch(command.items.subspan(item_), *step.scene->scene(), camera_.clip_from_view,
                                  box, full_viewport().high);
}

void SampleDrawing::draw_items(const plan::DrawCommand& command, std::span<const plan::DrawItem> items,
                               StepContext& step) {
    const glm::dmat4& clip = camera_.clip_from_view;
    Passes& passes = step.passes;
    switch (command.kind) {
        case Kind::opaque:
            return passes.opaque.draw(items, step.style, passes.programs, step.stats);
        case Kind::revealed:
            return targets_->occlusion.draw_revealed(items, *step.scene, clip, passes.programs, step.stats);
        case Kind::sorted_glass:
            return passes.transparent.draw(items, *step.scene, passes.programs, step.stats);
        case Kind::edges:
            return passes.edges.draw(items, *step.scene, step.style, clip, passes.programs, step.stats);
        case Kind::cut_lines:
            return passes.edges.draw_cuts(items, *step.scene, camera_in(command.mirror).clip_from_view,
                                          step.stats);
        case Kind::edges_overlay:
            return passes.edges.draw_overlay(items, *step.scene, scene::kSelection, clip, step.stats);
        case Kind::reset_depth:
            return passes.opaque.reset_depth(items, *step.scene, clip, step.stats);
        case Kind::outline_mask:
            step.bound.reset();
            return targets_->outline.draw_mask(items, *step.scene, clip, step.stats);
        default:
            return;
    }
}

void SampleDrawing::draw_once(const plan::DrawCommand& command, StepContext& step) {
    const glm::dmat4& clip = camera_.clip_from_view;
    const Framebuffer& image_target = *targets_->image_target;
    Passes& passes = step.passes;
    switch (command.kind) {
        case Kind::clear:
            return clear(step);
        case Kind::find_mirrors:
            return find_mirrors(command, step);
        case Kind::open_mirror:
            return open(*command.mirror, step);
        case Kind::close_mirror:
            return targets_->mirrors.close(*command.mirror, *step.scene, image_target, passes.programs,
                                           step.stats);
        case Kind::outline:
            step.budget.spend_pixels(kScreenPixelCost * image_target.width() * image_target.height());
            return targets_->outline.draw(image_target, step.stats);
        case Kind::markers:
            return passes.markers.draw(
                step.plan.markers,
                step.style.faces ? MarkerPass::MarkerFade::by_depth : MarkerPass::MarkerFade::none, clip,
                image_target, step.stats);
        default:
            return;
    }
}

void SampleDrawing::cull_occluded(const plan::RenderJob& job) {
    const std::vector<plan::DrawItem>& opaque = job.planner->plan().scene.opaque;
    if (opaque.empty() || !plan::culls_occluded(job.view)) return;
    occlusion_ = plan::plan_occlusion(opaque, job.view, camera_.clip_from_view, *history_);
    if (occlusion_.boxes.empty()) return;
    targets_->occlusion.begin();
    const auto of_image = [&](const plan::DrawCommand& command) {
        return command.kind == Kind::opaque && command.items.data() == opaque.data();
    };
    const auto command = std::ranges::find_if(commands_, of_image);
    if (!occlusion_.culled.empty()) command->items = occlusion_.drawn;
    commands_.insert(command + 1, {{Kind::query_boxes}, {Kind::revealed, nullptr, occlusion_.culled}});
}

/// Returns true if all boxes are queried: then the culled items that are visible are known.
bool SampleDrawing::query_boxes(StepContext& step) {
    const std::span<const plan::OcclusionBox> boxes(occlusion_.boxes);
    const std::size_t end = std::min(item_ + kMostBoxesOfBatch, boxes.size());
    targets_->occlusion.query(boxes.subspan(item_, end - item_), camera_.clip_from_view);
    step.budget.spend(kBoxCost * static_cast<std::int64_t>(end - item_));
    item_ = end;
    if (item_ < boxes.size()) return false;
    glFlush();
    // A graphics card stands still from its last query to the next command: it is waited for once, and only
    // where items would be drawn needlessly. The other results are read when the sample is complete.
    const std::vector<plan::DrawItem>& culled = occlusion_.culled;
    record(0, culled.size());
    for (const plan::DrawItem& item : culled)
        if (!history_->is_occluded(item.node)) revealed_.push_back(item);
    commands_[command_ + 1].items = revealed_;
    return true;
}

void SampleDrawing::record(std::size_t first_box, std::size_t end) {
    for (std::size_t i = first_box; i < end; ++i)
        history_->set_occluded(occlusion_.boxes[i].node, !targets_->occlusion.passed(i));
}

/// Returns false if a revealed item had a depth in common with others. There the later one in the plan's
/// order is in front, so the sample begins again, in that order.
bool SampleDrawing::finish_occlusion(const plan::RenderJob& job) {
    const OcclusionPass& pass = targets_->occlusion;
    const std::size_t boxes = occlusion_.boxes.size();
    record(occlusion_.culled.size(), boxes);
    bool tied = false;
    for (std::size_t i = 0; i < revealed_.size(); ++i) tied = pass.passed(boxes + i) || tied;
    occlusion_ = {};
    revealed_.clear();
    if (!tied) return true;
    commands_ = plan::draw_commands(job.planner->plan(), job.view);
    command_ = 0;
    return false;
}

void SampleDrawing::clear(StepContext& step) {
    const plan::View& view = step.view;
    glClearColor(static_cast<float>(view.background.color.r), static_cast<float>(view.background.color.g),
                 static_cast<float>(view.background.color.b), 1);
    apply(PipelineState());
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    if (BackgroundPass::is_needed(view)) step.passes.background.draw(camera_, view, *step.scene, step.stats);
}

void SampleDrawing::find_mirrors(const plan::DrawCommand& command, StepContext& step) {
    targets_->mirrors.query(command.mirrors, *step.scene, camera_.clip_from_view, step.stats);
    queried_ = command.mirrors;
    seen_.assign(queried_.size(), std::nullopt);
}

void SampleDrawing::open(const plan::MirrorItem& mirror, StepContext& step) {
    const plan::View& view = step.view;
    targets_->mirrors.open(mirror, *step.scene, camera_.clip_from_view, view.background.color,
                           *targets_->image_target, step.stats);
    if (BackgroundPass::is_needed(view))
        step.passes.background.draw(camera_in(&mirror), view, *step.scene, step.stats);
    step.bound.reset();
}

bool SampleDrawing::draw_per_pixel_lists(const plan::DrawCommand& command, StepContext& step) {
    PerPixelListsPass& pass = targets_->per_pixel_lists;
    if (!pass.is_drawing())
        pass.begin(command.items, *step.scene, camera_.clip_from_view, full_viewport().high,
                   command.mirror ? command.mirror->box : full_viewport());
    if (!pass.is_drawing()) return true;  // outside the image
    const std::span<const plan::DrawItem> items = next_batch(command, pass.box(), step);
    pass.collect(items, item_, *step.scene, step.passes.programs, step.stats);
    step.bound.reset();
    item_ += items.size();
    if (item_ < command.items.size()) return false;
    item_ = 0;
    step.budget.spend(kFragmentCost * static_cast<std::int64_t>(pass.composite(step.stats)));
    return !pass.is_drawing();
}

}  // namespace vrut::gl
