#pragma once

#include <memory>
#include <vector>

#include "mesh/cut.hpp"
#include "mesh/watertight_memo.hpp"
#include "plan/draw_budget.hpp"
#include "plan/view.hpp"
#include "scene/scene.hpp"

namespace vrut::plan {

/// What a clip plane makes of a part: lines where it cuts the part's surface, and a cap where that is
/// watertight.
struct CutSurface {
    mesh::Cut cut;  ///< in node space
    bool capped = false;
    glm::dvec3 normal{0};      ///< of the cap, in node space, not unit
    scene::Material material;  ///< scene::cap_material()
};

/// Keeps the cuts of a scene's parts from image to image: they change with a plane or with the part's place.
class CutCache {
public:
    /// Forgets those that were not asked for since the last image began.
    void begin_image();
    /// The cut of a geometry node by the view's plane of that number.
    std::shared_ptr<const CutSurface> find(const View& view, scene::Index node, std::size_t number,
                                           DrawBudget& budget);

private:
    struct Entry {
        scene::Index node = scene::kNone, material = scene::kNone;
        std::size_t number = 0;
        scene::ClipPlane plane;
        glm::dmat4 world{1};
        bool solid = false;
        double spacing = 0;  ///< of its hatching; 0: none
        std::shared_ptr<const CutSurface> surface = {};
        bool used = true;
    };
    bool is_solid(const View& view, scene::Index node);

    std::vector<Entry> entries_;  // by node and number
    mesh::WatertightMemo watertight_;
};

}  // namespace vrut::plan
