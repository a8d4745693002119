#include "step_work.hpp"

#include "gpu_scene.hpp"
#include "simplify.hpp"

namespace vrut {

namespace {

constexpr std::int64_t kDraw = 150, kTriangle = 3;
constexpr std::int64_t kUpload = 400, kUploadedTriangle = 10;  // besides, for the first draw

}  // namespace

std::int64_t StepWork::work_of(const DrawItem& item, const GpuScene& scene) const {
    const Geometry& geometry = scene.scene()->geometries()[static_cast<std::size_t>(item.geometry)];
    const auto triangles =
        static_cast<std::int64_t>((item.level ? item.level->triangles : geometry.triangles).size());
    const std::int64_t draw = kDraw + kTriangle * triangles;
    return scene.holds(item) ? draw : draw + kUpload + kUploadedTriangle * triangles;
}

std::span<const DrawItem> StepWork::take(std::span<const DrawItem> items, const GpuScene& scene,
                                         const glm::dmat4& clip_from_view, const PixelBox& box,
                                         const glm::ivec2& picture) {
    std::size_t count = 0;
    for (; count < items.size() && !spent(); ++count) {
        const DrawItem& item = items[count];
        const Bounds& bounds = scene.scene()->geometries()[static_cast<std::size_t>(item.geometry)].bounds;
        const PixelBox covered =
            intersection(pixel_box(bounds, clip_from_view * item.view_from_node, picture), box);
        if (!covered.empty()) spend_pixels(std::int64_t{covered.size().x} * covered.size().y);
        spend(work_of(item, scene));
    }
    return items.first(count);
}

}  // namespace vrut
