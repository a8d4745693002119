#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gl/framebuffer.hpp"
#include "gl/gpu_scene.hpp"
#include "gl/passes/background_pass.hpp"
#include "gl/passes/edge_pass.hpp"
#include "gl/passes/marker_pass.hpp"
#include "gl/passes/mirror_pass.hpp"
#include "gl/passes/opaque_pass.hpp"
#include "gl/passes/outline_pass.hpp"
#include "gl/passes/per_pixel_lists_pass.hpp"
#include "gl/passes/transparent_pass.hpp"
#include "plan/draw_budget.hpp"
#include "plan/draw_commands.hpp"
#include "plan/render_job.hpp"

namespace vrut::gl {

/// Passes that hold nothing of a sample that is not whole.
struct Passes {
    explicit Passes(Programs& compiled)
        : programs(compiled), background(compiled), opaque(compiled), edges(compiled), markers(compiled) {}
    SurfacePrograms programs;
    BackgroundPass background;
    OpaquePass opaque;
    TransparentPass transparent;
    EdgePass edges;
    MarkerPass markers;
};

/// What holds a sample until it is whole.
struct SampleTargets {
    explicit SampleTargets(Programs& programs)
        : mirrors(programs), per_pixel_lists(programs), outline(programs) {}
    std::optional<Framebuffer> image_target;
    MirrorPass mirrors;
    PerPixelListsPass per_pixel_lists;
    OutlinePass outline;
    int images_without_lists = 0;  ///< since the last with them
};

/// The next sample of a rendering, which may take several steps. Others may be drawn between them.
class SampleDrawing {
public:
    /// `scene` is the rendering's; null where it has none.
    SampleDrawing(const plan::RenderJob& job, std::shared_ptr<GpuScene> scene,
                  std::unique_ptr<SampleTargets> targets);

    bool belongs_to(const plan::RenderJob& job) const { return planner_.lock() == job.planner; }
    /// Whether nobody has the rendering any more.
    bool abandoned() const { return planner_.expired(); }
    /// Kept until the sample is drawn, though others are drawn between its steps.
    const std::shared_ptr<GpuScene>& scene() const { return scene_; }

    /// Draws on, until `work` is spent. True if the sample is drawn: then the picture's target holds it.
    /// Until all that it takes is on the GPU it draws nothing, but uploads as much as
    /// DrawBudget::kMostUpload.
    bool draw(plan::RenderJob& job, Passes& passes, plan::DrawBudget& budget);

    Framebuffer& image_target() { return *targets_->image_target; }
    /// For another sample, whether this one is drawn or not.
    std::unique_ptr<SampleTargets> release() {
        targets_->per_pixel_lists.abandon();
        return std::move(targets_);
    }

private:
    struct StepContext;  ///< what drawing is given, and what is bound meanwhile
    void use_target(const plan::View& view, bool rgba16);
    bool request_all(const plan::RenderJob& job) const;
    bool upload(const plan::RenderJob& job, plan::DrawBudget& budget) const;
    void bind_target(const plan::MirrorItem* mirror, StepContext& step);
    /// True if the command is done.
    bool execute_if_seen(const plan::DrawCommand& command, StepContext& step);
    bool execute(const plan::DrawCommand& command, StepContext& step);
    void draw_once(const plan::DrawCommand& command, StepContext& step);
    void draw_items(const plan::DrawCommand& command, std::span<const plan::DrawItem> items,
                    StepContext& step);
    bool draw_per_pixel_lists(const plan::DrawCommand& command, StepContext& step);
    void clear(StepContext& step);
    void find_mirrors(const plan::DrawCommand& command, StepContext& step);
    void open(const plan::MirrorItem& mirror, StepContext& step);
    std::size_t index_of(const plan::MirrorItem& mirror) const;
    /// True if the mirror is known not to be seen. What was drawn of it before that was known, which the GPU
    /// has discarded, is taken out of the counts.
    bool is_hidden(const plan::MirrorItem& mirror, StepContext& step);
    std::span<const plan::DrawItem> next_batch(const plan::DrawCommand& command, const math::PixelBox& box,
                                               StepContext& step) const;
    math::PixelBox full_viewport() const;
    CameraMatrices camera_in(const plan::MirrorItem* mirror) const;

    std::weak_ptr<const plan::FramePlanner> planner_;
    std::shared_ptr<GpuScene> scene_;
    std::unique_ptr<SampleTargets> targets_;
    CameraMatrices camera_;
    std::vector<plan::DrawCommand> commands_;
    std::size_t command_ = 0, item_ = 0;         // the next
    std::span<const plan::MirrorItem> queried_;  // the mirrors of the last find_mirrors
    std::vector<std::optional<bool>> seen_;      // of each; none while the GPU has not answered
    plan::FrameStats stats_before_mirror_;       // the last that was opened
};

}  // namespace vrut::gl
