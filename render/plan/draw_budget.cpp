#include "plan/draw_budget.hpp"

namespace vrut::plan {

namespace {

constexpr std::int64_t kDraw = 150, kTriangle = 3;

std::int64_t cost_of(const DrawItem& item, const scene::Scene& scene) {
    return kDraw + kTriangle * static_cast<std::int64_t>(triangle_count(item, scene));
}

}  // namespace

std::span<const DrawItem> DrawBudget::next_batch(std::span<const DrawItem> items, const scene::Scene& scene,
                                                 const glm::dmat4& clip_from_view, const math::PixelBox& box,
                                                 const glm::ivec2& viewport) {
    std::size_t count = 0;
    for (; count < items.size() && !is_spent(); ++count) {
        const DrawItem& item = items[count];
        const scene::Geometry& geometry = scene.geometries()[static_cast<std::size_t>(item.geometry)];
        const math::PixelBox covered = math::intersection(
            pixel_box(geometry.bounds, clip_from_view * item.view_from_node, viewport), box);
        if (!covered.empty()) spend_pixels(std::int64_t{covered.size().x} * covered.size().y);
        spend(cost_of(item, scene));
    }
    return items.first(count);
}

}  // namespace vrut::plan
