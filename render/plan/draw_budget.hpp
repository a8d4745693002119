#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// The work that one step of drawing may still do, in units of about 20 ns: the time in which a CPU
/// rasterizer shades one pixel. Items are never split, so a step may exceed kMost by one item.
class DrawBudget {
public:
    static constexpr std::int64_t kMost = 4'000'000;
    /// Graphics cards take next to nothing for a pixel.
    explicit DrawBudget(bool software) : pixel_weight_(software ? 64 : 1) {}

    bool is_spent() const { return left_ <= 0; }
    void spend(std::int64_t work) { left_ -= work; }
    void spend_pixels(std::int64_t pixels) { left_ -= pixels * pixel_weight_ / 64; }
    /// Returns the first `items` that the budget allows to draw within `box`, at least one if the budget is
    /// not spent. `is_uploaded` returns true if an item's geometry is on the GPU already.
    std::span<const DrawItem> next_batch(std::span<const DrawItem> items, const scene::Scene& scene,
                                         const glm::dmat4& clip_from_view, const math::PixelBox& box,
                                         const glm::ivec2& viewport,
                                         const std::function<bool(const DrawItem&)>& is_uploaded);

private:
    std::int64_t left_ = kMost;
    std::int64_t pixel_weight_;  // of 64
};

}  // namespace vrut::plan
