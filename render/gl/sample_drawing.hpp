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
#include "gl/passes/occlusion_pass.hpp"
#include "gl/passes/opaque_pass.hpp"
#include "gl/passes/outline_pass.hpp"
#include "gl/passes/per_pixel_lists_pass.hpp"
#include "gl/passes/transparent_pass.hpp"
#include "plan/draw_budget.hpp"
#include "plan/draw_commands.hpp"
#include "plan/occlusion_culling.hpp"
#include "plan/render_job.hpp"

namespace vrut::gl {

/// Passes without state between the steps of a sample.
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

/// Targets and passes that hold a sample between its steps.
struct SampleTargets {
    explicit SampleTargets(Programs& programs)
        : occlusion(programs), mirrors(programs), per_pixel_lists(programs), outline(programs) {}
    std::optional<Framebuffer> image_target;
    OcclusionPass occlusion;
    MirrorPass mirrors;
    PerPixelListsPass per_pixel_lists;
    OutlinePass outline;
    int images_without_lists = 0;  ///< since the last one with per-pixel lists
};

/// Draws the next sample of a job, in several steps if need be. Other samples may be drawn between them.
class SampleDrawing {
public:
    /// `scene` is the job's, and `history` that of its nodes; null if it has none.
    SampleDrawing(const plan::RenderJob& job, std::shared_ptr<GpuScene> scene,
                  std::shared_ptr<plan::OcclusionHistory> history, std::unique_ptr<SampleTargets> targets);

    bool belongs_to(const plan::RenderJob& job) const { return planner_.lock() == job.planner; }
    /// Returns true if the job no longer exists.
    bool abandoned() const { return planner_.expired(); }
    /// It stays on the GPU until the sample is drawn, even if samples of another scene are drawn between.
    const std::shared_ptr<GpuScene>& scene() const { return scene_; }

    /// Draws until `budget` is spent. Returns true if the sample is complete: image_target() then holds it.
    /// While a resource that it needs is not resident, it uploads up to DrawBudget::kMostUpload instead.
    bool draw(plan::RenderJob& job, Passes& passes, plan::DrawBudget& budget);

    Framebuffer& image_target() { return *targets_->image_target; }
    /// Of a complete sample that the GPU has drawn: subtracts what the GPU has discarded of mirrors that are
    /// hidden.
    void subtract_discarded(plan::FrameStats& stats);
    /// Returns the targets for another sample, whether this one is complete or not.
    std::unique_ptr<SampleTargets> release() {
        targets_->per_pixel_lists.abandon();
        return std::move(targets_);
    }

private:
    struct StepContext;  ///< the arguments of a step, and the target that is bound
    void use_target(const plan::View& view, bool rgba16);
    bool request_all(const plan::RenderJob& job) const;
    bool upload(const plan::RenderJob& job, plan::DrawBudget& budget) const;
    void bind_target(const plan::MirrorItem* mirror, StepContext& step);
    /// Returns true if the command is done.
    bool execute_if_seen(const plan::DrawCommand& command, StepContext& step);
    bool execute(const plan::DrawCommand& command, StepContext& step);
    void draw_once(const plan::DrawCommand& command, StepContext& step);
    void draw_items(const plan::DrawCommand& command, std::span<const plan::DrawItem> items,
                    StepContext& step);
    bool draw_per_pixel_lists(const plan::DrawCommand& command, StepContext& step);
    void cull_occluded(const plan::RenderJob& job);
    bool query_boxes(StepContext& step);
    void record(std::size_t first_box, std::size_t end);
    bool finish_occlusion(const plan::RenderJob& job);
    void clear(StepContext& step);
    void find_mirrors(const plan::DrawCommand& command, StepContext& step);
    void open(const plan::MirrorItem& mirror, StepContext& step);
    std::size_t index_of(const plan::MirrorItem& mirror) const;
    /// Returns true if the mirror is known to be hidden. What is drawn of it before is subtracted from the
    /// statistics: the GPU discards it.
    bool is_hidden(const plan::MirrorItem& mirror, StepContext& step);
    std::span<const plan::DrawItem> next_batch(const plan::DrawCommand& command, const math::PixelBox& box,
                                               StepContext& step) const;
    math::PixelBox full_viewport() const;
    CameraMatrices camera_in(const plan::MirrorItem* mirror) const;

    std::weak_ptr<const plan::FramePlanner> planner_;
    std::shared_ptr<GpuScene> scene_;
    std::shared_ptr<plan::OcclusionHistory> history_;
    std::unique_ptr<SampleTargets> targets_;
    CameraMatrices camera_;
    std::vector<plan::DrawCommand> commands_;
    plan::OcclusionPlan occlusion_;
    std::vector<plan::DrawItem> revealed_;       // the culled items that are visible
    std::size_t command_ = 0, item_ = 0;         // the next
    std::span<const plan::MirrorItem> queried_;  // the mirrors of the last find_mirrors
    std::vector<std::optional<bool>> seen_;      // of each; none while the GPU has not answered
    plan::FrameStats stats_before_mirror_;       // the last that was opened
    /// What is drawn of mirrors that may be hidden, each with its index.
    std::vector<std::pair<std::size_t, plan::FrameStats>> discardable_;
};

}  // namespace vrut::gl
