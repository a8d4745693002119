#include "gl/sample_drawing.hpp"

#include <algorithm>

#include "gl/passes/drawing.hpp"
#include "math/sample_sequence.hpp"
#include "plan/projection.hpp"
#include "scene/colors.hpp"

namespace vrut {

namespace {

using Kind = DrawCommand::Kind;

constexpr int kKeptWithoutLayers = 100;  // images

/// In units of StepWork; a full-screen pass takes these for each pixel, a layer is looked at a few times.
constexpr std::int64_t kScreenPixel = 1, kLayer = 8;

glm::dmat4 clip_of(const Rendering& rendering) {
    const View& view = rendering.view;
    const double near = fit_clip_range(view.camera, view.scene ? view.scene->bounds : Bounds()).near;
    return reversed_clip_from_view(view, near, sample_offset(rendering.samples, view.samples));
}

}  // namespace

struct SampleDrawing::Step {
    const View& view;
    const FramePlan& plan;
    GpuScene* scene = nullptr;
    Passes& passes;
    StepWork& work;
    FrameStats& stats;
    /// What commands draw into; none after one that has changed it.
    std::optional<const MirrorItem*> entered = {};
};

SampleDrawing::SampleDrawing(const Rendering& rendering, std::unique_ptr<SampleTargets> targets)
    : planner_(rendering.planner),
      targets_(std::move(targets)),
      sight_{clip_of(rendering), view_from_world(rendering.view.camera)},
      commands_(draw_commands(rendering.planner->plan(), rendering.view)) {
    const FramePlan& plan = rendering.planner->plan();
    use_target(rendering.view, has_transparent(plan.scene) || has_transparent(plan.over));
    if (plan.scene.mirrors.empty() && plan.over.mirrors.empty()) targets_->mirrors.release();
    if (rendering.samples > 0) return;
    // What turns has panes now that only pixels order, now not: room for them is kept for a while.
    int& without = targets_->images_without_layers;
    without = has_exact_group(plan.scene) || has_exact_group(plan.over) ? 0 : without + 1;
    if (without > kKeptWithoutLayers) targets_->pixel_sort.release();
}

void SampleDrawing::use_target(const View& view, bool deep) {
    std::optional<Framebuffer>& target = targets_->picture;
    if (target && target->width() == view.width && target->height() == view.height && target->deep() == deep)
        return;
    target.reset();  // the old one's memory is free before the new one takes its own
    target.emplace(view.width, view.height, deep);
}

bool SampleDrawing::draw(Rendering& rendering, GpuScene* scene, Passes& passes, StepWork& work) {
    Step step{rendering.view, rendering.planner->plan(), scene, passes, work, rendering.stats};
    while (command_ < commands_.size() && !work.spent()) {
        const DrawCommand& command = commands_[command_];
        if (!is_hidden(command.mirror) && !carry_out(command, step)) continue;
        ++command_;
        item_ = 0;
    }
    return command_ == commands_.size();
}

bool SampleDrawing::is_hidden(const MirrorItem* mirror) const {
    return mirror && std::find(hidden_.begin(), hidden_.end(), mirror) != hidden_.end();
}

Sight SampleDrawing::sight_in(const MirrorItem* mirror) const {
    return mirror ? Sight{sight_.clip_from_view, mirror->reflection * sight_.view_from_world} : sight_;
}

PixelBox SampleDrawing::whole_picture() const {
    return {{0, 0}, {targets_->picture->width(), targets_->picture->height()}};
}

/// Another step may have drawn something else.
void SampleDrawing::enter(const MirrorItem* mirror, Step& step) {
    if (step.entered == mirror) return;
    set_up_drawing();
    if (mirror)
        targets_->mirrors.bind(*mirror);
    else
        targets_->picture->bind();
    step.passes.programs.begin(sight_in(mirror), step.view, step.scene);
    step.entered = mirror;
}

bool SampleDrawing::carry_out(const DrawCommand& command, Step& step) {
    enter(is_reflected(command) && command.kind != Kind::open_mirror ? command.mirror : nullptr, step);
    if (command.kind == Kind::layered_glass) return draw_layers(command, step);
    if (command.items.empty() || command.kind == Kind::outline) {
        draw_once(command, step);
        return true;
    }
    if (command.kind == Kind::outline_cover && item_ == 0)
        targets_->outline.begin(command.items, *step.scene, sight_.clip_from_view, *targets_->picture);
    const std::span<const DrawItem> items = take(command, whole_picture(), step);
    draw_items(command, items, step);
    item_ += items.size();
    if (item_ < command.items.size()) return false;
    if (command.kind != Kind::outline_cover) ++step.stats.passes;
    return true;
}

std::span<const DrawItem> SampleDrawing::take(const DrawCommand& command, const PixelBox& box,
                                              Step& step) const {
    return step.work.take(command.items.subspan(item_), *step.scene->scene(), sight_.clip_from_view, box,
                          whole_picture().high,
                          [&](const DrawItem& item) { return step.scene->holds(item); });
}

void SampleDrawing::draw_items(const DrawCommand& command, std::span<const DrawItem> items, Step& step) {
    const glm::dmat4& clip = sight_.clip_from_view;
    Passes& passes = step.passes;
    switch (command.kind) {
        case Kind::opaque:
            return passes.opaque.draw(items, *step.scene, step.view.mode, passes.programs, step.stats);
        case Kind::sorted_glass:
            return passes.transparent.draw(items, *step.scene, passes.programs, step.stats);
        case Kind::edges:
            return passes.edges.draw(items, *step.scene, step.view.mode, clip, passes.programs, step.stats);
        case Kind::edges_over:
            return passes.edges.draw_over(items, *step.scene, kSelection, clip, step.stats);
        case Kind::move_behind:
            return passes.opaque.move_behind(items, *step.scene, clip, step.stats);
        case Kind::outline_cover:
            step.entered.reset();
            return targets_->outline.cover(items, *step.scene, clip, step.stats);
        default:
            return;
    }
}

void SampleDrawing::draw_once(const DrawCommand& command, Step& step) {
    const glm::dmat4& clip = sight_.clip_from_view;
    const Framebuffer& picture = *targets_->picture;
    Passes& passes = step.passes;
    switch (command.kind) {
        case Kind::clear:
            return clear(step);
        case Kind::find_mirrors:
            return find_mirrors(command, step);
        case Kind::open_mirror:
            return open(*command.mirror, step);
        case Kind::close_mirror:
            return targets_->mirrors.close(*command.mirror, *step.scene, picture, passes.programs,
                                           step.stats);
        case Kind::outline:
            step.work.spend_pixels(kScreenPixel * picture.width() * picture.height());
            return targets_->outline.draw(picture, step.stats);
        case Kind::marks:
            return passes.marks.draw(step.plan.marks,
                                     step.view.wireframe ? MarkPass::Cover::none : MarkPass::Cover::by_depth,
                                     clip, picture, step.stats);
        default:
            return;
    }
}

void SampleDrawing::clear(Step& step) {
    const View& view = step.view;
    glClearColor(static_cast<float>(view.background.color.r), static_cast<float>(view.background.color.g),
                 static_cast<float>(view.background.color.b), 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    if (BackgroundPass::is_needed(view)) step.passes.background.draw(sight_, view, *step.scene, step.stats);
}

void SampleDrawing::find_mirrors(const DrawCommand& command, Step& step) {
    const std::vector<bool> seen =
        targets_->mirrors.seen(command.mirrors, *step.scene, sight_.clip_from_view, step.stats);
    for (std::size_t i = 0; i < seen.size(); ++i)
        if (!seen[i]) hidden_.push_back(&command.mirrors[i]);
}

void SampleDrawing::open(const MirrorItem& mirror, Step& step) {
    const View& view = step.view;
    targets_->mirrors.open(mirror, *step.scene, sight_.clip_from_view, view.background.color,
                           *targets_->picture, step.stats);
    if (BackgroundPass::is_needed(view))
        step.passes.background.draw(sight_in(&mirror), view, *step.scene, step.stats);
    step.entered.reset();
}

bool SampleDrawing::draw_layers(const DrawCommand& command, Step& step) {
    PixelSortPass& pass = targets_->pixel_sort;
    if (!pass.is_drawing())
        pass.begin(command.items, *step.scene, sight_.clip_from_view, whole_picture().high,
                   command.mirror ? command.mirror->box : whole_picture());
    if (!pass.is_drawing()) return true;  // outside the picture
    const std::span<const DrawItem> items = take(command, pass.box(), step);
    pass.collect(items, item_, *step.scene, step.passes.programs, step.stats);
    step.entered.reset();
    item_ += items.size();
    if (item_ < command.items.size()) return false;
    item_ = 0;
    step.work.spend(kLayer * static_cast<std::int64_t>(pass.composite(step.stats)));
    return !pass.is_drawing();
}

}  // namespace vrut
