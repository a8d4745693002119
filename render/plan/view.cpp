#include "plan/view.hpp"

namespace vrut::plan {

double near_distance(const View& view) {
    constexpr double kOfClipRange = 1.0 / 128;  // a power of two scales depth without rounding
    const math::Bounds bounds = view.scene ? view.scene->bounds : math::Bounds();
    return scene::fit_clip_range(view.camera, bounds).near * kOfClipRange;
}

}  // namespace vrut::plan
