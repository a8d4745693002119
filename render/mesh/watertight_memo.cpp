#include "mesh/watertight_memo.hpp"

#include <atomic>

#include "mesh/detail_levels.hpp"
#include "mesh/watertight.hpp"

namespace vrut::mesh {

bool WatertightMemo::is_watertight(const std::shared_ptr<const scene::Scene>& scene, scene::Index geometry,
                                   const DetailLevels* levels) {
    if (scene_.lock() != scene) {
        scene_ = scene;
        known_.assign(scene->geometries().size(), std::nullopt);
    }
    const auto at = static_cast<std::size_t>(geometry);
    if (!known_[at] && levels && levels->scene() == scene) known_[at] = levels->watertight(geometry);
    const std::atomic<bool> stop = false;
    if (!known_[at]) known_[at] = mesh::is_watertight(scene->geometries()[at], stop);
    return *known_[at];
}

}  // namespace vrut::mesh
