#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "scene/scene.hpp"

namespace vrut::mesh {

class DetailLevels;

/// Which geometries of a scene are watertight, found when it is first asked: a part of a million triangles
/// takes about a second.
class WatertightMemo {
public:
    /// `levels`: of the same scene or another, which may know already; null: none.
    bool is_watertight(const std::shared_ptr<const scene::Scene>& scene, scene::Index geometry,
                       const DetailLevels* levels = nullptr);

private:
    std::weak_ptr<const scene::Scene> scene_;  // of what is known; not kept alive by it
    std::vector<std::optional<bool>> known_;   // by geometry
};

}  // namespace vrut::mesh
