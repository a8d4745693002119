#pragma once

#include <cstdint>
#include <span>

#include "plan/frame_plan.hpp"

namespace vrut::plan {

/// The work that one step of drawing may still do, in units of about 20 ns: the time in which a CPU
/// rasterizer shades one pixel. Items are never split, so a step may exceed kMost by one item.
class DrawBudget {
public:
    static constexpr std::int64_t kMost = 4'000'000;
    /// For a step that uploads while frames are drawn: about 5 ms.
    static constexpr std::int64_t kMostUpload = kMost / 16;
    /// Graphics cards take next to nothing for a pixel.
    explicit DrawBudget(bool software, std::int64_t most = kMost)
        : most_(most), pixel_weight_(software ? 64 : 1) {}

    bool is_spent() const { return spent_ >= most_; }
    std::int64_t spent() const { return spent_; }
    void spend(std::int64_t work) { spent_ += work; }
    void spend_pixels(std::int64_t pixels) { spent_ += pixels * pixel_weight_ / 64; }
    /// For copying to the GPU.
    void spend_bytes(std::size_t bytes) { spent_ += static_cast<std::int64_t>(bytes) / 32; }
    /// Returns the first `items` that the budget allows to draw within `box`, at least one if the budget is
    /// not spent.
    std::span<const DrawItem> next_batch(std::span<const DrawItem> items, const scene::Scene& scene,
                                         const glm::dmat4& clip_from_view, const math::PixelBox& box,
                                         const glm::ivec2& viewport);

private:
    std::int64_t most_, spent_ = 0;
    std::int64_t pixel_weight_;  // of 64
};

}  // namespace vrut::plan
