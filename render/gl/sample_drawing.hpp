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
#include "plan/rendering.hpp"

namespace vrut {

/// Passes that hold nothing of a sample that is not whole.
struct Passes {
    SurfacePrograms programs;
    BackgroundPass background;
    OpaquePass opaque;
    TransparentPass transparent;
    EdgePass edges;
    MarkPass marks;
};

/// What holds a sample until it is whole.
struct SampleTargets {
    std::optional<Framebuffer> picture;
    MirrorPass mirrors;
    PixelSortPass pixel_sort;
    OutlinePass outline;
    int images_without_layers = 0;  ///< since the last with them
};

/// The next sample of a rendering, which may take several steps. Others may be drawn between them.
class SampleDrawing {
public:
    SampleDrawing(const Rendering& rendering, std::unique_ptr<SampleTargets> targets);

    bool is_of(const Rendering& rendering) const { return planner_.lock() == rendering.planner; }
    /// Whether nobody has the rendering any more.
    bool abandoned() const { return planner_.expired(); }

    /// Draws on, until `work` is spent. True if the sample is drawn: then the picture's target holds it.
    /// `scene` is the rendering's; null where it has none.
    bool draw(Rendering& rendering, GpuScene* scene, Passes& passes, StepWork& work);

    Framebuffer& picture() { return *targets_->picture; }
    /// For another sample, whether this one is drawn or not.
    std::unique_ptr<SampleTargets> release() {
        targets_->pixel_sort.abandon();
        return std::move(targets_);
    }

private:
    struct Step;  ///< what drawing is given, and what is bound meanwhile
    void use_target(const View& view, bool deep);
    void enter(const MirrorItem* mirror, Step& step);
    /// True if the command is done.
    bool carry_out(const DrawCommand& command, Step& step);
    void draw_once(const DrawCommand& command, Step& step);
    void draw_items(const DrawCommand& command, std::span<const DrawItem> items, Step& step);
    bool draw_layers(const DrawCommand& command, Step& step);
    void clear(Step& step);
    void find_mirrors(const DrawCommand& command, Step& step);
    void open(const MirrorItem& mirror, Step& step);
    bool is_hidden(const MirrorItem* mirror) const;
    std::span<const DrawItem> take(const DrawCommand& command, const PixelBox& box, Step& step) const;
    PixelBox whole_picture() const;
    Sight sight_in(const MirrorItem* mirror) const;

    std::weak_ptr<const FramePlanner> planner_;
    std::unique_ptr<SampleTargets> targets_;
    Sight sight_;
    std::vector<DrawCommand> commands_;
    std::size_t command_ = 0, item_ = 0;  // the next
    std::vector<const MirrorItem*> hidden_;
};

}  // namespace vrut
